// A result against an input over the cases of a study: means with error bars, single runs as faint dots, other values of a
// second input as other series, and values that the study names as crosses.
import { h, svg } from './dom.js';
import { significant, superscript } from './format.js';
import { ticks } from './angle_plot.js';

const HEIGHT = 340, LEFT = 62, RIGHT = 16, TOP = 14, BOTTOM = 46;
const MARKS = ['circle', 'square', 'triangle', 'diamond', 'ring', 'box'];
const REFERENCES = ['paper', 'reference', 'measured', 'expected'];

const isNumber = value => typeof value === 'number' && Number.isFinite(value);
const firstNumber = text => /^\s*(-?\d+(?:\.\d+)?)/.exec(String(text))?.[1];

// A case's reference: what its label says of the first measure.
export function referenceOf(one) {
  const name = REFERENCES.find(key => firstNumber(one.label[key] ?? '') !== undefined);
  return name === undefined ? null : Number(firstNumber(one.label[name]));
}

// {x: name of an input, y: name of a measure, series: name of an input or '', log, width, title(y), unit}. Points without x have none.
export function studyPlot(cases, runs, { x, y, series, log, width, titles, references, hrefOf, hrefOfRun }) {
  const points = cases.map((one, index) => ({ one, index, x: x ? one.inputs[x] : index + 1, y: one.results[y]?.mean, error: one.results[y]?.standard_error ?? 0, of: series ? one.inputs[series] : '' }))
    .filter(point => isNumber(point.x) && isNumber(point.y) && (!log || point.x > 0));
  const placeOf = new Map(cases.map((one, index) => [index, x ? one.inputs[x] : index + 1]));
  const dots = runs.map(run => ({ run, x: placeOf.get(run.study_case), y: run[y] })).filter(dot => isNumber(dot.x) && isNumber(dot.y) && (!log || dot.x > 0));
  const crosses = references ? cases.map((one, index) => ({ x: placeOf.get(index), y: referenceOf(one) })).filter(cross => isNumber(cross.x) && isNumber(cross.y) && (!log || cross.x > 0)) : [];
  if (points.length + dots.length === 0) return h('p', { class: 'quiet' }, 'Nothing to draw yet: no case has a number for both axes.');
  const scale = scalesOf([...points, ...dots, ...crosses], log, width);
  const all = [...new Set(points.map(({ of }) => of))].sort((a, b) => a > b ? 1 : -1);
  return h('figure', { class: 'study-figure' }, svg('svg', { class: 'plot', role: 'group', 'aria-label': `${titles.y} against ${titles.x}: ${points.length} cases`, viewBox: `0 0 ${width} ${HEIGHT}` },
    axes(scale, log, width, titles),
    svg('g', { class: 'dots' }, dots.map(dot => svg('a', { href: hrefOfRun(dot.run), tabindex: '-1', 'aria-hidden': 'true' }, svg('circle', { cx: scale.x(dot.x), cy: scale.y(dot.y), r: 2.5 })))),
    svg('g', { class: 'crosses' }, crosses.map(cross => svg('path', { d: plus(scale.x(cross.x), scale.y(cross.y), 6) }))),
    all.map((of, k) => seriesOf(points.filter(point => point.of === of), k, scale, titles, hrefOf))),
  legend(all, series, crosses.length > 0));
}

const plus = (x, y, r) => `M${x - r} ${y - r}L${x + r} ${y + r}M${x - r} ${y + r}L${x + r} ${y - r}`;

function scalesOf(points, log, width) {
  const xs = points.map(point => log ? Math.log10(point.x) : point.x), lows = points.map(point => point.y - (point.error ?? 0)), highs = points.map(point => point.y + (point.error ?? 0));
  const span = (low, high, margin) => low === high ? [low - Math.max(Math.abs(low) * 0.1, 1e-9), high + Math.max(Math.abs(high) * 0.1, 1e-9)] : [low - margin * (high - low), high + margin * (high - low)];
  const [left, right] = span(Math.min(...xs), Math.max(...xs), 0.05), [low, high] = span(Math.min(...lows), Math.max(...highs), 0.08);
  return { range: [left, right], heights: [low, high],
    x: value => LEFT + (width - LEFT - RIGHT) * ((log ? Math.log10(value) : value) - left) / (right - left),
    y: value => HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * (value - low) / (high - low) };
}

function logTicks([left, right]) {
  const marks = [];
  for (let power = Math.floor(left); power <= Math.ceil(right); power++)
    for (const lead of right - left > 2 ? [1] : [1, 2, 5])
      if (Math.log10(lead) + power >= left && Math.log10(lead) + power <= right) marks.push(Number(`${lead}e${power}`));
  return marks;
}

const tickText = value => value !== 0 && (Math.abs(value) < 1e-3 || Math.abs(value) >= 1e6) ? `${Number((value / 10 ** Math.floor(Math.log10(Math.abs(value)))).toPrecision(3))}·10${superscript(Math.floor(Math.log10(Math.abs(value))))}` : String(value);

function axes(scale, log, width, titles) {
  const marks = log ? logTicks(scale.range) : ticks(...scale.range, width > 500 ? 8 : 4);
  return svg('g', { class: 'axes' },
    ticks(...scale.heights, 5).map(value => [svg('line', { x1: LEFT, x2: width - RIGHT, y1: scale.y(value), y2: scale.y(value) }),
      svg('text', { x: LEFT - 7, y: scale.y(value) + 4, 'text-anchor': 'end' }, tickText(value))]).flat(),
    marks.map(value => [svg('line', { x1: scale.x(value), x2: scale.x(value), y1: HEIGHT - BOTTOM, y2: HEIGHT - BOTTOM + 5 }),
      svg('text', { x: scale.x(value), y: HEIGHT - BOTTOM + 19, 'text-anchor': 'middle' }, tickText(value))]).flat(),
    svg('text', { class: 'title', x: width - RIGHT, y: HEIGHT - 6, 'text-anchor': 'end' }, titles.x),
    svg('text', { class: 'title', x: -TOP, y: 14, 'text-anchor': 'end', transform: 'rotate(-90)' }, titles.y));
}

function markOf(kind, x, y) {
  const r = 5.5;
  if (kind === 'circle' || kind === 'ring') return svg('circle', { class: kind === 'ring' ? 'open' : null, cx: x, cy: y, r });
  if (kind === 'square' || kind === 'box') return svg('rect', { class: kind === 'box' ? 'open' : null, x: x - r + 0.5, y: y - r + 0.5, width: 2 * r - 1, height: 2 * r - 1 });
  return svg('path', { d: kind === 'triangle' ? `M${x} ${y - r - 1}L${x + r + 1} ${y + r - 1}L${x - r - 1} ${y + r - 1}Z` : `M${x} ${y - r - 1}L${x + r + 1} ${y}L${x} ${y + r + 1}L${x - r - 1} ${y}Z` });
}

function seriesOf(points, k, scale, titles, hrefOf) {
  const ordered = [...points].sort((a, b) => a.x - b.x);
  return svg('g', { class: `series s${k % 6}` },
    svg('path', { class: 'join', d: ordered.map((point, i) => `${i ? 'L' : 'M'}${scale.x(point.x).toFixed(1)} ${scale.y(point.y).toFixed(1)}`).join('') }),
    ordered.map(point => svg('a', { href: hrefOf(point), class: 'case', 'aria-label': `${point.one.case}: ${significant(point.y, 4)} ± ${significant(point.error, 2)}` },
      svg('title', null, `${point.one.case}: ${significant(point.y, 4)}${point.error ? ` ± ${significant(point.error, 2)}` : ''}`),
      point.error ? svg('path', { class: 'bar', d: bar(scale.x(point.x), scale.y(point.y - point.error), scale.y(point.y + point.error)) }) : null,
      markOf(MARKS[k % MARKS.length], scale.x(point.x), scale.y(point.y)))));
}

const bar = (x, low, high) => `M${x} ${low}L${x} ${high}M${x - 4} ${low}L${x + 4} ${low}M${x - 4} ${high}L${x + 4} ${high}`;

function legend(all, series, hasCrosses) {
  const entry = (of, k) => h('li', { class: `series s${k % 6}` }, svg('svg', { viewBox: '0 0 16 16', width: 16, height: 16, 'aria-hidden': 'true' }, markOf(MARKS[k % MARKS.length], 8, 8)),
    ` ${typeof of === 'number' ? significant(of, 4) : String(of ?? '–')}`);
  if (!series && !hasCrosses) return null;
  return h('figcaption', null, series ? `${series}: ` : null, h('ul', { class: 'legend' }, series ? all.slice(0, 12).map(entry) : null,
    hasCrosses ? h('li', { class: 'crosses' }, svg('svg', { viewBox: '0 0 16 16', width: 16, height: 16, 'aria-hidden': 'true' }, svg('path', { d: plus(8, 8, 5) })), ' named by the study') : null));
}
