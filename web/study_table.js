// The table of a study's cases: what differs between them, how many runs have ended, and mean ± standard error.
import { h } from './dom.js';
import { count, degrees, percent, regimeInWords, significant, superscript, verdictsInWords } from './format.js';

export const ROWS_SHOWN = 500;

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
  if (!(error > 0)) return degrees(mean, error);
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
    .map(([name, schema]) => [name, headingOf(schema), schema['x-unit'] === 'degrees' ? angle : schema['x-shown']?.factor === 100 ? share : plain]);
}

const headingOf = schema => !schema['x-unit'] || schema['x-unit'] === 'degrees' ? schema.title : `${schema.title}, ${schema['x-unit']}`;

// cases: the first of the study's, of which there are `all`; schemas: of the process's results.
export function caseTable(cases, all, schemas) {
  const named = member => [...new Set(cases.flatMap(one => Object.keys(one[member])))];
  const inputs = named('inputs'), labels = named('label');
  const measures = measuresOf(schemas).filter(([name], i) => cases.some(one => one.results[name] || (i === 0 && one.verdict)));
  const words = WORDS.filter(([name]) => cases.some(one => one[name]));
  const table = h('table', { class: 'grid cases' },
    h('caption', { class: 'unseen' }, 'Cases, with means over their repeats and standard errors'),
    h('thead', null, h('tr', null, ['case', ...inputs, ...labels, 'runs', ...words.map(([name]) => name)].map(name => h('th', { scope: 'col' }, name)),
      measures.map(([, heading]) => h('th', { scope: 'col', class: 'measure' }, heading)))),
    h('tbody', null, cases.slice(0, ROWS_SHOWN).map(one => row(one, inputs, labels, measures, words))));
  const left = all - Math.min(cases.length, ROWS_SHOWN);
  return left > 0 ? [table, h('p', { class: 'quiet' }, `The first ${ROWS_SHOWN} cases; the CSV has all ${count(all)}.`)] : [table];
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
