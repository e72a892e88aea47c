// The posterior of a calibration by pairs of parameters: its draws as dots, the runs as rings, the sets that were verified as
// crosses; on the diagonal how often each value is drawn, with its regions.
import { svg } from './dom.js';
import { significant } from './format.js';
import { ticks } from './angle_plot.js';

const CELL = 200, GAP = 18, LEFT = 62, BOTTOM = 46, TOP = 14, RIGHT = 14, BINS = 40;

// One parameter's axis: {low, high, isLog, label}; place(value) in [0, 1].
const placeOf = ({ low, high, isLog }) => value => isLog ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);

function marksOf({ low, high, isLog }) {
  if (!isLog || high / low < 4) return ticks(low, high, 4);
  const marks = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); power++)
    for (const lead of high / low > 50 ? [1] : [1, 2, 5]) marks.push(Number(`${lead}e${power}`));
  return marks.filter(mark => mark >= low * (1 - 1e-9) && mark <= high * (1 + 1e-9));
}

// axes: of the parameters, in their order, each {low, high, isLog, label, region68, region95}; draws, runs, family: lists of lists.
export function pairsPlot(axes, { draws, runs, family }) {
  const count = axes.length, size = LEFT + count * CELL + (count - 1) * GAP + RIGHT, height = TOP + count * CELL + (count - 1) * GAP + BOTTOM;
  const cells = axes.flatMap((down, row) => axes.slice(0, row + 1).map((across, column) => {
    const at = { x: LEFT + column * (CELL + GAP), y: TOP + row * (CELL + GAP) };
    return svg('g', { class: 'cell', transform: `translate(${at.x} ${at.y})` }, svg('rect', { class: 'frame', width: CELL, height: CELL }),
      row === column ? histogram(across, draws.map(draw => draw[row])) : dots([across, down], [column, row], { draws, runs, family }),
      row === count - 1 ? below(across) : null, column === 0 && row > 0 ? beside(down) : null);
  }));
  const words = draws.length ? `${draws.length} draws of the posterior` : `${runs.length} runs; no posterior yet`;
  return svg('svg', { class: 'plot pairs', role: 'img', 'aria-label': `${axes.map(({ label }) => label).join(' against ')}: ${words}`,
    viewBox: `0 0 ${size} ${height}` }, cells);
}

function dots([across, down], [column, row], { draws, runs, family }) {
  const x = placeOf(across), y = placeOf(down);
  const where = values => [(CELL * x(values[column])).toFixed(1), (CELL * (1 - y(values[row]))).toFixed(1)];
  const circle = (name, r) => values => { const [cx, cy] = where(values); return svg('circle', { class: name, cx, cy, r }); };
  const cross = values => { const [cx, cy] = where(values).map(Number); return svg('path', { class: 'set', d: `M${cx - 5} ${cy - 5}L${cx + 5} ${cy + 5}M${cx - 5} ${cy + 5}L${cx + 5} ${cy - 5}` }); };
  return [...draws.map(circle('draw', 1.4)), ...runs.map(circle('run', 3)), ...family.map(cross)];
}

// The regions, below the columns of how many draws fall where.
function histogram(axis, values) {
  const place = placeOf(axis), columns = Array(BINS).fill(0);
  for (const value of values) columns[Math.min(Math.floor(BINS * place(value)), BINS - 1)]++;
  const most = Math.max(...columns, 1), wide = CELL / BINS;
  const region = (ends, name) => ends ? svg('rect', { class: name, x: CELL * place(ends[0]), width: Math.max(CELL * (place(ends[1]) - place(ends[0])), 1), y: 0, height: CELL }) : null;
  return [region(axis.region95, 'region95'), region(axis.region68, 'region68'), ...columns.map((n, k) => n === 0 ? null
    : svg('rect', { class: 'column', x: (k * wide).toFixed(2), width: (wide - 0.5).toFixed(2), y: (CELL - 0.9 * CELL * n / most).toFixed(1), height: (0.9 * CELL * n / most).toFixed(1) }))];
}

const below = axis => [...marksOf(axis).map(mark => [
  svg('line', { class: 'mark', x1: CELL * placeOf(axis)(mark), x2: CELL * placeOf(axis)(mark), y1: CELL, y2: CELL + 4 }),
  svg('text', { x: CELL * placeOf(axis)(mark), y: CELL + 18, 'text-anchor': 'middle' }, significant(mark))]).flat(),
svg('text', { class: 'title', x: CELL / 2, y: CELL + 38, 'text-anchor': 'middle' }, axis.label)];

const beside = axis => [...marksOf(axis).map(mark => svg('text', { x: -6, y: CELL * (1 - placeOf(axis)(mark)) + 4, 'text-anchor': 'end' }, significant(mark))),
  svg('text', { class: 'title', transform: `translate(-46 ${CELL / 2}) rotate(-90)`, 'text-anchor': 'middle' }, axis.label)];
