// The fields over a run's cross-section as maps: solid fraction, speed, granular temperature, each with its scale.
import { h } from './dom.js';
import { ApiError, jobPath, json } from './api.js';
import { onScale } from './bed_colors.js';
import { significant } from './format.js';

const NAMES = { solid_fraction: 'solid fraction', velocity: 'speed', granular_temperature: 'granular temperature' };

// One number a cell, row by row from the lowest; of a vector its length.
export function cellsOf({ components, values }) {
  if (components === 1) return values;
  return Array.from({ length: values.length / components }, (_, k) => {
    const vector = values.slice(components * k, components * (k + 1));
    return vector.includes(null) ? null : Math.hypot(...vector);
  });
}

function heatMap(name, field, { rows, columns }, isRound) {
  const cells = cellsOf(field), seen = cells.filter(cell => cell !== null);
  if (seen.length === 0) return null;
  const high = seen.reduce((most, cell) => Math.max(most, cell), 0);
  const canvas = h('canvas', { width: columns, height: rows, role: 'img', class: isRound ? 'round' : null,
    'aria-label': `${name} over the cross-section, from 0 to ${significant(high)} ${field.unit ?? ''}` });
  const context = canvas.getContext('2d'), image = context.createImageData(columns, rows);
  cells.forEach((cell, k) => {
    if (cell === null) return;
    const at = 4 * ((rows - 1 - Math.floor(k / columns)) * columns + k % columns); // the highest row is the picture's first
    image.data.set([...onScale(cell / (high || 1)), 255], at);
  });
  context.putImageData(image, 0, 0);
  const scale = h('span', { class: 'scale' });
  scale.style.background = `linear-gradient(to right, ${[0, 0.25, 0.5, 0.75, 1].map(share => `rgb(${onScale(share).join(' ')})`).join(', ')})`;
  const unit = (field.unit ?? '').replace('m2/s2', 'm²/s²');
  return h('figure', null, canvas, h('figcaption', { class: 'legend' }, h('span', null, name), '0', scale, `${significant(high)}${unit && unit !== '1' ? ` ${unit}` : ''}`));
}

// A part of the page that loads the fields when it is opened; null of a job that has none.
export function heatMaps(job) {
  if (!job.links?.some(link => link.rel === 'fields')) return null;
  const maps = h('div', { class: 'heat' });
  const load = async event => {
    if (!event.target.open || maps.childElementCount) return;
    try {
      const fields = await json(`${jobPath(job.jobID)}/fields.json`);
      maps.replaceChildren(...Object.entries(NAMES).map(([key, name]) => fields.fields[key] && heatMap(name, fields.fields[key], fields, job.processID === 'drum')).filter(Boolean),
        h('p', { class: 'quiet' }, `Means over ${fields.frames.toLocaleString('en')} samples of the measuring window.`));
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      maps.replaceChildren(h('p', { class: 'quiet' }, error.status === 404 ? 'This job kept its fields for programs only: fields.hdf, below.' : `Not loaded: ${error.message}.`));
    }
  };
  return h('section', { class: 'block fields' }, h('h2', null, 'Fields'), h('details', { ontoggle: load }, h('summary', null, 'Solid fraction, speed and granular temperature over the cross-section'), maps));
}
