// Measured values beside what is predicted for them, one below the other: all in errors of the measured value.
import { svg } from './dom.js';
import { significant } from './format.js';

const ROW = 34, LEFT = 220, RIGHT = 20, TOP = 8, BOTTOM = 40, WIDE = 760, FARTHEST = 6;

// rows: [{label, value, error, predicted, predictedError, isHeldOut}]
export function predictionPlot(rows) {
  const known = rows.filter(row => typeof row.predicted === 'number' && row.error > 0);
  const farthest = Math.min(Math.max(3, ...known.map(row => (Math.abs(row.predicted - row.value) + (row.predictedError ?? 0)) / row.error + 0.3)), FARTHEST);
  const x = errors => LEFT + (WIDE - LEFT - RIGHT) * (Math.min(Math.max(errors, -farthest), farthest) + farthest) / (2 * farthest);
  const bottom = TOP + ROW * known.length;
  const marks = Array.from({ length: 2 * Math.floor(farthest) + 1 }, (_, k) => k - Math.floor(farthest));
  return svg('svg', { class: 'plot predictions', role: 'img', viewBox: `0 0 ${WIDE} ${bottom + BOTTOM}`,
    'aria-label': known.map(row => `${row.label}: measured ${significant(row.value)}, predicted ${significant(row.predicted)}`).join('; ') },
  svg('rect', { class: 'band wide', x: x(-2), width: x(2) - x(-2), y: TOP, height: bottom - TOP }),
  svg('rect', { class: 'band', x: x(-1), width: x(1) - x(-1), y: TOP, height: bottom - TOP }),
  svg('line', { class: 'measured', x1: x(0), x2: x(0), y1: TOP, y2: bottom }),
  marks.map(mark => svg('text', { x: x(mark), y: bottom + 16, 'text-anchor': 'middle' }, String(mark))),
  svg('text', { class: 'title', x: WIDE - RIGHT, y: bottom + 34, 'text-anchor': 'end' }, 'predicted less measured, in errors of the measurement'),
  known.map((row, i) => rowOf(row, TOP + ROW * (i + 0.5), x)));
}

function rowOf({ label, value, error, predicted, predictedError, isHeldOut }, y, x) {
  const at = x((predicted - value) / error), reach = (predictedError ?? 0) / error;
  const [low, high] = [x((predicted - value) / error - reach), x((predicted - value) / error + reach)];
  return svg('g', { class: isHeldOut ? 'held-out' : 'fitted' },
    svg('title', null, `${label}: measured ${significant(value, 4)} ± ${significant(error, 2)}, predicted ${significant(predicted, 4)} ± ${significant(predictedError, 2)}`),
    svg('text', { x: LEFT - 12, y: y + 4, 'text-anchor': 'end' }, label.length > 30 ? `${label.slice(0, 29)}…` : label),
    svg('path', { class: 'bar', d: `M${low} ${y}L${high} ${y}M${low} ${y - 4}L${low} ${y + 4}M${high} ${y - 4}L${high} ${y + 4}` }),
    svg('circle', { cx: at, cy: y, r: 5 }));
}
