// What the page calls the results, and how it writes each, is told by the description of their process: title, x-unit, x-shown.
import { json, root } from './api.js';
import { count, degrees, duration, millimetres, significant, VERDICTS } from './format.js';

export const METHODS = {
  'surface-fit': 'line through the surface, middle of the chord',
  'center-of-mass': 'direction of the centre of mass',
  'chord': 'slope of the mean interface near the axis',
  'theil-sen': 'Theil-Sen line through the tops of columns',
  'upper-chord': 'upper half of the chord alone',
  'lower-chord': 'lower half of the chord alone',
  'azimuthal-fit': 'line through the flank between 80 and 20 % of the height, over azimuths',
  'apex-to-base': 'cone of the height and the base',
  'equal-volume-cone': 'cone of the volume and the base',
  'silhouette': 'triangle of the outline’s area and base, from all sides',
  'radial-fit': 'line through the surface between 20 and 80 % of the radius, over azimuths',
  'center-to-wall': 'from the middle to the wall',
  'area-fit': 'line through the whole surface',
};

// Of the results that are words, what these mean.
const MEANINGS = {
  ...VERDICTS,
  duration: 'after the time asked for', 'at-rest': 'when all was at rest', 'standard-error': 'when the angle was known well enough',
  'at-most-revolutions': 'after the most revolutions allowed',
};

// A process is asked once. What can't be described is shown under its own name.
const described = new Map();
export async function describe(process) {
  if (!described.has(process)) {
    const { inputs, outputs } = await json(`${root}processes/${encodeURIComponent(process)}`);
    described.set(process, {
      inputs, outputs,
      schemas: Object.fromEntries(Object.entries(outputs).map(([name, { schema }]) => [name, schema])),
      listed: listedIn(inputs).sort((a, b) => a.order - b.order),
    });
  }
  return described.get(process);
}

// {output: its JSON Schema}
export const schemasOf = async process => (await describe(process)).schemas;

// {input: {title, description, schema}}
export const describedInputs = async process => (await describe(process)).inputs;

// Of all schemas in a tree those that a list of jobs shows: {column, order, before, factor, after or unit, above, of, title}.
function listedIn(node) {
  if (node === null || typeof node !== 'object') return [];
  const own = node['x-listed'] ? [{ ...node['x-listed'], title: node.description }] : [];
  return [...own, ...Object.values(node).flatMap(listedIn)];
}

// So that inputsInWords has words for the inputs of these jobs.
export const learnInputs = jobs => Promise.all([...new Set(jobs.map(job => job.processID))].map(describe));

// The main inputs of a job, in the order in which an engineer asks for them: [{text, title}].
export function inputsInWords({ processID, summary = {} }) {
  const listed = described.get(processID)?.listed ?? [];
  const isShown = ({ column, above = -Infinity, of }) => typeof summary[column] === 'number' && summary[column] > above && !(summary[of] > 1);
  return listed.filter(isShown).map(({ column, before, factor, after, unit, title }) => {
    const value = summary[column] * factor;
    const text = OF_UNIT[unit] ? OF_UNIT[unit](value) : Number.isInteger(value) && !unit ? count(value) : `${significant(value)}${unit ? ` ${unit}` : ''}`;
    return { text: `${before}${text}${after ?? ''}`, title: unit === 'rad/s' ? `${title}: ${significant(value * 30 / Math.PI)} turns a minute` : title };
  });
}

const OF_UNIT = { degrees, m: millimetres, s: duration };

function numberInWords(value, schema) {
  const shown = schema['x-shown'], unit = schema['x-unit'];
  if (shown) return `${shown.digits ? significant(value * shown.factor, shown.digits) : value}${shown.suffix}`;
  if ([schema.type].flat().includes('integer')) return count(value);
  if (OF_UNIT[unit]) return OF_UNIT[unit](value);
  return unit ? `${significant(value)} ${unit}` : significant(value);
}

// [label, text] of a member of the results; schema: undefined where nothing describes it.
export function inWords(name, value, schema = {}) {
  const label = schema.title ?? name.replace(/_deg$/, '').replaceAll('_', ' ');
  if (value === null) return [label, '–'];
  if (typeof value === 'boolean') return [label, value ? 'yes' : 'no'];
  if (typeof value === 'string') return [label, MEANINGS[value] ?? value];
  if (typeof value !== 'number') return [label, JSON.stringify(value)];
  return [label, numberInWords(value, schema)];
}
