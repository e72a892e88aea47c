// All inputs of a job, as it was run: each with its unit, what it means, and a mark where it is not the default.
import { h } from './dom.js';
import { significant } from './format.js';

const isRecord = value => value !== null && typeof value === 'object' && !Array.isArray(value);
const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);
// Beside SI, what people say: [unit, factor].
const SAID = { 'm': ['mm', 1000, value => value < 1], 'rad/s': ['rpm', 30 / Math.PI, () => true] };

// A schema of what has this value, where there are several ways to give it.
function chosen(schema, value) {
  const ways = schema?.oneOf ?? schema?.anyOf;
  return ways?.find(way => [way.type].flat().includes(isRecord(value) ? 'object' : Array.isArray(value) ? 'array' : typeof value)) ?? schema;
}

// [{path, value, schema, isDefault: true, false, or null where there is none}] of all that has no members of its own.
export function leavesOf(value, schema, path = []) {
  const own = chosen(schema, value);
  if (isRecord(value)) return Object.entries(value).flatMap(([name, member]) => leavesOf(member, own?.properties?.[name], [...path, name]));
  if (Array.isArray(value) && value.some(isRecord)) return value.flatMap((item, k) => leavesOf(item, own?.items, [...path, k]));
  return [{ path, value, schema: own, isDefault: schema?.default === undefined ? null : same(schema.default, value) }];
}

const written = value => typeof value === 'number' ? String(Number(value.toPrecision(6))) : typeof value === 'string' ? value : value === null ? 'none'
  : typeof value === 'boolean' ? (value ? 'yes' : 'no') : JSON.stringify(value);

export function valueInWords(value, schema) {
  const unit = schema?.['x-unit'], said = SAID[unit];
  if (typeof value !== 'number') return [written(value), ''];
  const beside = said?.[2](Math.abs(value)) ? `${significant(value * said[1], 5)} ${said[0]}` : '';
  return [`${written(value)}${unit ? ` ${unit}` : ''}`, beside];
}

export const nameOfInput = path => path.map((part, k) => typeof part === 'number' ? `[${part}]` : k ? `.${part}` : part).join('').replace(/^\./, '');

// inputs: of the job's spec. described: the inputs of its process, by name.
export function inputLeaves(inputs, described) {
  return Object.entries(inputs).flatMap(([name, value]) => leavesOf(value, described[name]?.schema, [name]));
}

// A table a group of inputs, so that they flow in columns.
export function inputTables(inputs, described) {
  const groups = new Map();
  for (const leaf of inputLeaves(inputs, described)) {
    const group = leaf.path.length > 1 ? leaf.path[0] : '';
    groups.set(group, [...groups.get(group) ?? [], leaf]);
  }
  return h('div', { class: 'sheets' }, [...groups].map(([group, leaves]) => h('table', { class: 'sheet inputs-sheet' },
    h('caption', null, group || 'all else', group && described[group]?.description ? h('small', null, ` ${described[group].description}`) : null),
    h('thead', { class: 'unseen' }, h('tr', null, ['input', 'value', 'meaning'].map(name => h('th', { scope: 'col' }, name)))),
    h('tbody', null, leaves.map(leaf => inputRow(leaf, described))))));
}

function inputRow({ path, value, schema, isDefault }, described) {
  const [text, beside] = valueInWords(value, schema), name = nameOfInput(path.length > 1 ? path.slice(1) : path);
  return h('tr', { class: isDefault === true ? 'usual' : 'own', title: nameOfInput(path) }, h('th', { scope: 'row' }, h('code', null, name)),
    h('td', null, text, beside ? h('small', null, beside) : null,
      isDefault === false ? h('span', { class: 'set', title: `default: ${valueInWords(schema.default, schema)[0]}` }, 'not default') : null),
    h('td', { class: 'meaning' }, schema?.description ?? described[path[0]]?.description ?? ''));
}

// What must be said to get this job again: all that is not the default.
export function withoutDefaults(value, schema) {
  const own = chosen(schema, value);
  if (Array.isArray(value)) return value.some(isRecord) ? value.map(item => withoutDefaults(item, own?.items)) : value;
  if (!isRecord(value)) return value;
  const kept = Object.entries(value).filter(([name, member]) => {
    const inner = own?.properties?.[name];
    return inner?.default === undefined || !same(inner.default, member);
  }).map(([name, member]) => [name, withoutDefaults(member, own?.properties?.[name])]);
  return Object.fromEntries(kept.filter(([, member]) => !isRecord(member) || Object.keys(member).length > 0));
}

export function shortInputs(inputs, described) {
  const schema = { properties: Object.fromEntries(Object.entries(described).map(([name, { schema: of }]) => [name, of])) };
  return withoutDefaults(inputs, schema);
}
