// The paper's map of regimes: the square of the rate at the inner radius, over gravity, against 1/sin of the angle, with the
// boundaries of Eqns 33, 35 and 36-37 between what rolls, what slides along the wall and what centrifuges.
import { svg } from './dom.js';
import { significant, superscript } from './format.js';

const WIDTH = 330, HEIGHT = 230, LEFT = 46, RIGHT = 12, TOP = 10, BOTTOM = 38;
const STEEP = 1.02, FLAT = 6, LOW = 1e-4, HIGH = 20; // of 1/sin phi; of Omega squared

// Of t = tan(phi), as the worker has them.
const cosecant = t => Math.sqrt(1 + 1 / (t * t));
export const BOUNDARIES = [
  { name: 'Eq 33', of: cosecant }, { name: 'Eq 35', of: t => Math.SQRT1_2 * (1 + 1 / (t + 0.125)) },
  { name: 'Eqns 36–37', of: t => cosecant(0.16 + t) },
];

const AREAS = [[3.5, 10, 'centrifuging'], [3.6, 0.3, 'rolling to raining']];

// points: [{angle_deg, omega2, name}]
export function regimeMap(points) {
  const x = value => LEFT + (WIDTH - LEFT - RIGHT) * (value - 1) / (FLAT - 1);
  const y = value => TOP + (HEIGHT - TOP - BOTTOM) * (Math.log(HIGH) - Math.log(Math.min(Math.max(value, LOW), HIGH))) / Math.log(HIGH / LOW);
  const line = of => Array.from({ length: 60 }, (_, k) => {
    const cosec = STEEP + (FLAT - STEEP) * k / 59, tangent = 1 / Math.sqrt(cosec * cosec - 1);
    return `${k ? 'L' : 'M'}${x(cosec).toFixed(1)} ${y(of(tangent)).toFixed(1)}`;
  }).join('');
  const put = points.map(point => ({ ...point, cosec: Math.min(1 / Math.sin(Math.max(point.angle_deg, 1) * Math.PI / 180), FLAT) }));
  const description = `Map of regimes; ${put.map(({ name, omega2, angle_deg }) => `${name} at Ω² ${significant(omega2)} and ${significant(angle_deg)} degrees`).join(', ')}`;
  return svg('svg', { class: 'plot map', role: 'img', 'aria-label': description, viewBox: `0 0 ${WIDTH} ${HEIGHT}` },
    svg('g', { class: 'axes' },
      [1, 2, 3, 4, 5, 6].map(value => [svg('line', { x1: x(value), x2: x(value), y1: TOP, y2: HEIGHT - BOTTOM }),
        svg('text', { x: x(value), y: HEIGHT - BOTTOM + 15, 'text-anchor': 'middle' }, String(value))]).flat(),
      [-4, -3, -2, -1, 0, 1].map(power => [svg('line', { x1: LEFT, x2: WIDTH - RIGHT, y1: y(10 ** power), y2: y(10 ** power) }),
        svg('text', { x: LEFT - 6, y: y(10 ** power) + 4, 'text-anchor': 'end' }, power === 0 ? '1' : power === 1 ? '10' : `10${superscript(power)}`)]).flat(),
      svg('text', { x: WIDTH - RIGHT, y: HEIGHT - 5, 'text-anchor': 'end' }, '1/sin φ'),
      svg('text', { x: LEFT + 4, y: TOP + 12 }, 'Ω²ᵢ = ω²Rᵢ/g')),
    AREAS.map(([cosec, omega2, words]) => svg('text', { class: 'area', x: x(cosec), y: y(omega2), 'text-anchor': 'middle' }, words)),
    BOUNDARIES.map(({ name, of }, k) => svg('path', { class: `boundary b${k}`, d: line(of) }, svg('title', null, name))),
    put.map(({ cosec, omega2, name }) => svg('g', { class: 'point' },
      svg('circle', { cx: x(cosec), cy: y(omega2), r: 5 }, svg('title', null, name)))));
}
