// One job at an address of its own: ?id=ID, and after the # the moment and the colours that are looked at. Left the bed, right what
// was measured over time, one clock for both; below everything that is known of the job.
import { byId, h, replaceIfChanged } from './dom.js';
import { dismissJob, jobPath, json, root } from './api.js';
import { confirmed, isOfAddress, showConnected, showFailure, showTrouble, takeToken } from './connection.js';
import { createBedPanel } from './bed_panel.js';
import { createClock, transport } from './clock.js';
import { createCurve } from './curve.js';
import { nameOf } from './job_name.js';
import { columnsShown, showCurve, showCurveTools } from './job_curve.js';
import { showAgain, showAnswers, showFiles, showHead, showInputs, showLog, showReason, showResults } from './job_parts.js';
import { prepareForPaper } from './job_print.js';
import { SETTLED, startPolling } from './polling.js';
import { viewOf } from './process_views.js';
import { createSeries } from './sample_series.js';
import { describedInputs, schemasOf } from './words.js';

const id = new URLSearchParams(location.search).get('id') ?? '';
const looked = new URLSearchParams(location.hash.slice(1));
const view = { job: null, spec: null, results: null, schemas: {}, described: {}, series: createSeries(id, ['angle_deg', 'tube_height']), bed: null, curve: null, shown: '', choice: { quantity: '', extra: new Set(looked.get('also')?.split(',') ?? []) } };
const clock = createClock({ ready: () => view.bed?.isReady() ?? true });
let finalShown = null; // the state whose samples, frames and results are on the page for good

const refresh = startPolling(ask, (error, pause) => {
  showFailure(error, pause, refresh);
  if (isOfAddress(error)) byId('sheet').hidden = true;
}, change => change.jobID === id);
takeToken(refresh);

async function ask() {
  if (!id) {
    showTrouble('The address names no job: it ends in ?id=ID.', null, root);
    return false;
  }
  const job = await json(jobPath(id));
  const before = view.job;
  view.job = job;
  if (!view.spec) await begin(job);
  showConnected();
  byId('sheet').hidden = false;
  document.title = `${nameOf(job)} · reposed`;
  showHead(byId('head'), job, { stop, again: `${root}web/new.html?from=${encodeURIComponent(id)}` });
  showReason(byId('reason'), job);
  showFiles(byId('files'), job, view.bed?.store.list ?? []);
  if (before && before.status !== job.status) byId('announcements').textContent = `${nameOf(job)}: ${job.status}`;
  const isOpen = job.status === 'accepted' || job.status === 'running';
  if (finalShown !== job.status && job.status !== 'accepted') {
    await showCourse(job);
    showFiles(byId('files'), job, view.bed?.store.list ?? []);
    if (!isOpen) finalShown = job.status;
  }
  return isOpen || SETTLED;
}

// What does not change while the job is there.
async function begin(job) {
  const [spec, described, schemas] = await Promise.all([json(`${jobPath(id)}/spec`), describedInputs(job.processID), schemasOf(job.processID)]);
  Object.assign(view, { spec, described, schemas });
  showInputs(byId('inputs'), byId('inputs-body'), spec, described);
  showAgain(byId('again'), job, spec, described);
  showLog(byId('log'), job);
  if (!viewOf(job.processID).series) {
    byId('stage').hidden = true;
    return;
  }
  view.bed = createBedPanel(job, { process: job.processID, inputs: spec.inputs }, clock, {
    angleAt: time => view.series.at('angle_deg', time), liftAt: time => view.series.at('tube_height', time) ?? 0,
    chosen: { colorBy: looked.get('colour') ?? undefined }, told: ({ colorBy }) => remember('colour', colorBy),
  });
  byId('bed').append(view.bed.element);
  byId('transport').append(transport(clock));
  view.curve = createCurve(byId('curve'), clock, () => factsOf(view), { width: 386, height: 250 });
  clock.listen(() => rememberSoon());
  prepareForPaper(view);
}

// Of the results what the curve shows of them.
function factsOf({ results, choice }) {
  const repose = results?.repose;
  if (!repose || (choice.quantity && choice.quantity !== 'angle')) return { window: repose?.window };
  return { window: repose.window, mean: repose.window ? repose.angle_deg : undefined, error: repose.standard_error_deg, events: repose.slumps?.events ?? [] };
}

async function showCourse(job) {
  if (job.status === 'successful' && !view.results) {
    view.results = await json(`${jobPath(id)}/results`);
    showAnswers(byId('answer-row'), byId('profiles'), view.results, view.schemas, job);
    showResults(byId('results'), byId('results-body'), view.results, view.schemas);
  }
  if (!view.bed) return;
  await Promise.all([view.series.update(), view.bed.update()]);
  if (view.series.choose(columnsShown(view).map(({ key }) => key))) await view.series.update();
  const { times } = view.series, stops = view.bed.store.list.map(frame => frame.time), isFirst = clock.to === 0;
  byId('stage').classList.toggle('bare', times.length < 2 && stops.length === 0);
  clock.extend(Math.min(times[0] ?? 0, stops[0] ?? 0), Math.max(times.at(-1) ?? 0, stops.at(-1) ?? 0), stops);
  if (isFirst) clock.set(looked.has('t') ? Number(looked.get('t')) || 0 : clock.to);
  showCurveTools(byId('curve-tools'), view, chooseCurve);
  showCurve(byId('curve'), view);
}

function chooseCurve() {
  remember('also', [...view.choice.extra].join(','));
  showCurve(byId('curve'), view);
  finalShown = null; // columns that were not drawn before are still to come
  refresh();
}

function remember(name, value) {
  if (value) looked.set(name, value); else looked.delete(name);
  history.replaceState(null, '', `${location.pathname}${location.search}#${looked}`);
}

let due = 0;
function rememberSoon() {
  clearTimeout(due);
  due = setTimeout(() => { if (!clock.isGoing && clock.to > 0) remember('t', clock.time >= clock.to ? '' : clock.time.toPrecision(5)); }, 400);
}

async function stop() {
  if (!await confirmed(nameOf(view.job))) return;
  try {
    await dismissJob(id);
  } catch (error) {
    showTrouble(`${nameOf(view.job)} was not cancelled: ${error.message}.`);
  }
  refresh();
}
