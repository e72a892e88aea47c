// Two to six jobs beside each other, ?ids=ID,ID: their beds on one clock, their curves laid over each other, the inputs that differ,
// and of the results how far they are from the first job's, in standard errors.
import { byId, h, replaceIfChanged } from './dom.js';
import { jobPath, json, root } from './api.js';
import { createBedPanel } from './bed_panel.js';
import { palette } from './bed_view.js';
import { createClock, transport } from './clock.js';
import { comparedInputs, comparedResults } from './compare_tables.js';
import { isOfAddress, showConnected, showFailure, showTrouble, takeToken } from './connection.js';
import { COLORS, createCurve } from './curve.js';
import { nameOf } from './job_name.js';
import { prepareForPaper } from './job_print.js';
import { SETTLED, startPolling } from './polling.js';
import { createSeries } from './sample_series.js';
import { describedInputs, schemasOf } from './words.js';

const FEWEST = 2, MOST = 6;

const ids = [...new Set((new URLSearchParams(location.search).get('ids') ?? '').split(',').filter(Boolean))];
const sides = []; // {id, job, spec, results, schemas, described, series, bed, name}
const clock = createClock({ ready: () => sides.every(side => side.bed.isReady()) });
let curve = null, quantity = '';

const refresh = startPolling(ask, (error, pause) => {
  showFailure(error, pause, refresh);
  if (isOfAddress(error)) byId('sheet').hidden = true;
}, change => ids.includes(change.jobID));
takeToken(refresh);

async function ask() {
  if (ids.length < FEWEST || ids.length > MOST) {
    showTrouble(`The address names ${ids.length} jobs; ${FEWEST} to ${MOST} can be compared: ?ids=ID,ID.`, null, root);
    return false;
  }
  if (sides.length === 0) sides.push(...await Promise.all(ids.map(begin)));
  if (!curve) build();
  showConnected();
  byId('sheet').hidden = false;
  const open = await Promise.all(sides.map(follow));
  await show();
  return open.some(Boolean) || SETTLED;
}

async function begin(id) {
  const [job, spec] = await Promise.all([json(jobPath(id)), json(`${jobPath(id)}/spec`)]);
  const [described, schemas] = await Promise.all([describedInputs(job.processID), schemasOf(job.processID)]);
  const series = createSeries(id, ['angle_deg', 'tube_height']);
  const bed = createBedPanel(job, { process: job.processID, inputs: spec.inputs }, clock, {
    angleAt: time => series.at('angle_deg', time), liftAt: time => series.at('tube_height', time) ?? 0, isSmall: true });
  return { id, job, spec, described, schemas, series, bed, results: null, isWhole: false };
}

function build() {
  nameApart();
  const colorBy = h('select', { class: 'color-by', 'aria-label': 'Colour by', onchange: () => sides.forEach(({ bed }) => bed.choose({ colorBy: colorBy.value })) },
    [['speed', 'speed'], ['species', 'species'], ['size', 'size'], ['contacts', 'contacts'], ['start-x', 'place at the start']].map(([value, name]) => h('option', { value }, name)));
  byId('beds').append(...sides.map(({ id, name, bed }, k) => {
    const dot = h('span', { class: 'swatch' });
    dot.style.backgroundColor = palette()[COLORS[k % COLORS.length]];
    return h('section', null, h('h2', null, dot, h('a', { href: `${root}web/job.html?id=${encodeURIComponent(id)}` }, h('bdi', null, name))), bed.element);
  }));
  byId('transport').append(transport(clock), h('p', { class: 'bed-tools' }, h('label', null, 'Colour the beds by ', colorBy)));
  curve = createCurve(byId('curve'), clock);
  byId('print').addEventListener('click', () => globalThis.print());
  document.title = `${sides.map(({ name }) => name).join(' / ')} · reposed`;
  prepareForPaper({ curve, bed: { view: { draw: () => sides.forEach(({ bed }) => bed.view?.draw()) } } });
}

// Jobs of one name are told apart by their ids.
function nameApart() {
  const names = sides.map(({ job }) => nameOf(job));
  sides.forEach((side, k) => { side.name = names.indexOf(names[k]) === names.lastIndexOf(names[k]) ? names[k] : `${names[k]} (${side.id.slice(-8)})`; });
}

// Whether it is still open.
async function follow(side) {
  if (side.isWhole) return false;
  side.job = await json(jobPath(side.id));
  const isOpen = side.job.status === 'accepted' || side.job.status === 'running';
  if (side.job.status === 'accepted') return true;
  side.series.choose(quantity ? [quantity] : []);
  await Promise.all([side.series.update(), side.bed.update()]);
  if (side.job.status === 'successful') side.results = await json(`${jobPath(side.id)}/results`);
  side.isWhole = !isOpen;
  return isOpen;
}

async function show() {
  const stops = [...new Set(sides.flatMap(({ bed }) => bed.store.list.map(frame => frame.time)))].sort((a, b) => a - b);
  const ends = sides.map(({ series }) => series.times.at(-1) ?? 0), isFirst = clock.to === 0;
  clock.extend(0, Math.max(...ends, stops.at(-1) ?? 0), stops);
  if (isFirst) clock.set(clock.to);
  showTools();
  await draw();
  replaceIfChanged(byId('inputs'), sides.map(({ id }) => id), () => comparedInputs(sides));
  replaceIfChanged(byId('results'), sides.map(({ job }) => job.status), () => comparedResults(sides));
}

function showTools() {
  const names = [...new Set(sides.flatMap(({ series }) => series.names()))];
  if (!names.includes(quantity)) quantity = names.includes('angle_deg') ? 'angle_deg' : names[0] ?? '';
  replaceIfChanged(byId('curve-tools'), names, () => {
    const select = h('select', { class: 'quantity', onchange: () => { quantity = select.value; draw().catch(error => showFailure(error, 0, refresh)); } },
      names.map(name => h('option', { value: name, selected: name === quantity }, name.replace(/_deg$/, '').replaceAll('_', ' '))));
    return [h('label', null, 'Shown ', select), h('button', { type: 'button', class: 'unzoom', onclick: () => curve.zoom(clock.from, clock.to) }, 'Whole runs')];
  });
}

async function draw() {
  await Promise.all(sides.filter(({ series }) => series.choose([quantity])).map(({ series }) => series.update()));
  const have = sides.filter(({ series }) => series.times.length > 1 && series.columns.has(quantity));
  byId('curve').classList.toggle('nothing-yet', have.length === 0);
  if (have.length === 0) return;
  const colors = palette();
  const data = globalThis.uPlot.join(have.map(({ series }) => [series.times, series.columns.get(quantity)]));
  curve.show({ data, unit: quantity.endsWith('_deg') ? '°' : '', series: have.map(side => ({ name: side.name, color: colors[COLORS[sides.indexOf(side) % COLORS.length]] })) });
}
