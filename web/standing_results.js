// The results of a heap and of a filled cylinder in readable form.
import { h } from './dom.js';
import { degrees, millimetres, percent } from './format.js';
import { angleOf, angleTable, rangeOf, section } from './results.js';

function steepness(repose) {
  return [angleOf(repose), repose.angle_deg === null ? h('span', null, 'too few particles for an angle')
    : rangeOf(repose, ` over ${repose.azimuths} azimuths`)];
}

export function heapAnswer({ repose = {}, surface = {}, heap = {} }) {
  return h('section', { class: 'answer' }, h('p', null, ...steepness(repose),
    h('span', null, `${millimetres(surface.height)} high on a base of ${millimetres(surface.base_diameter)}`),
    h('span', null, [heap.lost ? `${heap.lost} particles lost from the plate` : 'nothing lost',
      heap.at_rest ? 'at rest' : 'not at rest yet'].join(', '))));
}

export function fillAnswer({ repose = {}, packing = {}, fill = {} }) {
  const before = repose.while_filling ?? {};
  return h('section', { class: 'answer' }, h('p', null, ...steepness(repose),
    before.angle_deg === null ? null
      : h('span', null, `${degrees(before.angle_deg, before.standard_error_deg)} while the stream ran`),
    packing.solid_fraction === null ? null : h('span', null, `${percent(packing.solid_fraction)} solid in the core`),
    h('span', null, fill.at_rest ? 'at rest' : 'not at rest yet')));
}

const OUTPUTS = { surface: 'Surface', packing: 'Packing', heap: 'Particles', fill: 'Particles', run: 'Run' };

export function standingInWords({ repose = {}, ...others }, schemas) {
  return h('div', { class: 'results' },
    section('Angle', { azimuths: repose.azimuths }, schemas.repose, angleTable(repose)),
    repose.while_filling ? section('While the stream ran', repose.while_filling, schemas.repose?.properties?.while_filling) : null,
    Object.entries(others).map(([name, value]) => section(OUTPUTS[name] ?? name, value, schemas[name])));
}
