// The tables of a comparison: a column a job.
import { h } from './dom.js';
import { inputLeaves, nameOfInput, valueInWords } from './input_table.js';
import { leafInWords, resultLeaves, titleOf } from './result_table.js';
import { significant } from './format.js';

const FAR = 3; // standard errors, from which a difference is marked

function tableOf(caption, sides, rows) {
  return h('table', { class: 'sheet' }, h('caption', { class: 'unseen' }, caption),
    h('thead', null, h('tr', null, h('th', { scope: 'col' }, 'name'), sides.map(({ name }) => h('th', { scope: 'col' }, h('bdi', null, name))))), h('tbody', null, rows));
}

export function comparedInputs(sides) {
  const of = sides.map(({ spec, described, job }) => new Map([['process', { value: job.processID }],
    ...inputLeaves(spec.inputs, described).map(leaf => [nameOfInput(leaf.path), leaf])]));
  const names = [...new Set(of.flatMap(map => [...map.keys()]))];
  const differing = names.filter(name => new Set(of.map(map => JSON.stringify(map.get(name)?.value))).size > 1);
  if (differing.length === 0) return h('p', null, 'None: these jobs have the same inputs.');
  const cell = leaf => {
    if (!leaf) return h('td', { class: 'quiet' }, '–');
    const [text, beside] = valueInWords(leaf.value, leaf.schema);
    return h('td', null, text, beside ? h('small', null, beside) : null);
  };
  return tableOf('Inputs that differ', sides, differing.map(name => h('tr', null,
    h('th', { scope: 'row', title: of.map(map => map.get(name)?.schema?.description).find(Boolean) }, h('code', null, name)), of.map(map => cell(map.get(name))))));
}

// By how many standard errors of their difference two values are apart; null where neither has one.
export function distance(one, other) {
  if (typeof one?.value !== 'number' || typeof other?.value !== 'number') return null;
  const error = Math.hypot(one.error ?? 0, other.error ?? 0);
  return typeof one.error === 'number' && typeof other.error === 'number' && error > 0 ? (other.value - one.value) / error : null;
}

export function comparedResults(sides) {
  const of = sides.map(({ results, schemas }) => new Map(results ? resultLeaves(results, schemas).map(leaf => [[...leaf.group, leaf.name].join('.'), leaf]) : []));
  const names = [...new Set(of.flatMap(map => [...map.keys()]))].filter(name => of.some(map => (map.get(name)?.value ?? null) !== null));
  if (names.length === 0) return h('p', null, 'None of these jobs has results yet.');
  const cell = (leaf, first) => {
    if (!leaf) return h('td', { class: 'quiet' }, '–');
    const away = first === leaf ? null : distance(first, leaf);
    return h('td', null, leafInWords(leaf), away === null ? null : h('small', { class: Math.abs(away) >= FAR ? 'far' : null, title: 'difference from the first job over the standard error of that difference' },
      `${away < 0 ? '−' : '+'}${significant(Math.abs(away), 2)} standard errors`));
  };
  return tableOf('Results side by side', sides, names.map(name => {
    const leaf = of.map(map => map.get(name)).find(Boolean);
    return h('tr', { title: name }, h('th', { scope: 'row', title: leaf.schema?.description }, titleOf(leaf), h('small', null, leaf.group.join(' · '))), of.map(map => cell(map.get(name), of[0].get(name))));
  }));
}
