// What a row shows when it is opened: the answer and its plot, or the reason of the failure at once; links to
// everything the daemon holds of the job; all results.
import { h, replaceIfChanged } from './dom.js';
import { bytes, clock, count, significant } from './format.js';
import { ApiError, jobPath, json, root } from './api.js';
import { anglePlot } from './angle_plot.js';
import { viewOf } from './process_views.js';
import { warningsOf } from './results.js';
import { fileLink } from './file_link.js';
import { createSeries } from './sample_series.js';
import { schemasOf } from './words.js';

const SNAPSHOTS_SHOWN = 200;

// A panel that follows its job: update(job) on every poll while the row is open.
export function createDetail() {
  const parts = { reason: h('div'), about: h('div'), answer: h('div'), plot: h('div', { class: 'plot-box' }),
    results: h('div'), links: h('div') };
  const element = h('div', { class: 'panel' }, h('h2', { class: 'unseen' }, 'The job'),
    parts.reason, h('div', { class: 'first' }, parts.answer, parts.plot), parts.links, parts.results, parts.about);
  let series = null;
  let loading = false;
  let finalShown = null; // the state whose results and plot are on the page for good

  async function update(job) {
    showReason(parts.reason, job);
    showAbout(parts.about, job);
    showLinks(parts.links, job);
    if (loading || finalShown === job.status || job.status === 'accepted') return;
    loading = true;
    try {
      const results = job.status === 'successful' ? await json(`${jobPath(job.jobID)}/results`) : null;
      const hasSeries = viewOf(job.processID).series;
      series ??= createSeries(job.jobID, ['angle_deg']);
      if (hasSeries) await series.update();
      if (results) showResults(parts, results, await schemasOf(job.processID), job);
      if (hasSeries) showPlot(parts.plot, anglesOf(series), results, job.status);
      if (job.status !== 'running') finalShown = job.status;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      parts.plot.replaceChildren(h('p', { class: 'quiet' }, `Results not loaded: ${error.message}.`));
    } finally {
      loading = false;
    }
  }
  return { element, update };
}

const anglesOf = ({ times, columns }) => (columns.get('angle_deg') ?? []).map((angle, k) => ({ time: times[k], angle })).filter(({ angle }) => angle !== null);

function showReason(box, job) {
  const isOpen = job.status === 'accepted' || job.status === 'running';
  replaceIfChanged(box, [job.status, job.message], () => isOpen && job.message ? h('p', { class: 'quiet message' }, job.message)
    : job.status !== 'failed' ? null : h('div', { class: 'reason' }, h('h3', null, 'Why it failed'), h('p', null, job.message || 'No reason was given.')));
}

function showResults(parts, results, schemas, job) {
  const view = viewOf(job.processID);
  parts.answer.replaceChildren(...[warningsOf(results), view.answer(results, job.summary ?? {})].filter(Boolean));
  parts.results.replaceChildren(view.results(results, schemas));
}

function showPlot(box, points, results, status) {
  if (points.length < 2) {
    box.replaceChildren(h('p', { class: 'quiet' },
      status === 'running' ? 'No angle to draw yet.' : 'None of its samples has an angle to draw.'));
    return;
  }
  const width = Math.max(280, Math.floor(box.clientWidth));
  box.replaceChildren(anglePlot(points, results?.repose, width));
}

function showAbout(box, job) {
  const label = Object.entries(job.label ?? {});
  replaceIfChanged(box, [label, job.attempt, job.created], () => h('dl', { class: 'facts about' },
    [['id', job.jobID], ...label, ['attempt', count(job.attempt)], ['submitted', clock(job.created)]]
      .map(([name, value]) => h('div', null, h('dt', null, name), h('dd', null, String(value))))));
}

function showLinks(box, job) {
  const path = jobPath(job.jobID);
  const { series } = viewOf(job.processID);
  const fields = job.links?.find(link => link.rel === 'fields' && link.type !== 'application/json');
  replaceIfChanged(box, job.status, () => [
    h('ul', { class: 'links' },
      h('li', null, h('a', { href: `${root}web/job.html?id=${encodeURIComponent(job.jobID)}` }, 'Page of this job')),
      job.status === 'successful' ? h('li', null, fileLink(`${path}/results`, 'Results')) : null,
      job.studyID ? h('li', null, h('a', { href: `${root}web/studies.html#${job.studyID}` }, 'Study')) : null,
      h('li', null, fileLink(`${path}/spec`, 'Spec')),
      h('li', null, fileLink(`${path}/log`, 'Log')),
      series ? h('li', null, fileLink(`${path}/samples`, 'Samples (JSON)')) : null,
      series ? h('li', null, fileLink(`${path}/samples?format=csv`, 'Samples (CSV)')) : null,
      fields ? h('li', null, fileLink(`${path}/fields.hdf`, 'Fields (HDF5)')) : null),
    job.status === 'accepted' || !series ? null : snapshotList(path)]);
}

function snapshotList(path) {
  const list = h('div', null, h('p', { class: 'quiet' }, 'Loading…'));
  const load = async event => {
    if (!event.target.open) return;
    try {
      const { snapshots } = await json(`${path}/snapshots`);
      list.replaceChildren(...snapshotLinks(path, snapshots));
    } catch (error) {
      list.replaceChildren(h('p', { class: 'quiet' }, `Snapshots not loaded: ${error.message}.`));
    }
  };
  return h('details', { class: 'snapshots', ontoggle: load }, h('summary', null, 'Snapshots (HDF5, for ParaView)'), list);
}

function snapshotLinks(path, snapshots) {
  if (snapshots.length === 0) return [h('p', { class: 'quiet' }, 'None yet.')];
  const shown = snapshots.slice(-SNAPSHOTS_SHOWN);
  const left = snapshots.length - shown.length;
  return [
    left > 0 ? h('p', { class: 'quiet' }, `The last ${SNAPSHOTS_SHOWN} of ${count(snapshots.length)}.`) : null,
    h('ul', null, shown.map(({ href, time, bytes: size }) => h('li', null,
      fileLink(`${path}/snapshots/${href.split('/').pop()}`, href.split('/').pop()), ` at ${significant(time)} s, ${bytes(size)}`)))].filter(Boolean);
}
