// The angle of repose against time: the samples as a line, and over the measuring window the mean with a
// band of its standard error.
import { svg } from './dom.js';
import { degrees, significant } from './format.js';

const LEAST_BAND = 5; // px, so that the line of the mean does not hide it
const HEIGHT = 210, LEFT = 44, RIGHT = 10, TOP = 12, BOTTOM = 36;

// Round numbers between low and high, about `wanted` of them.
export function ticks(low, high, wanted) {
  const rough = (high - low) / wanted;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map(m => m * power).find(s => s >= rough);
  const marks = [];
  for (let i = Math.ceil(low / step); i * step <= high * (1 + 1e-12); i++) marks.push(Number((i * step).toPrecision(10)));
  return marks;
}

// points: [{time (s), angle (deg)}] in order of time, thinned; repose: the results' member, or null while it runs.
export function anglePlot(points, repose, width) {
  const times = [Math.min(0, points[0].time), points.at(-1).time];
  let low = Math.min(...points.map(p => p.angle)), high = Math.max(...points.map(p => p.angle));
  if (high - low < 1) [low, high] = [(low + high) / 2 - 0.5, (low + high) / 2 + 0.5];
  const margin = 0.08 * (high - low);
  [low, high] = [low - margin, high + margin];
  const x = time => LEFT + (width - LEFT - RIGHT) * (time - times[0]) / (times[1] - times[0] || 1);
  const y = angle => HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * (angle - low) / (high - low);
  const line = points.map((p, i) => `${i ? 'L' : 'M'}${x(p.time).toFixed(1)} ${y(p.angle).toFixed(1)}`).join('');

  const description = `Angle against time: ${points.length} samples from ${significant(points[0].time)} to `
    + `${significant(times[1])} s, between ${degrees(Math.min(...points.map(p => p.angle)))} and `
    + `${degrees(Math.max(...points.map(p => p.angle)))}`;
  return svg('svg', { class: 'plot', role: 'img', 'aria-label': description, viewBox: `0 0 ${width} ${HEIGHT}` },
    axes(x, y, times, [low, high], width),
    measuringWindow(repose, x, y, times),
    svg('path', { class: 'line', d: line }));
}

function axes(x, y, times, angles, width) {
  const bottom = HEIGHT - BOTTOM;
  return svg('g', { class: 'axes' },
    ticks(...angles, 4).map(angle => [
      svg('line', { x1: LEFT, x2: width - RIGHT, y1: y(angle), y2: y(angle) }),
      svg('text', { x: LEFT - 6, y: y(angle) + 4, 'text-anchor': 'end' }, `${angle}°`)]).flat(),
    ticks(...times, width > 500 ? 8 : 4).map(time => [
      svg('line', { x1: x(time), x2: x(time), y1: bottom, y2: bottom + 4 }),
      svg('text', { x: x(time), y: bottom + 17, 'text-anchor': 'middle' }, `${time}`)]).flat(),
    svg('text', { x: width - RIGHT, y: HEIGHT - 4, 'text-anchor': 'end' }, 'time since the test began, s'));
}

function measuringWindow(repose, x, y, times) {
  if (!repose?.window || typeof repose.angle_deg !== 'number') return null; // of a heap only the last state counts
  const from = x(Math.max(repose.window?.start ?? times[0], times[0]));
  const to = x(Math.min(repose.window?.end ?? times[1], times[1]));
  const error = repose.standard_error_deg ?? 0;
  const middle = y(repose.angle_deg), half = Math.max(middle - y(repose.angle_deg + error), LEAST_BAND / 2);
  const top = middle - half, bottom = middle + half;
  return svg('g', { class: 'mean' },
    svg('rect', { x: from, width: Math.max(to - from, 1), y: top, height: bottom - top }),
    svg('line', { x1: from, x2: to, y1: y(repose.angle_deg), y2: y(repose.angle_deg) }));
}
