// What a calibration has found: the verdict, each parameter with its regions, the posterior, predictions beside measured values,
// the sets that were verified, what to measure next, the material for other programs, and the runs.
import { h } from './dom.js';
import { root } from './api.js';
import { count, duration, percent, significant } from './format.js';
import { pairsPlot } from './pairs_plot.js';
import { predictionPlot } from './prediction_plot.js';
import { pictureButton } from './saved_picture.js';

const VERDICTS = {
  identified: 'The measured values tell the parameters.',
  ridge: 'Other sets fit as well: the measured values do not tell them apart.',
  unreachable: 'No set within the ranges gives all measured values.',
  unfinished: 'More runs would tell more.',
};
const ROWS = 300; // runs in the table
const NO = '–';

const jobPage = id => `${root}web/job.html?id=${encodeURIComponent(id)}`;
const isNumber = value => typeof value === 'number' && Number.isFinite(value);
const withError = (value, error) => isNumber(value) ? isNumber(error) ? `${significant(value, 4)} ± ${significant(error, 2)}` : significant(value, 4) : NO;
const withUnit = (name, unit) => unit ? `${name}, ${unit}` : name;
const section = (heading, ...parts) => h('section', { class: 'calibration-part' }, h('h2', null, heading), ...parts);
const table = (caption, heads, rows) => h('div', { class: 'wide', tabindex: '0', role: 'group', 'aria-label': caption },
  h('table', { class: 'grid' }, h('caption', { class: 'unseen' }, caption),
    h('thead', null, h('tr', null, heads.map(head => h('th', { scope: 'col' }, head)))),
    h('tbody', null, rows.map(([first, ...cells]) => h('tr', null, h('th', { scope: 'row' }, first), cells.map(cell => h('td', null, cell)))))));

// request: as it was posted; results: the document of its results; names: of calibration_names.js.
export function calibrationView(request, { progress, answer, runs }, names) {
  const pointers = [...names.parameters.keys()], found = answer?.credible ? answer : null;
  return [answer ? verdict(answer) : progress ? underWay(progress) : null,
    found ? parametersOf(found, names) : null,
    runs.length ? posteriorOf(found, runs, pointers, names) : null,
    found ? predictionsOf(found, names) : null,
    found?.next_test.length ? nextOf(found) : null,
    found?.family.length ? familyOf(found, pointers, names) : null,
    found ? dependenceOf(found, pointers, names) : null,
    found?.snippets ? snippetsOf(found) : null,
    runs.length ? runsOf(runs, pointers, names) : null].filter(Boolean);
}

function verdict({ status, words, cost }) {
  return h('section', { class: `verdict ${status}` }, h('p', null, h('strong', null, status), ` ${VERDICTS[status] ?? ''}`),
    h('ul', null, words.map(sentence => h('li', null, sentence))),
    h('p', { class: 'quiet' }, `${count(cost.jobs)} jobs${cost.failed ? `, ${count(cost.failed)} of them failed` : ''}; ${duration(cost.processor_seconds)} of processor time`));
}

function underWay({ emulators }) {
  if (!emulators?.length) return null;
  return section('So far', table('How well the runs tell the targets so far', ['target', 'known to', 'wanted'],
    emulators.map(one => [one.target, significant(one.emulator_error, 2), significant(one.wanted, 2)])));
}

function parametersOf({ best, credible }, { parameters }) {
  const interval = ([low, high]) => `${significant(low)} … ${significant(high)}`;
  return section('Parameters', table('Parameters with the regions that hold them', ['parameter', 'unit', 'likeliest', 'middle 68 %', 'middle 95 %', 'sought in'],
    [...parameters].map(([pointer, { name, unit, title, low, high }]) => [h('span', { title: title || pointer }, name), unit || NO, significant(best.parameters[pointer], 4),
      interval(credible[pointer][68]), interval(credible[pointer][95]), interval([low, high])])));
}

function posteriorOf(found, runs, pointers, { parameters }) {
  const axes = pointers.map(pointer => { const one = parameters.get(pointer);
    return { ...one, label: withUnit(one.short, one.unit), region68: found?.credible[pointer][68], region95: found?.credible[pointer][95] }; });
  const of = values => pointers.map(pointer => values.parameters[pointer]);
  const drawing = pairsPlot(axes, { draws: found?.samples ?? [], runs: runs.filter(run => run.stage !== 'verify').map(of), family: (found?.family ?? []).map(of) });
  return section('What fits', h('figure', null, drawing,
    h('figcaption', null, found ? 'Dots: sets that fit, as often as they are likely. Rings: runs. Crosses: sets verified by fresh beds. Shaded: the middle 68 and 95 %. ' : 'Rings: runs so far. ',
      pictureButton(drawing, 'posterior'))));
}

// Units by the order of the measured values, where each of them is there.
const unitsOf = (list, names) => { const all = names.flatMap(({ unit, points }) => Array(points).fill(unit)); return all.length === list.length ? all : []; };

function predictionsOf({ best, validation }, { targets, holdOuts }) {
  const row = isHeldOut => one => ({ label: one.target, value: one.value, error: isHeldOut ? one.standard_error : one.value_standard_error,
    predicted: one.predicted, predictedError: isHeldOut ? one.predicted_standard_error : one.standard_error, z: one.z, isHeldOut });
  const units = [...unitsOf(best.targets, targets), ...unitsOf(validation, holdOuts)];
  const rows = [...best.targets.map(row(false)), ...validation.map(row(true))], hasUnits = units.length === rows.length;
  const drawing = predictionPlot(rows);
  return section('Measured and predicted', h('figure', null, drawing, h('figcaption', null, 'Points: the likeliest set. Shaded: one and two errors of the measurement. ', pictureButton(drawing, 'predictions'))),
    table('Measured values and predictions', ['target', 'unit', 'measured', 'predicted', 'errors apart', 'used'],
      rows.map((one, i) => [one.label, hasUnits ? units[i] || NO : NO, withError(one.value, one.error), withError(one.predicted, one.predictedError), significant(one.z, 2), one.isHeldOut ? 'held out' : 'fitted'])),
    h('p', { class: 'quiet' }, `Chi square ${significant(best.chi_square)} with ${best.degrees_of_freedom} of freedom: chance makes more in ${percent(best.probability)} of all cases.`));
}

function nextOf({ next_test: tests }) {
  return section('What to measure next', table('Tests that would tell more', ['test', 'would take from what is least known', 'if known to', 'a run takes', 'inputs'],
    tests.map(one => [`${one.process}: ${one.name}`, percent(one.would_shrink), significant(one.standard_error), duration(one.estimated_seconds),
      h('details', null, h('summary', null, 'show'), h('pre', null, JSON.stringify(one.inputs, null, 1)))])));
}

function familyOf({ family }, pointers, { parameters }) {
  const targets = family[0].results.map(one => one.target);
  return section('Sets that were run afresh', table('Sets verified by fresh beds', [...pointers.map(pointer => withUnit(parameters.get(pointer).short, parameters.get(pointer).unit)), ...targets],
    family.map(({ parameters: values, results }) => [...pointers.map(pointer => significant(values[pointer], 3)), ...results.map(one => isNumber(one.result)
      ? `${withError(one.result, one.standard_error)}${isNumber(one.predicted) ? ` (predicted ${significant(one.predicted, 4)})` : ''}` : NO)])));
}

function dependenceOf({ directions, sensitivity }, pointers, { parameters }) {
  return section('What depends on what', h('ul', null, directions.map(one => h('li', null, one.words, '.'))),
    table('Share of each target’s variance over the ranges', ['target', ...pointers.map(pointer => `by ${parameters.get(pointer).short} (alone)`)],
      sensitivity.map(one => [one.target, ...pointers.map(pointer => `${percent(one.total[pointer])} (${percent(one.first_order[pointer])})`)])));
}

function snippetsOf({ snippets }) {
  return section('The likeliest set for other programs', Object.entries(snippets).map(([program, { text, does_not_carry_over: losses }]) =>
    h('details', { class: 'snippet' }, h('summary', null, program), h('pre', { tabindex: '0' }, h('code', null, text)), h('ul', null, losses.map(loss => h('li', null, loss))))));
}

function runsOf(runs, pointers, { parameters }) {
  const measured = [...new Set(runs.flatMap(run => Object.keys(run.values)))], shown = runs.slice(-ROWS).reverse();
  return section('Runs', runs.length > ROWS ? h('p', { class: 'quiet' }, `The last ${count(ROWS)} of ${count(runs.length)}; all are in the CSV.`) : '',
    table('Runs, newest first', ['run', 'test', 'state', ...pointers.map(pointer => withUnit(parameters.get(pointer).short, parameters.get(pointer).unit)), ...measured],
      shown.map(run => [run.job ? h('a', { href: jobPage(run.job) }, `${run.stage} ${run.number}`) : `${run.stage} ${run.number}`, run.process,
        h('span', { class: `badge ${run.status}` }, run.status), ...pointers.map(pointer => significant(run.parameters[pointer], 4)),
        ...measured.map(name => run.values[name] ? withError(run.values[name].value, run.values[name].standard_error) : NO)])));
}
