// One view of a bed: a canvas that shows a frame from where the user has turned it, with the surface's line, the way of gravity
// and a bar of known length drawn over it.
import { h } from './dom.js';
import { kindColor, onScale, paint } from './bed_colors.js';
import { sharedRenderer, wallMesh } from './bed_renderer.js';
import { wallGeometry } from './bed_walls.js';
import { degrees, millimetres } from './format.js';
import { surfaceHeight } from './drum_picture.js';

const MARGIN = 1.13;   // of the picture around what is in it
const TURN = 0.008;    // rad a pixel of dragging
const KEY_TURN = 0.1, KEY_ZOOM = 1.2;
const SMOOTHED = 1.5;  // pixels drawn a pixel shown, at least

// right, up, and towards the viewer, before the user turns anything: along the axis of a drum, from the side of what stands.
const BASES = { drum: [[1, 0, 0], [0, 1, 0], [0, 0, 1]], upright: [[1, 0, 0], [0, 0, 1], [0, -1, 0]] };

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const mixed = (a, b, c, s) => a.map((x, k) => x * c + b[k] * s);

export function palette() {
  const style = getComputedStyle(document.documentElement);
  const of = name => style.getPropertyValue(`--${name}`).trim();
  const isPaper = document.documentElement.classList.contains('printing');
  return isPaper ? { ink: '#222', quiet: '#555', line: '#ccc', sheet: '#fff', run: '#0f5c8c', accent: '#98551a', shell: '#51626d', bad: '#a4251b', violet: '#6f4d99', ok: '#1d6b3f' }
    : Object.fromEntries(['ink', 'quiet', 'line', 'sheet', 'run', 'accent', 'shell', 'bad', 'violet', 'ok'].map(name => [name, of(name)]));
}

const asNumbers = color => {
  const text = color.slice(1), wide = text.length === 3 ? [...text].map(c => c + c).join('') : text;
  return [0, 2, 4].map(k => parseInt(wide.slice(k, k + 2), 16) / 255);
};

// scene: {process, inputs} as in the job's spec. changed(): told when the user turned or zoomed it.
export function createBedView(scene, { label = 'The bed' } = {}) {
  const isDrum = scene.process === 'drum';
  const canvas = h('canvas', { class: 'bed', role: 'img', tabindex: '0', 'aria-label': label });
  const state = { frame: null, start: null, walls: null, colorBy: 'speed', cut: 1, yaw: 0, pitch: 0, zoom: 1, pan: [0, 0], angle: null, raised: 0 };
  const painted = { of: null, by: '', colors: null, legend: null };
  let mesh = null, meshOf = '', due = 0, shown = 0;

  function redraw() {
    if (!due) due = requestAnimationFrame(() => { due = 0; draw(); });
  }

  function extent() {
    const { walls, frame } = state;
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    const add = p => p.forEach((x, k) => { low[k] = Math.min(low[k], x); high[k] = Math.max(high[k], x); });
    if (walls) walls.points.forEach(add);
    else if (frame) { add(frame.low); add(frame.high); }
    if (!walls && isDrum) { const r = scene.inputs.drum.diameter / 2; add([-r, -r, 0]); add([r, r, 0]); }
    return { low, high };
  }

  function camera(width, height) {
    const { low, high } = extent();
    const center = low.map((x, k) => (x + high[k]) / 2);
    const [right, up, near] = BASES[isDrum ? 'drum' : 'upright'];
    const [cy, sy, cp, sp] = [Math.cos(state.yaw), Math.sin(state.yaw), Math.cos(state.pitch), Math.sin(state.pitch)];
    const side = mixed(right, near, cy, -sy), front = mixed(near, right, cy, sy);
    const toView = [side, mixed(up, front, cp, -sp), mixed(front, up, cp, sp)];
    const reach = axis => 0.5 * high.reduce((sum, x, k) => sum + Math.abs(axis[k]) * (x - low[k]), 0);
    // a round thing reaches as far in all directions: no change of size while it is turned
    const across = isDrum ? Math.hypot(scene.inputs.drum.diameter / 2, (state.yaw || state.pitch) ? (high[2] - low[2]) / 2 : 0) : null;
    const unit = state.zoom / MARGIN * Math.min(width / 2 / (across ?? reach(toView[0])), height / 2 / (across ?? reach(toView[1])));
    const whole = Math.hypot(...high.map((x, k) => x - low[k])) / 2 || 1;
    const depth = 0.5 * (dot(high, near.map(Math.abs)) - dot(low, near.map(Math.abs)));
    return {
      center, toView, scale: [2 * unit / width, 2 * unit / height, 1 / (1.2 * whole)], pan: state.pan, unit, depthAxis: near,
      cut: state.cut >= 1 ? 1e9 : depth * (2 * state.cut - 1), width, height,
    };
  }

  const onCanvas = (view, world) => {
    const c = world.map((x, k) => x - view.center[k]);
    return [view.width / 2 * (1 + view.pan[0] + dot(view.toView[0], c) * view.scale[0]),
      view.height / 2 * (1 - view.pan[1] - dot(view.toView[1], c) * view.scale[1])];
  };

  function draw() {
    const ratio = Math.max(globalThis.devicePixelRatio || 1, SMOOTHED);
    const width = Math.round(canvas.clientWidth * ratio), height = Math.round(canvas.clientHeight * ratio);
    const renderer = sharedRenderer();
    if (!width || !height || !renderer) return;
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    const colors = palette(), view = camera(width, height), context = canvas.getContext('2d');
    const { frame, walls } = state;
    if (walls && meshOf !== colors.shell) { mesh = wallMesh(wallGeometry(walls, isDrum), asNumbers(colors.shell)); meshOf = colors.shell; }
    repaint();
    shown = renderer.draw(frame, painted.colors, mesh ?? { count: 0 },
      { ...view, paper: asNumbers(colors.sheet), turned: isDrum && frame && walls ? frame.angle - walls.turned : 0, raised: state.raised, thickness: 2.2 * ratio }, width, height);
    context.fillStyle = colors.sheet;
    context.fillRect(0, 0, width, height);
    context.drawImage(renderer.canvas, 0, 0, width, height, 0, 0, width, height);
    annotate(context, view, colors, ratio);
    canvas.dispatchEvent(new CustomEvent('drawn', { detail: { shown, count: frame?.count ?? 0, legend: painted.legend } }));
  }

  function repaint() {
    const { frame, start, colorBy } = state;
    if (!frame || painted.of === frame && painted.by === colorBy && painted.start === start) return;
    Object.assign(painted, { of: frame, by: colorBy, start }, paint(frame, start, colorBy, !isDrum));
  }

  function annotate(context, view, colors, ratio) {
    context.lineCap = 'round';
    context.font = `${12.5 * ratio}px ${getComputedStyle(document.body).fontFamily}`;
    if (isDrum) drawLining(context, view, colors);
    if (typeof state.angle === 'number' && isDrum) drawSurface(context, view, colors, ratio);
    drawGravity(context, view, colors, ratio);
    drawScale(context, view, colors, ratio);
  }

  // Glued spheres, as many around the wall as their pitch leaves room for, turned with it.
  function drawLining(context, view, colors) {
    const lining = scene.inputs.wall?.lining;
    if (!lining) return;
    const at = scene.inputs.drum.diameter / 2, around = Math.floor(2 * Math.PI * at / lining.pitch + 1e-9);
    context.fillStyle = colors.quiet;
    for (let k = 0; k < around; k++) {
      const turned = (state.frame?.angle ?? 0) + 2 * Math.PI * k / around;
      const [x, y] = onCanvas(view, [at * Math.cos(turned), at * Math.sin(turned), view.center[2]]);
      context.beginPath();
      context.arc(x, y, lining.diameter / 2 * view.unit, 0, 2 * Math.PI);
      context.fill();
    }
  }

  // The line at the angle of the moment, where a level surface of as full a drum would be.
  function drawSurface(context, view, colors, ratio) {
    const { drum, fill_fraction: fraction } = scene.inputs;
    const radius = drum.diameter / 2, phi = state.angle * Math.PI / 180 * (drum.rotation_rate < 0 ? -1 : 1);
    const c = surfaceHeight(Math.min(Math.max(fraction ?? 0.5, 0.02), 0.98)), half = Math.sqrt(1 - c * c);
    const z = view.center[2] + (state.cut >= 1 ? 0.5 : state.cut - 0.5) * drum.length;
    const point = along => [radius * (along * Math.cos(phi) - c * Math.sin(phi)), radius * (along * Math.sin(phi) + c * Math.cos(phi)), z];
    const [a, b] = [onCanvas(view, point(-half)), onCanvas(view, point(half))];
    for (const [color, width] of [[colors.sheet, 4.5], [colors.run, 2]]) {
      context.strokeStyle = color;
      context.lineWidth = width * ratio;
      context.beginPath();
      context.moveTo(...a);
      context.lineTo(...b);
      context.stroke();
    }
    const words = degrees(state.angle), wide = context.measureText(words).width + 12 * ratio, [x, y] = a;
    const left = Math.min(Math.max(x - wide - 6 * ratio, 6 * ratio), view.width - wide - 6 * ratio), top = Math.max(y - 26 * ratio, 4 * ratio);
    context.fillStyle = colors.run;
    context.beginPath();
    context.roundRect(left, top, wide, 20 * ratio, 5 * ratio);
    context.fill();
    context.fillStyle = colors.sheet;
    context.fillText(words, left + 6 * ratio, top + 14.5 * ratio);
  }

  function drawGravity(context, view, colors, ratio) {
    const tilt = (scene.inputs.drum?.tilt_deg ?? 0) * Math.PI / 180;
    const way = isDrum ? [0, -Math.cos(tilt), -Math.sin(tilt)] : [0, 0, -1];
    const [dx, dy] = [dot(view.toView[0], way), -dot(view.toView[1], way)];
    const size = 30 * ratio, x = view.width - 24 * ratio, y = view.height - 48 * ratio;
    const [tipX, tipY] = [x + dx * size, y + dy * size];
    context.strokeStyle = context.fillStyle = colors.quiet;
    context.lineWidth = 1.6 * ratio;
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(tipX, tipY);
    context.stroke();
    context.beginPath();
    context.moveTo(tipX + 5 * ratio * dx, tipY + 5 * ratio * dy);
    context.lineTo(tipX - 4 * ratio * dy, tipY + 4 * ratio * dx);
    context.lineTo(tipX + 4 * ratio * dy, tipY - 4 * ratio * dx);
    context.fill();
    context.fillText('g', x - 14 * ratio, y + 6 * ratio);
  }

  function drawScale(context, view, colors, ratio) {
    const wanted = view.width / 5 / view.unit, power = 10 ** Math.floor(Math.log10(wanted));
    const length = [5, 2, 1].map(m => m * power).find(l => l <= wanted);
    const [x, y, end] = [14 * ratio, view.height - 16 * ratio, 14 * ratio + length * view.unit];
    context.strokeStyle = context.fillStyle = colors.quiet;
    context.lineWidth = 1.6 * ratio;
    context.beginPath();
    context.moveTo(x, y - 4 * ratio);
    context.lineTo(x, y);
    context.lineTo(end, y);
    context.lineTo(end, y - 4 * ratio);
    context.stroke();
    context.fillText(millimetres(length), x + 4 * ratio, y - 7 * ratio);
  }

  function set(change) {
    Object.assign(state, change);
    redraw();
  }
  listenToHands(canvas, state, set);
  new ResizeObserver(redraw).observe(canvas);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
  return {
    element: canvas, set, draw, isDrum,
    // Its legend as an element, after a drawing.
    legend: () => legendOf(painted.legend, shown, state.frame?.count ?? 0),
    shellLow: () => state.walls ? wallGeometry(state.walls, isDrum).shellLow : 0,
  };
}

function listenToHands(canvas, state, set) {
  const turn = (dx, dy) => set({ yaw: state.yaw + dx, pitch: Math.min(Math.max(state.pitch + dy, -1.57), 1.57) });
  const zoom = factor => set({ zoom: Math.min(Math.max(state.zoom * factor, 0.5), 20) });
  const asItWas = () => set({ yaw: 0, pitch: 0, zoom: 1, pan: [0, 0] });
  canvas.addEventListener('pointerdown', event => canvas.setPointerCapture(event.pointerId));
  canvas.addEventListener('pointermove', event => {
    if (!event.buttons) return;
    if (event.shiftKey || event.buttons === 2 || event.buttons === 4)
      set({ pan: [state.pan[0] + 2 * event.movementX / canvas.clientWidth, state.pan[1] - 2 * event.movementY / canvas.clientHeight] });
    else turn(TURN * event.movementX, TURN * event.movementY);
  });
  canvas.addEventListener('contextmenu', event => event.preventDefault());
  canvas.addEventListener('dblclick', asItWas);
  canvas.addEventListener('wheel', event => {
    if (!event.ctrlKey && document.activeElement !== canvas) return; // the page scrolls by
    event.preventDefault();
    zoom(Math.exp(-event.deltaY / 500));
  }, { passive: false });
  const keys = { ArrowLeft: () => turn(-KEY_TURN, 0), ArrowRight: () => turn(KEY_TURN, 0), ArrowUp: () => turn(0, -KEY_TURN),
    ArrowDown: () => turn(0, KEY_TURN), '+': () => zoom(KEY_ZOOM), '-': () => zoom(1 / KEY_ZOOM), 0: asItWas };
  canvas.addEventListener('keydown', event => {
    if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    keys[event.key]();
  });
}

// The colours and what they mean.
function legendOf(legend, shown, count) {
  if (!legend) return h('p', { class: 'legend' });
  const thinned = shown < count ? ` · ${shown.toLocaleString('en')} of ${count.toLocaleString('en')} drawn: no graphics processor here` : '';
  const swatch = ([r, g, b]) => {
    const box = h('span', { class: 'swatch' });
    box.style.backgroundColor = `rgb(${r} ${g} ${b})`;
    return box;
  };
  const bar = () => {
    const strip = h('span', { class: 'scale' });
    strip.style.background = `linear-gradient(to right, ${[0, 0.25, 0.5, 0.75, 1].map(share => `rgb(${onScale(share).join(' ')})`).join(', ')})`;
    return strip;
  };
  return h('p', { class: 'legend' }, h('span', null, legend.name),
    legend.kinds ? Array.from({ length: legend.kinds }, (_, k) => [swatch(kindColor(k)), String(k)]).flat()
      : legend.text ? h('span', null, legend.text) : [h('span', null, legend.low), bar(), h('span', null, legend.high)],
    h('span', { class: 'quiet' }, thinned));
}
