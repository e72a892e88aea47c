// A profile of the results, one number over another with the band of its standard error: the mean surface of a bed, of a heap.
import { svg } from './dom.js';
import { ticks } from './angle_plot.js';
import { significant } from './format.js';

const WIDTH = 430, HEIGHT = 230, LEFT = 52, RIGHT = 10, TOP = 10, BOTTOM = 36;

const isNumbers = list => Array.isArray(list) && list.length > 1 && list.every(one => one === null || typeof one === 'number');

// [{place, value, error, across, up}] of a member of the results that is a profile: its first list is the place.
export function profilesIn(member) {
  if (member === null || typeof member !== 'object' || Array.isArray(member)) return [];
  const lists = Object.entries(member).filter(([, list]) => isNumbers(list));
  const [[across, place] = [], ...values] = lists.filter(([name]) => name !== 'standard_error');
  return values.filter(([, list]) => list.length === place.length)
    .map(([up, value]) => ({ across, up, place, value, error: member.standard_error ?? null }));
}

// Lengths are shown in mm, the same scale both ways where both are lengths.
export function profilePlot({ across, up, place, value, error }, description) {
  const lengths = ['x', 'radius', 'height', 'place'], isShape = lengths.includes(across) && up === 'height';
  const wide = 1000, tall = isShape ? 1000 : 1;
  const points = place.map((p, k) => ({ x: p * wide, y: value[k] === null ? null : value[k] * tall, e: (error?.[k] ?? 0) * tall })).filter(p => p.y !== null);
  if (points.length < 2) return null;
  let [low, high] = [Math.min(...points.map(p => p.y - 2 * p.e)), Math.max(...points.map(p => p.y + 2 * p.e))];
  const [from, to] = [points[0].x, points.at(-1).x];
  if (isShape) { // as it lies
    const room = Math.max((to - from) * (HEIGHT - TOP - BOTTOM) / (WIDTH - LEFT - RIGHT) - (high - low), 0) / 2;
    [low, high] = [low - room, high + room];
  } else [low, high] = [Math.min(low, 0), high + 0.05 * (high - low)];
  const x = at => LEFT + (WIDTH - LEFT - RIGHT) * (at - from) / (to - from || 1);
  const y = at => HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * (at - low) / (high - low || 1);
  const path = (list, of) => list.map((p, k) => `${k ? 'L' : 'M'}${x(p.x).toFixed(1)} ${y(of(p)).toFixed(1)}`).join('');
  const band = `${path(points, p => p.y + 2 * p.e)}${path([...points].reverse(), p => p.y - 2 * p.e).replace('M', 'L')}Z`;
  return svg('svg', { class: 'plot profile', role: 'img', 'aria-label': description, viewBox: `0 0 ${WIDTH} ${HEIGHT}` },
    svg('g', { class: 'axes' },
      ticks(low, high, 4).map(mark => [svg('line', { x1: LEFT, x2: WIDTH - RIGHT, y1: y(mark), y2: y(mark) }),
        svg('text', { x: LEFT - 6, y: y(mark) + 4, 'text-anchor': 'end' }, significant(mark))]).flat(),
      ticks(from, to, 6).map(mark => svg('text', { x: x(mark), y: HEIGHT - BOTTOM + 16, 'text-anchor': 'middle' }, significant(mark))),
      svg('text', { x: WIDTH - RIGHT, y: HEIGHT - 4, 'text-anchor': 'end' }, `${across}, mm`),
      svg('text', { x: LEFT + 4, y: TOP + 10 }, `${up.replaceAll('_', ' ')}${isShape ? ', mm' : up === 'velocity' ? ', m/s' : ''}`)),
    error ? svg('path', { class: 'band', d: band }) : null,
    svg('path', { class: 'line', d: path(points, p => p.y) }));
}
