// The parts of a job's page that are words and tables.
import { h, replaceIfChanged } from './dom.js';
import { ApiError, jobPath, request, root, session } from './api.js';
import { bytes, clock, count, duration, regimeInWords, secondsBetween, significant } from './format.js';
import { fileLink } from './file_link.js';
import { heatMaps } from './heat_maps.js';
import { inputTables, shortInputs } from './input_table.js';
import { nameOf } from './job_name.js';
import { profilePlot, profilesIn } from './profile_plot.js';
import { regimeMap } from './regime_map.js';
import { resultTables } from './result_table.js';
import { stageTable, warningsOf } from './results.js';
import { viewOf } from './process_views.js';

const SNAPSHOTS_SHOWN = 200;
const LOG_SHOWN = 200_000; // characters, the last ones

export function showHead(box, job, { stop, again }) {
  const isOpen = job.status === 'accepted' || job.status === 'running';
  const end = job.finished ?? (job.status === 'running' ? new Date().toISOString() : null), took = secondsBetween(job.started, end);
  const fact = (name, value, title) => value ? h('div', null, h('dt', null, name), h('dd', { title }, value)) : null;
  replaceIfChanged(box, [job.status, job.progress, job.message, job.attempt, job.label, job.eta_seconds, job.position, job.expected_start, Math.floor(took ?? -1)], () => [
    h('div', { class: 'job-title' }, h('h1', null, h('bdi', null, nameOf(job))), h('span', { class: `badge ${job.status}` }, job.status),
      job.status === 'running' ? h('progress', { max: 100, value: job.progress ?? 0, 'aria-label': 'progress' }) : null,
      job.status === 'running' ? h('small', null, `${Math.floor(job.progress ?? 0)} %${typeof job.eta_seconds === 'number' ? ` · ${duration(job.eta_seconds)} left` : ''}`) : null,
      h('span', { class: 'job-actions' },
        isOpen ? h('button', { type: 'button', class: 'stop', onclick: stop }, 'Cancel') : null,
        h('button', { type: 'button', class: 'print', onclick: () => globalThis.print() }, 'Print'),
        h('a', { class: 'button', href: again }, 'Change and run again'))),
    h('dl', { class: 'job-facts' }, fact('test', job.processID), fact('id', job.jobID), fact('submitted', clock(job.created), job.created), job.started ? fact('started', clock(job.started), job.started) : null,
      took === null ? null : fact(job.finished ? 'took' : 'running for', duration(took)), job.attempt > 1 ? fact('attempt', count(job.attempt)) : null,
      job.position ? fact('in line', `${count(job.position)}.${job.expected_start ? `, expected to start ${clock(job.expected_start)}` : ''}`) : null,
      job.studyID ? h('div', null, h('dt', null, 'study'), h('dd', null, h('a', { href: `${root}web/studies.html#${job.studyID}` }, job.studyID))) : null,
      Object.entries(job.label ?? {}).map(([name, value]) => h('div', { class: 'label' }, h('dt', null, h('bdi', null, name)), h('dd', null, h('bdi', null, String(value))))))]);
}

export function showReason(box, job) {
  const isOpen = job.status === 'accepted' || job.status === 'running';
  replaceIfChanged(box, [job.status, job.message], () => isOpen && job.message ? h('p', { class: 'quiet message' }, job.message)
    : job.status !== 'failed' ? null : h('div', { class: 'reason' }, h('h2', null, 'Why it failed'), h('p', null, job.message || 'No reason was given.')));
}

// The answer, the regime with its place on the paper's map, and what is a profile.
export function showAnswers(box, profiles, results, schemas, job) {
  const { repose, regime } = results;
  const omega2 = regime?.omega2_inner, hasPlace = typeof omega2 === 'number' && typeof repose?.angle_deg === 'number';
  const words = regime?.name ? [h('p', { class: 'regime-name' }, h('strong', null, regimeInWords(regime.name, regime.certain)),
    h('span', { class: 'quiet' }, [typeof omega2 === 'number' ? `Ω² ${significant(omega2)} inside` : '', typeof regime.omega2_outer === 'number' ? `${significant(regime.omega2_outer)} at the wall` : ''].filter(Boolean).join(', ')),
    regime.reason ? h('span', null, regime.reason) : null)] : [];
  box.replaceChildren(h('section', { class: 'card' }, h('h2', null, 'Answer'), viewOf(job.processID).answer(results, job.summary ?? {}), warningsOf(results)),
    words.length ? h('section', { class: 'card regime-card' }, h('h2', null, 'Regime'), ...words,
      hasPlace ? regimeMap([{ angle_deg: repose.angle_deg, omega2, name: 'this run' }]) : '') : '', ...interfaceCards(results));
  if (results.stages?.length) profiles.append(h('div', { class: 'card' }, stageTable(results.stages)));
  profiles.after(heatMaps(job) ?? '');
}

function interfaceCards(results) {
  const found = Object.entries(results).flatMap(([output, object]) => object && typeof object === 'object' ? Object.entries(object)
    .flatMap(([name, member]) => profilesIn(member).map(profile => ({ title: name === 'profile' ? `${output}: ${profile.up.replaceAll('_', ' ')}` : `mean ${name}`, profile }))) : []);
  return found.map(({ title, profile }) => [title, profilePlot(profile, `${title}: ${profile.up} against ${profile.across}`)]).filter(([, plot]) => plot)
    .map(([title, plot]) => h('section', { class: 'card' }, h('h2', null, title.charAt(0).toUpperCase() + title.slice(1)), plot,
      h('p', { class: 'quiet' }, 'Band: two standard errors.')));
}

export function showResults(section, box, results, schemas) {
  section.hidden = false;
  box.replaceChildren(resultTables(results, schemas));
}

export function showInputs(section, box, spec, described) {
  section.hidden = false;
  box.replaceChildren(inputTables(spec.inputs, described));
}

export function showFiles(box, job, frames) {
  const path = jobPath(job.jobID), { series } = viewOf(job.processID);
  const links = [job.status === 'successful' ? ['results', 'Results (JSON)'] : null, ['spec', 'Spec (JSON)'], ['log', 'Log'],
    series ? ['samples', 'Samples (JSON)'] : null, series ? ['samples?format=csv', 'Samples (CSV)'] : null,
    ...['fields', 'picture', 'frames', 'walls', 'series', 'tracers', 'archive'].map(rel => job.links?.some(link => link.rel === rel) ? LINKED[rel] : null)].filter(Boolean);
  replaceIfChanged(box, [job.status, frames.length], () => [
    h('ul', { class: 'links' }, links.map(([name, words]) => h('li', null, fileLink(`${path}/${name}`, words)))),
    frames.length ? h('details', { class: 'snapshots' }, h('summary', null, `Snapshots (HDF5, for ParaView): ${count(frames.length)}`),
      frames.length > SNAPSHOTS_SHOWN ? h('p', { class: 'quiet' }, `The last ${SNAPSHOTS_SHOWN}.`) : null,
      h('ul', null, frames.slice(-SNAPSHOTS_SHOWN).map(({ name, time, size }) => h('li', null, fileLink(`${path}/snapshots/${name}.hdf`, `${name}.hdf`), ` at ${significant(time)} s, ${bytes(size)}`)))) : null]);
}

const LINKED = { fields: ['fields.hdf', 'Fields (HDF5)'], picture: ['picture.png', 'Picture (PNG)'], frames: ['frames.bin', 'Frames of the bed (api/FRAMES.md)'], walls: ['walls.vtp', 'Walls (VTK)'], series: ['snapshots.hdf.series', 'Series for ParaView'], tracers: ['tracers.csv', 'Paths of tracers (CSV)'], archive: ['files.tar', 'All files (tar)'] };

// As a word of a shell.
const quoted = text => `'${text.replaceAll("'", "'\\''")}'`;

export function curlOf(job, spec, described) {
  const body = { inputs: shortInputs(spec.inputs, described), ...(Object.keys(spec.label ?? {}).length ? { label: spec.label } : {}) };
  const bearer = session.isAsked() ? ' -H "Authorization: Bearer $(cat TOKEN_FILE)"' : '';
  return `curl${bearer} ${location.origin}${root}processes/${job.processID}/execution \\\n  --json ${quoted(JSON.stringify(body))}`;
}

export function showAgain(box, job, spec, described) {
  const text = curlOf(job, spec, described), told = h('span', { role: 'status', class: 'quiet' });
  const copy = async () => {
    try {
      await navigator.clipboard.writeText(text);
      told.textContent = 'copied';
    } catch {
      getSelection().selectAllChildren(code);
      told.textContent = 'selected: copy it with Ctrl+C';
    }
  };
  const code = h('code', null, text);
  box.replaceChildren(h('p', null, 'The curl that makes this job: what is left out is the default.'), h('pre', { tabindex: '0', class: 'curl' }, code),
    h('p', { class: 'copying' }, h('button', { type: 'button', class: 'copy', onclick: copy }, 'Copy'), told));
}

export function showLog(box, job) {
  const text = h('pre', { tabindex: '0' });
  const load = async event => {
    if (!event.target.open) return;
    try {
      const log = await (await request(`${jobPath(job.jobID)}/log`, { accept: 'text/plain' })).text();
      text.textContent = log.slice(-LOG_SHOWN) || 'It is empty.';
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      text.textContent = `Not loaded: ${error.message}.`;
    }
  };
  box.replaceChildren(h('details', { ontoggle: load }, h('summary', null, 'What the worker said'), text));
}
