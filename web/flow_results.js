// The results of a flow through an orifice in readable form.
import { h } from './dom.js';
import { degrees } from './format.js';
import { section } from './results.js';

const grams = (value, digits) => Number((1e3 * value).toPrecision(digits)).toString();

function massFlow({ mass_rate: rate, mass_rate_standard_error: error }) {
  if (rate === null || rate === undefined) return 'no steady flow';
  return `${grams(rate, 4)} ${error === null ? '' : `± ${grams(error, 2)} `}g/s`;
}

export function flowAnswer({ flow = {}, drained = {} }) {
  const end = flow.clogged ? `clogged after ${Number(flow.clogged_at.toPrecision(3))} s` : drained.complete ? 'drained' : 'not ended yet';
  return h('section', { class: 'answer' }, h('p', null, h('strong', null, massFlow(flow)),
    h('span', null, `${flow.passed} particles passed, ${flow.left} left`), h('span', null, end),
    drained.angle_deg === null || drained.angle_deg === undefined ? null
      : h('span', null, `${degrees(drained.angle_deg)} drained angle`)));
}

const OUTPUTS = { flow: 'Flow', drained: 'What is left', packing: 'Packing before', outlet: 'At the orifice', run: 'Run' };

export function flowInWords(results, schemas) {
  return h('div', { class: 'results' },
    Object.entries(results).map(([name, value]) => section(OUTPUTS[name] ?? name, value, schemas[name])));
}
