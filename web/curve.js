// What a run measured against time, drawn by uPlot: scaled on the measuring window, what is before it greyed, the mean with a
// band of two standard errors, slumps one by one, and a line at the clock's time that follows the pointer.
import { h } from './dom.js';
import { palette } from './bed_view.js';
import { degrees, significant } from './format.js';

export const COLORS = ['accent', 'run', 'ok', 'bad', 'shell', 'violet'];
const LEAST_HEIGHT = 150;
const MARGIN = 0.12;

// low and high of the values that lie in the window of time, with room; all where none do.
function extentOf(data, shown, from, to) {
  let low = Infinity, high = -Infinity;
  const times = data[0];
  for (const k of shown)
    for (let i = 0; i < times.length; i++) {
      const value = data[k][i];
      if (value === null || value === undefined || times[i] < from || times[i] > to) continue;
      if (value < low) low = value;
      if (value > high) high = value;
    }
  if (!(high >= low)) return null;
  const room = Math.max(MARGIN * (high - low), 1e-12 * Math.abs(high), high === low ? 0.5 : 0);
  return [low - room, high + room];
}

const shade = (color, alpha) => {
  const [r, g, b] = [1, 3, 5].map(k => parseInt(color.slice(k, k + 2), 16));
  return `rgb(${r} ${g} ${b} / ${alpha})`;
};

// What lies under the lines: the transient, and of the mean the band.
function underlay(plot, { window, mean, error }, colors) {
  const { ctx, bbox } = plot, x = time => plot.valToPos(time, 'x', true), y = value => plot.valToPos(value, 'y', true);
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  if (window) {
    ctx.fillStyle = shade(colors.quiet, 0.13);
    ctx.fillRect(bbox.left, bbox.top, Math.max(x(window.start) - bbox.left, 0), bbox.height);
    const end = x(window.end);
    ctx.fillRect(end, bbox.top, Math.max(bbox.left + bbox.width - end, 0), bbox.height);
    if (typeof mean === 'number') {
      const from = x(window.start), half = Math.abs(y(mean) - y(mean + 2 * (error ?? 0)));
      ctx.fillStyle = shade(colors.run, 0.24);
      ctx.fillRect(from, y(mean) - half, end - from, 2 * half);
      ctx.strokeStyle = colors.run;
      ctx.lineWidth = 1.5 * devicePixelRatio;
      ctx.setLineDash([6 * devicePixelRatio, 4 * devicePixelRatio]);
      ctx.beginPath();
      ctx.moveTo(from, y(mean));
      ctx.lineTo(end, y(mean));
      ctx.stroke();
    }
  }
  ctx.restore();
}

// Each slump: a mark where it begins, up there, and one where it ends, down there, joined.
function overlay(plot, events, colors) {
  const { ctx, bbox } = plot, size = 4.5 * devicePixelRatio;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.fillStyle = ctx.strokeStyle = colors.bad;
  ctx.lineWidth = 1.4 * devicePixelRatio;
  for (const { start, stop, start_deg: from, stop_deg: to } of events) {
    const [x, y, endX, endY] = [plot.valToPos(start, 'x', true), plot.valToPos(from, 'y', true), plot.valToPos(stop, 'x', true), plot.valToPos(to, 'y', true)];
    ctx.beginPath();
    ctx.moveTo(x, y - 1.5 * size);
    ctx.lineTo(x - size, y - 3.2 * size);
    ctx.lineTo(x + size, y - 3.2 * size);
    ctx.fill();
    ctx.beginPath();
    ctx.moveTo(x, y);
    ctx.lineTo(endX, endY);
    ctx.stroke();
  }
  ctx.restore();
}

// box: an element that it fills. clock: of its line. facts(): {window, mean, error, events}, asked for at each drawing. onPaper: its
// size there, in CSS pixels, which the sheet gives it only once it is laid out.
export function createCurve(box, clock, facts = () => ({}), onPaper = { width: 672, height: 250 }) {
  let plot = null, made = '', given = { data: [[]], series: [], unit: '' };
  const line = h('div', { class: 'time-line' });

  const moveLine = () => {
    if (!plot) return;
    const x = plot.valToPos(clock.time, 'x');
    line.hidden = !(x >= 0 && x <= plot.over.clientWidth);
    line.style.transform = `translateX(${x}px)`;
  };
  clock.listen(moveLine);

  function yRange(u) {
    const { window } = facts(), times = u.data[0], [first, last] = u.series[0].idxs ?? [0, times.length - 1];
    const shown = given.series.map((_, k) => k + 1);
    const isWhole = first === 0 && last === times.length - 1; // not zoomed
    const extent = isWhole && window && extentOf(u.data, shown, window.start, window.end);
    return extent || extentOf(u.data, shown, times[first], times[last]) || [0, 1];
  }

  function build() {
    const colors = palette(), grid = { stroke: colors.line, width: 1 };
    const axis = { stroke: colors.quiet, grid, ticks: { ...grid, size: 4 }, font: `12px ${getComputedStyle(document.body).fontFamily}` };
    plot?.destroy();
    plot = new globalThis.uPlot({
      ...size(), legend: { show: false }, cursor: { drag: { x: true, y: false, dist: 6 }, points: { size: 6 } },
      scales: { x: { time: false }, y: { range: yRange } },
      axes: [{ ...axis, label: 'time since the test began, s', labelSize: 18, labelFont: axis.font, size: 30 },
        { ...axis, size: 54, values: (_, marks) => marks.map(mark => given.unit === '°' ? `${mark}°` : significant(mark, 4)) }],
      series: [{}, ...given.series.map((one, k) => ({
        label: one.name, stroke: one.color ?? colors[COLORS[(one.place ?? k) % COLORS.length]],
        width: k ? 1.2 : 1.7, points: { show: false }, spanGaps: false }))],
      hooks: { drawAxes: [u => underlay(u, facts(), colors)], draw: [u => { overlay(u, facts().events ?? [], colors); moveLine(); }], setCursor: [follow] },
    }, given.data, box);
    plot.over.append(line);
    plot.over.addEventListener('click', () => follow(plot));
    plot.root.setAttribute('aria-hidden', 'true');
    moveLine();
  }

  function follow(u) {
    const { left } = u.cursor;
    if (left < 0 || clock.isGoing) return;
    if (u.select.width > 0) return; // being zoomed
    if (!u.isOfHand) return;
    clock.set(u.posToVal(left, 'x'));
  }

  const size = () => document.documentElement.classList.contains('printing') ? onPaper : ({ width: Math.max(box.clientWidth, 240), height: Math.max(box.clientHeight, LEAST_HEIGHT) });
  const hand = is => () => { if (plot) plot.isOfHand = is; };
  box.addEventListener('pointermove', hand(true), { capture: true });
  box.addEventListener('pointerleave', hand(false));
  new ResizeObserver(() => plot?.setSize(size())).observe(box);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => plot && build());

  return {
    // series: [{name, color, or place in COLORS}], of data[1] and on; data[0]: times, rising. unit: '°', or none. of: how many
    // samples these stand for, where they are thinned.
    show(next) {
      given = next;
      const kind = JSON.stringify(next.series);
      if (plot && kind === made) plot.setData(next.data, plot.scales.x.min <= plot.data[0][0]);
      else build();
      made = kind;
      box.setAttribute('role', 'img');
      box.setAttribute('aria-label', inWords(next, facts()));
    },
    rebuild: () => plot && build(),
    zoom: (from, to) => plot?.setScale('x', { min: from, max: to }),
    plot: () => plot,
  };
}

function inWords({ data, series, unit, of }, { mean, error }) {
  const [times] = data, extent = extentOf(data, [1], -Infinity, Infinity);
  const write = value => unit === '°' ? degrees(value) : significant(value);
  return `${series[0]?.name ?? 'Values'} against time: ${of ?? times.length} samples to ${significant(times.at(-1) ?? 0)} s`
    + (extent ? `, between ${write(extent[0])} and ${write(extent[1])}` : '') + (typeof mean === 'number' ? `; mean ${degrees(mean, error)}` : '');
}
