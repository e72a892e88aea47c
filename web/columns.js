// What a list of jobs can be sorted and filtered by, and show in columns of its own: facts of the job itself, and the inputs
// and results that its summary has, named by the descriptions of the processes.
import { count, degrees, duration, significant } from './format.js';

const FACTS = [['created', 'submitted'], ['started', 'started'], ['finished', 'finished'], ['updated', 'last change'], ['progress', 'progress'],
  ['priority', 'priority'], ['attempt', 'attempt'], ['estimated_seconds', 'estimated time']]
  .map(([name, title]) => ({ name, title, unit: '', isFact: true, isWord: false, isNumber: !['created', 'started', 'finished', 'updated'].includes(name) }));

function columnsIn(node, names, found) {
  if (node === null || typeof node !== 'object') return found;
  if (node['x-column']) found.set(node['x-column'], columnOf(node, names));
  for (const [name, member] of Object.entries(node.properties ?? {})) columnsIn(member, [...names, name], found);
  if (node.items) columnsIn(node.items, names, found);
  for (const one of node.oneOf ?? []) columnsIn(one, names, found);
  return found;
}

function columnOf(schema, names) {
  const types = [schema.type].flat(), isNumber = types.includes('number') || types.includes('integer') || types.includes('object');
  return { name: schema['x-column'], title: schema.title ?? names.join(' ').replaceAll('_', ' '), unit: schema['x-unit'] ?? '',
    isNumber, isWord: !isNumber && types.includes('string'), choices: (schema.enum ?? []).filter(Boolean) };
}

// descriptions: of processes. [{name, title, unit, isNumber, isWord, choices}], inputs before results.
export function columnsOf(descriptions) {
  const found = new Map(), outputs = new Map();
  for (const { inputs } of descriptions)
    for (const [name, { schema }] of Object.entries(inputs)) columnsIn(schema, [name], found);
  for (const { outputs: own } of descriptions)
    for (const [name, { schema }] of Object.entries(own)) columnsIn(schema, [name], outputs);
  return [...FACTS, ...found.values(), ...[...outputs.values()].filter(({ name }) => !found.has(name))];
}

// A length is written in mm: heading and number agree.
const SHOWN = { m: ['mm', 1e3], 's': ['s', 1] };
export const headingOf = ({ title, unit }) => unit ? `${title}, ${unit === 'degrees' ? '°' : SHOWN[unit]?.[0] ?? unit}` : title;

export function cellOf({ name, unit, isFact }, job) {
  const value = isFact ? job[name] ?? job.summary?.[name] : job.summary?.[name];
  if (value === null || value === undefined) return '–';
  if (typeof value === 'boolean') return value ? 'yes' : 'no';
  if (name === 'estimated_seconds') return duration(value);
  if (typeof value !== 'number') return String(value);
  if (name === 'seed') return String(value);
  if (unit === 'degrees') return degrees(value).replace('°', '');
  return Number.isInteger(value) && !unit ? count(value) : significant(value * (SHOWN[unit]?.[1] ?? 1), 4);
}
