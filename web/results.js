// The results of a run in readable form.
import { h } from './dom.js';
import { count, degrees, NO_ANGLE, regimeInWords, significant, verdictInWords } from './format.js';
import { drumPicture } from './drum_picture.js';
import { inWords, METHODS } from './words.js';

// schema: of the object; undefined where nothing describes it.
function facts(object, schema) {
  const rows = Object.entries(object).map(([name, value]) => {
    const [label, text] = inWords(name, value, schema?.properties?.[name]);
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

export function section(title, object, schema, ...extra) {
  const plain = Object.fromEntries(Object.entries(object ?? {}).filter(([name, value]) => !isRecord(value) && !Array.isArray(value)));
  return h('section', null, h('h3', null, title), ...extra, facts(plain, schema));
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

export const angleOf = repose => h('strong', null, repose.angle_deg === null ? NO_ANGLE : degrees(repose.angle_deg, repose.standard_error_deg));

// over: of what it is the range.
export const rangeOf = ({ minimum_deg: low, maximum_deg: high }, over = '') =>
  low === null || high === null ? null : h('span', null, `from ${degrees(low)} to ${degrees(high)}${over}`);

// The answer of a drum first: the angle, large, in the drum's picture, and what to think of it.
export function answer(repose, regime, summary) {
  return h('section', { class: 'answer' },
    drumPicture({ ...summary, angle_deg: repose.angle_deg }, 116),
    h('p', null,
      angleOf(repose), rangeOf(repose),
      h('span', null, [regime?.name && regimeInWords(regime.name, regime.certain), verdictInWords(repose)].filter(Boolean).join(', '))));
}

// A row a stage of the drum's rotation.
export function stageTable(stages) {
  return h('section', null, h('h3', null, 'Stages'),
    h('table', { class: 'methods' },
      h('thead', null, h('tr', null, ['rate', 'from', 'to', 'angle ± standard error', 'regime', 'verdict'].map(name => h('th', { scope: 'col' }, name)))),
      h('tbody', null, stages.map(stage => h('tr', null,
        h('th', { scope: 'row' }, `${significant(stage.rate, 4)} rad/s`),
        [`${significant(stage.from, 4)} s`, `${significant(stage.to, 4)} s`,
          stage.angle_deg === null ? NO_ANGLE : degrees(stage.angle_deg, stage.standard_error_deg),
          stage.regime ?? '', stage.verdict ?? ''].map(text => h('td', null, text)))))));
}

export function resultsInWords(results, schemas) {
  const { repose = {}, regime = {}, segregation, packing, drive, run, stages = [], ...others } = results;
  const hidden = ['angle_deg', 'standard_error_deg', 'minimum_deg', 'maximum_deg', 'method'];
  const rest = Object.fromEntries(Object.entries(repose).filter(([name]) => !hidden.includes(name)));
  const of = (output, group) => group ? schemas[output]?.properties?.[group] : schemas[output];
  return h('div', { class: 'results' },
    section('Angle of repose', { ...rest, ...repose.window },
      { properties: { ...of('repose')?.properties, ...of('repose', 'window')?.properties } }, angleTable(repose)),
    stages.length ? stageTable(stages) : null,
    repose.slumps?.count ? section('Slumps', repose.slumps, of('repose', 'slumps')) : null,
    section('Regime', { name: regime.name, ...regime }, of('regime')),
    isRecord(regime.predicted) ? section('Predicted boundaries of ω²R/g', regime.predicted, of('regime', 'predicted')) : null,
    isRecord(regime.evidence) ? section('Evidence for the regime', regime.evidence, of('regime', 'evidence')) : null,
    section('Segregation', segregation, of('segregation')),
    section('Packing', packing, of('packing')),
    drive ? section('Drive', drive, of('drive')) : null,
    section('Run', run, of('run')),
    Object.entries(others).map(([name, value]) => section(name.replaceAll('_', ' '), isRecord(value) ? value : { [name]: value }, of(name))));
}
