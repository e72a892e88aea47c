// The results of a run in readable form. Fields known by name get a wording; a field added later shows
// under its own name rather than not at all.
import { h } from './dom.js';
import { count, degrees, duration, millimetres, percent, significant, verdictInWords } from './format.js';
import { drumPicture } from './drum_picture.js';

const METHODS = {
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

const micro = metres => `${significant(1e6 * metres)} µm`;
const newtonMetres = value => `${significant(value)} N m`;
const WORDS = {
  omega2_outer: ['ω²R/g at the wall'],
  omega2_inner: ['ω²R/g at the inner surface'],
  drift_deg_per_revolution: ['drift', value => `${significant(value, 2)}° a revolution`],
  interface_fluctuation: ['fluctuation of the interface', micro],
  start: ['measured from', value => `${significant(value)} s`],
  end: ['measured to', value => `${significant(value)} s`],
  correlation_time: ['correlation time', value => `${significant(value)} s`],
  radial_index: ['radial index'], axial_index: ['axial index'], lacey_index: ['Lacey index'],
  solid_fraction: ['solid fraction'], coordination_number: ['coordination number'],
  particles: ['particles', count], steps: ['steps', count], frames: ['frames in the window', count],
  threads: ['threads', count], seed: ['seed', String], attempts: ['attempts', count], attempt: ['attempt', count],
  time_step: ['time step', value => micro(value).replace('µm', 'µs')],
  simulated_seconds: ['simulated', duration], wall_seconds: ['wall clock', duration],
  settling_seconds: ['settling', duration],
  particle_steps_per_second: ['particle steps a second', value => significant(value)],
  maximum_overlap: ['largest overlap', value => `${percent(value)} of the smallest diameter`],
  stiffness: ['stiffness', value => `${significant(value, 4)} N/m`],
  stationary_eq33: ['stationary on the wall, Eq 33'],
  sliding_eq35: ['sliding, Eq 35'], sliding_eq36: ['sliding, Eqns 36–37'],
  fill_fraction: ['fill fraction', percent], samples: ['samples', count], snapshots: ['snapshots', count],
  minimum_omega2: ['least ω²R/g', value => significant(value, 7)],
  error: ['within', value => `± ${significant(value, 2)}`],
  minimum_rotation_rate: ['least rate', value => `${significant(value, 7)} rad/s`],
  slip_per_revolution: ['slip', value => `${significant(value)} rad a revolution`],
  slip_onset_deg: ['slips from', value => `${degrees(value)} above the horizontal`],
  sliding_eq34: ['sliding, Eq 34'], least_normal_force: ['least force on the wall', value => `${significant(value)} of the weight`],
  revolutions: ['revolutions followed', count],
  mean_overlap: ['mean overlap', value => `${percent(value)} of the smallest diameter`],
  overlap_99: ['99 of 100 overlaps below', value => `${percent(value)} of the smallest diameter`],
  torque: ['torque', newtonMetres], torque_standard_error: ['its error', newtonMetres],
  weight_torque: ['torque of the bed’s weight', newtonMetres], weight_torque_standard_error: ['its error', newtonMetres],
  torque_number: ['torque over m g R', value => significant(value)], power: ['power', value => `${significant(value)} W`],
  period: ['period', value => `${significant(value)} s`], period_standard_error: ['its error', value => `${significant(value)} s`],
  start_standard_error_deg: ['its error', degrees], stop_standard_error_deg: ['its error', degrees],
  size_standard_error_deg: ['its error', degrees],
  height: ['height', millimetres], center_height: ['height in the middle', millimetres], wall_height: ['height at the wall', millimetres],
  base_diameter: ['base', value => `${millimetres(value)} across`],
  volume: ['volume', value => `${significant(1e6 * value)} cm³`],
  static_cohesive_index: ['static cohesive index', micro], azimuths: ['azimuths', count],
  inside: ['in the bed', count], apart: ['apart from it', count], lost: ['lost', count], waiting: ['never entered', count],
  airborne_fraction: ['airborne', percent], wall_coverage: ['wall covered', percent],
  fallen_fraction: ['lately fallen', percent],
};

function inWords(name, value) {
  const [label, format] = WORDS[name] ?? [name.replace(/_deg$/, '').replaceAll('_', ' ')];
  if (value === null) return [label, '–'];
  if (typeof value === 'boolean') return [label, value ? 'yes' : 'no'];
  if (typeof value !== 'number') return [label, typeof value === 'object' ? JSON.stringify(value) : String(value)];
  if (format) return [label, format(value)];
  return [label, name.endsWith('_deg') ? degrees(value) : significant(value)];
}

function facts(object) {
  const rows = Object.entries(object).map(([name, value]) => {
    const [label, text] = inWords(name, value);
    return h('div', null, h('dt', null, label), h('dd', null, text));
  });
  return h('dl', { class: 'facts' }, rows);
}

const isRecord = value => value !== null && typeof value === 'object' && !Array.isArray(value);

// What the run knows of itself and its numbers do not show at a glance; runs from before there were warnings have no list.
export function warningsOf(results) {
  const warnings = results.run?.warnings ?? [];
  return warnings.length === 0 ? null : h('div', { class: 'reason warnings', role: 'note' },
    h('h3', null, warnings.length === 1 ? 'A warning' : `${count(warnings.length)} warnings`),
    warnings.map(({ field, text }) => h('p', null, h('code', null, field), ` ${text}`)));
}

export function section(title, object, ...extra) {
  const plain = Object.fromEntries(Object.entries(object ?? {}).filter(([name, value]) => !isRecord(value) && name !== 'warnings'));
  return h('section', null, h('h3', null, title), ...extra, facts(plain));
}

export function angleTable(repose) {
  const errors = repose.other_methods_standard_error_deg ?? {};
  const rows = [[repose.method, repose.angle_deg, repose.standard_error_deg],
    ...Object.entries(repose.other_methods ?? {})
      .filter(([method]) => method !== repose.method)
      .map(([method, angle]) => [method, angle, errors[method]])];
  return h('table', { class: 'methods' },
    h('caption', { class: 'unseen' }, 'Angle under every definition'),
    h('thead', null, h('tr', null,
      h('th', { scope: 'col' }, 'definition'), h('th', { scope: 'col' }, 'angle ± standard error'))),
    h('tbody', null, rows.map(([method, angle, error]) => h('tr', null,
      h('th', { scope: 'row' }, method, METHODS[method] ? h('small', null, METHODS[method]) : null),
      h('td', null, degrees(angle, error))))));
}

// The answer of a drum first: the angle, large, in the drum's picture, and what to think of it.
export function answer(repose, regime, summary) {
  const known = regime?.name && regime.certain === false ? `${regime.name}, not certain` : regime?.name;
  return h('section', { class: 'answer' },
    drumPicture({ ...summary, angle_deg: repose.angle_deg }, 116),
    h('p', null,
      h('strong', null, degrees(repose.angle_deg, repose.standard_error_deg)),
      h('span', null, `from ${degrees(repose.minimum_deg)} to ${degrees(repose.maximum_deg)}`),
      h('span', null, [known, verdictInWords(repose)].filter(Boolean).join(', '))));
}

export function resultsInWords(results) {
  const { repose = {}, regime = {}, segregation, packing, drive, run, ...others } = results;
  const hidden = ['angle_deg', 'standard_error_deg', 'minimum_deg', 'maximum_deg', 'method'];
  const rest = Object.fromEntries(Object.entries(repose).filter(([name]) => !hidden.includes(name)));
  return h('div', { class: 'results' },
    section('Angle of repose', { ...rest, ...repose.window }, angleTable(repose)),
    repose.slumps?.count ? section('Slumps', repose.slumps) : null,
    section('Regime', { name: regime.name, ...regime }),
    isRecord(regime.predicted) ? section('Predicted boundaries of ω²R/g', regime.predicted) : null,
    isRecord(regime.evidence) ? section('Evidence for the regime', regime.evidence) : null,
    section('Segregation', segregation),
    section('Packing', packing),
    drive ? section('Drive', drive) : null,
    section('Run', run),
    Object.entries(others).map(([name, value]) => section(name.replaceAll('_', ' '), isRecord(value) ? value : { [name]: value })));
}
