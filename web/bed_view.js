// One view of a bed: a canvas that shows a frame from where the user has turned it, with the surface's line, the way of gravity
// and a bar of known length drawn over it.
import { h } from './dom.js';
import { kindColor, onScale, paint } from './bed_colors.js';
import { sharedRenderer, wallMesh } from './bed_renderer.js';
import { wallGeometry } from './bed_walls.js';
import { cameraOf } from './bed_camera.js';
import { drawMarks } from './bed_marks.js';

const TURN = 0.008;    // rad a pixel of dragging
const KEY_TURN = 0.1, KEY_ZOOM = 1.2;
const SMOOTHED = 1.5;  // pixels drawn a pixel shown, at least

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

// scene: {process, inputs} as in the job's spec.
export function createBedView(scene, { label = 'The bed' } = {}) {
  const isDrum = scene.process === 'drum';
  const canvas = h('canvas', { class: 'bed', role: 'img', tabindex: '0', 'aria-label': label });
  const state = { frame: null, start: null, walls: null, colorBy: 'speed', cut: 1, yaw: 0, pitch: 0, zoom: 1, pan: [0, 0], angle: null, raised: 0 };
  const painted = { of: null, by: '', colors: null, legend: null };
  let mesh = null, meshOf = '', due = 0, shown = 0;

  function redraw() {
    if (!due) due = requestAnimationFrame(() => { due = 0; draw(); });
  }

  function draw() {
    const ratio = Math.max(globalThis.devicePixelRatio || 1, SMOOTHED);
    const width = Math.round(canvas.clientWidth * ratio), height = Math.round(canvas.clientHeight * ratio);
    const renderer = sharedRenderer();
    if (!width || !height || !renderer) return;
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    const colors = palette(), view = cameraOf(scene, state, width, height), context = canvas.getContext('2d');
    const { frame, walls } = state;
    if (walls && meshOf !== colors.shell) { mesh = wallMesh(wallGeometry(walls, isDrum), asNumbers(colors.shell)); meshOf = colors.shell; }
    repaint();
    shown = renderer.draw(frame, painted.colors, mesh ?? { count: 0 },
      { ...view, paper: asNumbers(colors.sheet), turned: isDrum && frame && walls ? frame.angle - walls.turned : 0, raised: state.raised, thickness: 2.2 * ratio }, width, height);
    context.fillStyle = colors.sheet;
    context.fillRect(0, 0, width, height);
    context.drawImage(renderer.canvas, 0, 0, width, height, 0, 0, width, height);
    drawMarks(context, scene, state, view, colors, ratio);
    canvas.dispatchEvent(new CustomEvent('drawn', { detail: { shown, count: frame?.count ?? 0, legend: painted.legend } }));
  }

  function repaint() {
    const { frame, start, colorBy } = state;
    if (!frame || painted.of === frame && painted.by === colorBy && painted.start === start) return;
    Object.assign(painted, { of: frame, by: colorBy, start }, paint(frame, start, colorBy, !isDrum));
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
