// All results of a job: each with its error, unit and meaning as its process describes it. There is no other list of names.
import { h } from './dom.js';
import { degrees } from './format.js';
import { inWords } from './words.js';

const isRecord = value => value !== null && typeof value === 'object' && !Array.isArray(value);
const errorNames = name => [`${name}_standard_error`, name.endsWith('_deg') ? `${name.slice(0, -4)}_standard_error_deg` : '', name === 'angle_deg' ? 'standard_error_deg' : ''];

// [{group, name, value, error, schema, errorSchema}] of all that is a number, a word or a yes; errors beside what they are of.
export function resultLeaves(results, schemas) {
  const leaves = [];
  const walk = (object, schema, group) => {
    const errors = new Set();
    for (const [name, value] of Object.entries(object)) {
      if (isRecord(value)) continue;
      if (Array.isArray(value)) continue; // profiles, stages, beds and warnings are shown by themselves
      const errorName = errorNames(name).find(one => one && one in object);
      if (errorName) errors.add(errorName);
      leaves.push({ group, name, value, error: errorName ? object[errorName] : undefined, schema: memberOf(schema, name), errorSchema: memberOf(schema, errorName), errors });
    }
    for (const [name, value] of Object.entries(object)) {
      if (!isRecord(value) || name.endsWith('standard_error_deg')) continue;
      const inner = memberOf(schema, name);
      if (object[`${name}_standard_error_deg`]) walkPairs(value, object[`${name}_standard_error_deg`], inner, [...group, name]);
      else walk(value, inner, [...group, name]);
    }
  };
  const walkPairs = (values, errors, schema, group) => {
    for (const [name, value] of Object.entries(values))
      leaves.push({ group, name, value, error: errors[name], schema: { 'x-unit': schema?.['x-unit'], description: schema?.description, title: name }, errors: new Set() });
  };
  for (const [output, object] of Object.entries(results)) if (isRecord(object)) walk(object, schemas[output], [output]);
  return leaves.filter(({ name, errors }) => !errors.has(name));
}

const memberOf = (schema, name) => schema?.properties?.[name] ?? (isRecord(schema?.additionalProperties) ? schema.additionalProperties : undefined);

export function leafInWords({ name, value, error, schema, errorSchema }) {
  if (typeof value === 'number' && schema?.['x-unit'] === 'degrees' && !schema['x-shown']) return degrees(value, error);
  const text = inWords(name, value, schema)[1];
  return typeof error === 'number' ? `${text} ± ${inWords('error', error, errorSchema ?? schema)[1]}` : text;
}

export const titleOf = ({ name, schema }) => inWords(name, null, schema)[0];

// A table a group, so that they flow in columns; of groups that have nothing to tell, their names.
export function resultTables(results, schemas) {
  const groups = new Map();
  for (const leaf of resultLeaves(results, schemas)) {
    const group = leaf.group.join(' · ').replaceAll('_', ' ');
    groups.set(group, [...groups.get(group) ?? [], leaf]);
  }
  const isSilent = ([, leaves]) => leaves.every(({ value }) => value === null);
  const silent = [...groups].filter(isSilent).map(([group]) => group);
  return h('div', { class: 'sheets' }, [...groups].filter(group => !isSilent(group)).map(([group, leaves]) => h('table', { class: 'sheet results-sheet' },
    h('caption', null, group),
    h('thead', { class: 'unseen' }, h('tr', null, ['result', 'value', 'meaning'].map(name => h('th', { scope: 'col' }, name)))),
    h('tbody', null, leaves.map(leaf => h('tr', { title: [...leaf.group, leaf.name].join('.') }, h('th', { scope: 'row' }, titleOf(leaf)), h('td', null, leafInWords(leaf)),
      h('td', { class: 'meaning' }, leaf.schema?.description ?? '')))))),
  silent.length ? h('p', { class: 'quiet' }, `This run has none of: ${silent.join(', ')}.`) : null);
}
