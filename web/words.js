// What the page calls the results, and how it writes each. A field added later shows under its own name rather than not at all.
import { count, degrees, duration, millimetres, percent, significant, VERDICTS } from './format.js';

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

const micro = metres => `${significant(1e6 * metres)} µm`;
const degreesARevolution = value => `${significant(value, 2)}° a revolution`;
const errorInDegrees = value => `${significant(value, 2)}°`;
const newtonMetres = value => `${significant(value)} N m`;

// Of the results that are one of several words, what each means.
const MEANINGS = {
  verdict: VERDICTS,
  ended_by: {
    duration: 'after the time asked for', 'at-rest': 'when all was at rest', 'standard-error': 'when the angle was known well enough',
    'at-most-revolutions': 'after the most revolutions allowed',
  },
};

export const WORDS = {
  omega2_outer: ['ω²R/g at the wall'],
  omega2_inner: ['ω²R/g at the inner surface'],
  drift_deg_per_revolution: ['drift', degreesARevolution], drift_bound_deg_per_revolution: ['drift at most', degreesARevolution],
  steady: ['steady'], verdict: ['verdict'], layers: ['bed, in particle diameters deep'],
  interface_fluctuation: ['fluctuation of the interface', micro],
  window_start: ['measured from', value => `${significant(value)} s`],
  window_end: ['measured to', value => `${significant(value)} s`],
  window_revolutions: ['revolutions measured'], window_correlation_times: ['correlation times measured'],
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
  count: ['seen from beginning to end', count], start_deg: ['they begin at'], stop_deg: ['they end at'], size_deg: ['size'],
  period: ['period', value => `${significant(value)} s`], period_standard_error: ['its error', value => `${significant(value)} s`],
  start_standard_error_deg: ['its error', errorInDegrees], stop_standard_error_deg: ['its error', errorInDegrees],
  size_standard_error_deg: ['its error', errorInDegrees],
  height: ['height', millimetres], center_height: ['height in the middle', millimetres], wall_height: ['height at the wall', millimetres],
  base_diameter: ['base', value => `${millimetres(value)} across`],
  volume: ['volume', value => `${significant(1e6 * value)} cm³`],
  static_cohesive_index: ['static cohesive index', micro], azimuths: ['azimuths', count],
  inside: ['in the bed', count], apart: ['apart from it', count], lost: ['lost', count], waiting: ['never entered', count],
  name: ['regime'], certain: ['certain'], method: ['definition'],
  wall_slip: ['slip at the wall'], wall_slip_fluctuation: ['fluctuation of the slip at the wall'],
  angle_fluctuation_deg: ['fluctuation of the angle'], flow_fluctuation: ['fluctuation of the surface flow'],
  curvature_deg: ['upper less lower half of the chord'],
  surface_lag: ['inner surface lags by', value => `${significant(value)} rad a revolution`],
  keeps_contact: ['keeps contact'], goes_round: ['goes round'], at_rest: ['at rest'],
  angle_deg: ['angle'], standard_error_deg: ['its error', errorInDegrees], minimum_deg: ['lowest'], maximum_deg: ['highest'],
  spheres: ['spheres', count], isa: ['instruction set'], precision: ['precision of contacts'],
  ended_by: ['ended'],
  airborne_fraction: ['airborne', percent], wall_coverage: ['wall covered', percent],
  fallen_fraction: ['lately fallen', percent],
};

export function inWords(name, value) {
  const [label, format] = WORDS[name] ?? [name.replace(/_deg$/, '').replaceAll('_', ' ')];
  if (value === null) return [label, '–'];
  if (typeof value === 'boolean') return [label, value ? 'yes' : 'no'];
  if (typeof value === 'string') return [label, MEANINGS[name]?.[value] ?? value];
  if (typeof value !== 'number') return [label, JSON.stringify(value)];
  if (format) return [label, format(value)];
  return [label, name.endsWith('_deg') ? degrees(value) : significant(value)];
}
