// The table of a study's cases: what differs between them, how many runs have ended, and mean ± standard error.
import { h } from './dom.js';
import { count, degrees, percent, regimeInWords, significant, superscript, verdictsInWords } from './format.js';

const ROWS_SHOWN = 100; // a page

// What is thought of the runs: name in the table, which is the heading, too, and how it is written.
const WORDS = [
  ['regime', (regime, { certain }) => regimeInWords(regime, certain)],
  ['verdict', verdictsInWords],
];

// As many decimals as the error has meaning.
function plain(mean, error) {
  if (!(error > 0)) return significant(mean);
  const power = Math.abs(mean) < 1e-3 || Math.abs(mean) >= 1e6 ? Math.floor(Math.log10(Math.max(Math.abs(mean), error))) : 0;
  const scale = 10 ** power;
  const decimals = Math.min(Math.max(1 - Math.floor(Math.log10(error / scale)), 0), 12);
  const both = `${(mean / scale).toFixed(decimals)} ± ${(error / scale).toFixed(decimals)}`;
  return power === 0 ? both : `(${both})·10${superscript(power)}`;
}

function angle(mean, error) {
  if (!(error > 0)) return degrees(mean);
  return `${plain(mean, error)}°`;
}

function share(mean, error) {
  if (!(error > 0)) return percent(mean);
  const text = plain(100 * mean, 100 * error);
  return text.startsWith('(') ? `${text} %` : `(${text}) %`;
}

// The measures that the process's description puts into such a table: [name in the results, heading, how a number is written].
function measuresOf(schemas) {
  const members = Object.values(schemas).flatMap(({ properties = {} }) => Object.entries(properties).flatMap(([name, schema]) =>
    [[name, schema], ...Object.entries(schema.properties ?? {}).map(([inner, its]) => [`${name}_${inner}`, its])]));
  return members.filter(([, schema]) => schema['x-study-order'])
    .sort(([, a], [, b]) => a['x-study-order'] - b['x-study-order'])
    .map(([name, schema]) => [name, headingOf(schema), schema['x-unit'] === 'degrees' ? angle : schema['x-shown']?.factor === 100 ? share : plain, schema['x-unit'] === 'degrees' ? '°' : '']);
}

const headingOf = schema => !schema['x-unit'] || schema['x-unit'] === 'degrees' ? schema.title : `${schema.title}, ${schema['x-unit']}`;

// The measures that any of the cases has.
export const measuresIn = (cases, schemas) => measuresOf(schemas).filter(([name], i) => cases.some(one => one.results[name] || (i === 0 && one.verdict)));

export const named = (cases, member) => [...new Set(cases.flatMap(one => Object.keys(one[member])))];

// What a row is sorted by under each head.
function valueUnder(one, head) {
  const [kind, name] = head;
  if (kind === 'case') return one.case;
  if (kind === 'runs') return one.finished;
  const value = kind === 'measure' ? one.results[name]?.mean : kind === 'word' ? one[name] : one[kind][name];
  return value === '' || value === undefined || value === null ? null : value;
}

function sorted(cases, { head, falls }) {
  if (!head) return cases;
  const compare = (a, b) => typeof a === 'number' && typeof b === 'number' ? a - b : String(a).localeCompare(String(b), 'en', { numeric: true });
  return [...cases].sort((one, other) => {
    const a = valueUnder(one, head), b = valueUnder(other, head);
    return a === null || b === null ? (a === null) - (b === null) : falls ? compare(b, a) : compare(a, b);
  });
}

// cases: those of the study that are known, of which there are `all`; schemas: of the process's results; order: {head, falls,
// page}; go(order): shows it otherwise; units: of inputs by their names; isWhole: all rows at once.
export function caseTable(cases, all, schemas, { order, go, units, isWhole = false }) {
  const inputs = named(cases, 'inputs'), labels = named(cases, 'label');
  const measures = measuresIn(cases, schemas);
  const words = WORDS.filter(([name]) => cases.some(one => one[name]));
  const head = (text, key, kind) => {
    const isIt = JSON.stringify(order.head) === JSON.stringify(key);
    return h('th', { scope: 'col', class: kind, 'aria-sort': isIt ? order.falls ? 'descending' : 'ascending' : null },
      h('button', { type: 'button', class: 'sorter', onclick: () => go({ head: isIt && order.falls ? null : key, falls: isIt && !order.falls, page: 0 }) }, text));
  };
  const pages = isWhole ? 1 : Math.ceil(cases.length / ROWS_SHOWN), shown = isWhole ? cases.length : ROWS_SHOWN, page = Math.min(order.page, pages - 1), first = page * shown;
  const table = h('table', { class: 'grid cases' },
    h('caption', { class: 'unseen' }, 'Cases, with means over their repeats and standard errors'),
    h('thead', null, h('tr', null, head('case', ['case']), inputs.map(name => head(units[name] ? `${name}, ${units[name]}` : name, ['inputs', name])),
      labels.map(name => head(name, ['label', name])), head('runs', ['runs']), words.map(([name]) => head(name, ['word', name])),
      measures.map(([name, heading]) => head(heading, ['measure', name], 'measure')))),
    h('tbody', null, sorted(cases, order).slice(first, first + shown).map(one => row(one, inputs, labels, measures, words))));
  const button = (text, to) => h('button', { type: 'button', onclick: () => go({ ...order, page: to }) }, text);
  const ways = pages <= 1 && cases.length === all ? null : h('nav', { class: 'pages', 'aria-label': 'Pages of the table' },
    h('span', { class: 'range' }, `${count(first + 1)}–${count(Math.min(first + shown, cases.length))} of ${count(all)}${cases.length < all ? `; ${count(cases.length)} read so far` : ''}`),
    page > 0 ? button('‹ Previous', page - 1) : null, page < pages - 1 ? button('Next ›', page + 1) : null);
  return [table, ways].filter(Boolean);
}

function row(one, inputs, labels, measures, words) {
  return h('tr', null,
    h('th', { scope: 'row' }, one.case),
    inputs.map(name => h('td', null, inWords(one.inputs[name]))),
    labels.map(name => h('td', null, inWords(one.label[name]))),
    h('td', null, `${count(one.finished)} of ${count(one.repeats)}`, one.failed ? h('small', { class: 'why' }, `${count(one.failed)} failed`) : null,
      one.warnings ? h('small', { class: 'why' }, one.warnings === 1 ? '1 warning' : `${count(one.warnings)} warnings`) : null),
    words.map(([name, write]) => h('td', null, one[name] ? write(one[name], one) : '–')),
    measures.map(([name, , write]) => measure(one.results[name], write)));
}

function inWords(value) {
  if (value === null || value === undefined) return '–';
  return typeof value === 'number' ? significant(value, 6) : typeof value === 'object' ? JSON.stringify(value) : String(value);
}

function measure(result, write) {
  if (!result) return h('td', { class: 'measure' }, '–');
  const from = {
    repeats: `standard error from the scatter of ${result.count} repeats`,
    runs: `standard error from the own errors of ${result.count} repeats, which scatter less`,
    run: 'standard error of the one run',
  }[result.error_from] ?? 'no error known';
  return h('td', { class: 'measure', title: from }, write(result.mean, result.standard_error));
}
