// The results of a single particle on the wall in readable form.
import { h } from './dom.js';
import { percent, significant } from './format.js';
import { section } from './results.js';

const REGIMES = {
  slipping: 'slides back before the horizontal, and never goes round',
  raining: 'falls off the wall',
  sliding: 'goes round, slipping a little each time',
  centrifuging: 'goes round with the wall and never slips',
};

export function granuleAnswer({ granule, regime }) {
  return h('section', { class: 'answer' },
    h('p', null,
      h('strong', null, `≥ ${significant(granule.minimum_rotation_rate, 4)} rad/s`),
      h('span', null, `keeps the particle on the wall: ω²R/g = ${significant(granule.minimum_omega2, 7)} ± ${significant(granule.error, 2)}`),
      regime?.name ? h('span', null, `At the rate given it is ${regime.name}: it ${REGIMES[regime.name] ?? ''}.`) : null));
}

// described: the fits, by name.
function fitTable({ minimum_omega2, fits, deviations }, described = {}) {
  return h('table', { class: 'methods' },
    h('caption', { class: 'unseen' }, 'What the paper has for the least ω²R/g'),
    h('thead', null, h('tr', null, ...['equation', 'ω²R/g', 'off by'].map(name => h('th', { scope: 'col' }, name)))),
    h('tbody', null, h('tr', null, h('th', { scope: 'row' }, 'this test'), h('td', null, significant(minimum_omega2, 4)), h('td')),
      Object.entries(fits).map(([name, fit]) => h('tr', null,
        h('th', { scope: 'row' }, described[name]?.title ?? name, h('small', null, described[name]?.description)),
        h('td', null, significant(fit, 4)), h('td', null, percent(deviations[name]))))));
}

export function granuleInWords({ granule, regime, run }, schemas) {
  const told = schemas.regime?.properties ?? {}, given = { properties: { ...told.evidence?.properties, ...told } };
  return h('div', { class: 'results' },
    section('Least rate', granule, schemas.granule, fitTable(granule, schemas.granule?.properties?.fits?.properties)),
    regime?.name ? section('At the rate given', { name: regime.name, omega2_outer: regime.omega2_outer, ...regime.evidence }, given) : null,
    section('Run', run, schemas.run));
}
