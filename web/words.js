// What the page calls the results, and how it writes each, is told by the description of their process: title, x-unit, x-shown.
import { json } from './api.js';
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

// {output: its JSON Schema}; a process is asked once. What can't be described is shown under its own name.
const described = new Map();
export async function schemasOf(process) {
  if (!described.has(process)) {
    const { outputs } = await json(`/processes/${encodeURIComponent(process)}`);
    described.set(process, Object.fromEntries(Object.entries(outputs).map(([name, { schema }]) => [name, schema])));
  }
  return described.get(process);
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
