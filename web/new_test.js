// The page of a new test: a form made of the description of a process, which says while one types what the test would take
// and what is wrong with it, and shows the request that it sends. Begins at ?process=, ?example= or ?from= a job.
import { byId, h, replaceIfChanged } from './dom.js';
import { ApiError, json, jobPath, request, root, session } from './api.js';
import { showConnected, showFailure, showTrouble, takeToken } from './connection.js';
import { bytes, count, duration } from './format.js';
import { fieldsOf, listsOf } from './form_fields.js';
import { createInput } from './form_input.js';
import { casesIn, documentOf, isStudy, requestOf, setAt, testsOf, valueAt } from './test_document.js';
import { outlineOf } from './outline.js';

const TYPING = 300;       // ms without a key before the daemon is asked
const TESTS_ASKED = 8;    // single tests of a study that the daemon is asked about
const AGAIN = 5_000;      // ms

let test = documentOf({}, 'drum');
let inputs = new Map(); // by pointer, what createInput made
let descriptions = new Map();
takeToken(begin);
begin();

// --- where it begins ---

async function begin() {
  try {
    const { processes } = await json(`${root}processes`);
    const { examples } = await json(`${root}examples`).catch(leaveOut({ examples: [] }));
    showBeginnings(processes, examples);
    await open(await startOf(new URLSearchParams(location.search), processes));
    showConnected();
  } catch (error) {
    showFailure(error, AGAIN, begin);
    if (error.status !== 401 && [0, 503].includes(error.status)) setTimeout(begin, AGAIN);
  }
}

const leaveOut = instead => error => {
  if (error.status === 404) return instead;
  throw error;
};

async function startOf(query, processes) {
  if (query.get('from')) {
    const { process, inputs: given, label } = await json(`${jobPath(query.get('from'))}/spec`);
    const own = Object.fromEntries(Object.entries(label ?? {}).filter(([name]) => !['study', 'case', 'parent'].includes(name)));
    return documentOf({ process, inputs: given, label: own });
  }
  if (query.get('example')) return documentOf(await json(`${root}examples/${encodeURIComponent(query.get('example'))}`), 'drum');
  const named = processes.find(({ id }) => id === query.get('process'));
  return documentOf({}, (named ?? processes[0]).id);
}

function showBeginnings(processes, examples) {
  replaceIfChanged(byId('beginnings'), [processes, examples], () => [
    h('label', { for: 'process' }, 'Test'),
    h('select', { id: 'process', onchange: event => go(`process=${event.target.value}`) },
      processes.map(({ id, title }) => h('option', { value: id }, title ?? id))),
    examples.length ? h('label', { for: 'example' }, 'Start from') : null,
    examples.length ? h('select', { id: 'example', onchange: event => event.target.value && go(`example=${encodeURIComponent(event.target.value)}`) },
      h('option', { value: '' }, 'an example, or a case of the paper …'),
      ['test', 'study'].map(kind => h('optgroup', { label: kind === 'test' ? 'Single tests' : 'Studies' },
        examples.filter(one => one.kind === kind).map(({ name, title }) => h('option', { value: name }, title)))))
      : null]);
}

async function go(query) {
  history.pushState(null, '', `?${query}`);
  await begin();
}
window.addEventListener('popstate', begin);

async function open(document_) {
  if (!descriptions.has(document_.process))
    descriptions.set(document_.process, await json(`${root}processes/${encodeURIComponent(document_.process)}`));
  test = document_;
  byId('process').value = test.process;
  if (byId('example')) byId('example').value = new URLSearchParams(location.search).get('example') ?? '';
  build();
  changed();
}

// --- the form ---

function build() {
  const description = descriptions.get(test.process);
  const fields = fieldsOf(description, test.inputs).map(field => createInput(field, take));
  inputs = new Map(fields.map(input => [input.field.pointer, input]));
  for (const input of fields) input.show(test.varied.get(input.field.pointer) ?? valueAt(test.inputs, input.field.pointer));
  const usual = fields.filter(({ field }) => field.order > 0 && !(field.entry > 0)).sort((a, b) => a.field.order - b.field.order);
  byId('usual').replaceChildren(...usual.map(({ element }) => element));
  byId('others').replaceChildren(...groupsOf(fields.filter(input => !usual.includes(input)), description));
  byId('about').textContent = description.description;
  buildLabel();
}

function groupsOf(fields, description) {
  const names = new Map();
  for (const input of fields) {
    const [first, ...below] = input.field.names;
    const name = below.length ? first : 'all else';
    names.set(name, [...names.get(name) ?? [], input]);
  }
  const lists = new Map(listsOf(description).map(list => [list.name, list]));
  const ordered = [...names].sort(([a], [b]) => (a === 'all else') - (b === 'all else'));
  return ordered.map(([name, members]) => h('details', { class: 'group', open: members.some(isGiven) },
    h('summary', null, name.replaceAll('_', ' '), h('small', null, givenOf(members))),
    description.inputs[name] ? h('p', { class: 'help' }, description.inputs[name].description) : null,
    h('div', { class: 'fields' }, members.map(({ element }) => element)), lists.has(name) ? entryButtons(lists.get(name)) : null));
}

const isGiven = ({ field }) => valueAt(test.inputs, field.pointer) !== undefined;
const givenOf = members => members.some(isGiven) ? ` ${count(members.filter(isGiven).length)} given` : '';

// Another kind of particles, or one less.
function entryButtons({ name, most }) {
  const entries = test.inputs[name]?.length ?? 1;
  const change = to => () => {
    test.inputs[name] = Array.from({ length: to }, (_, i) => test.inputs[name]?.[i] ?? {});
    build();
    changed();
  };
  return h('p', { class: 'choices-left' },
    entries < most ? h('button', { type: 'button', onclick: change(entries + 1) }, 'Add another kind') : null,
    entries > 1 ? h('button', { type: 'button', onclick: change(entries - 1) }, 'Take the last away') : null);
}

function take({ pointer }, value) {
  const several = Array.isArray(value) && inputs.get(pointer).field.kind === 'number';
  const [, list, entry] = /^\/([^/]+)\/(\d+)\//.exec(pointer) ?? [];
  if (list && !Array.isArray(test.inputs[list])) test.inputs[list] = [];
  while (list && test.inputs[list].length <= Number(entry)) test.inputs[list].push({});
  if (several) test.varied.set(pointer, value); else test.varied.delete(pointer);
  setAt(test.inputs, pointer, several ? value[0] : value);
  changed();
}

function buildLabel() {
  const pairs = Object.entries(test.label).filter(([, value]) => typeof value !== 'object');
  if (pairs.length === 0) pairs.push(['project', '']);
  byId('label').replaceChildren(...pairs.map(([name, value]) => h('div', { class: 'field' }, h('label', { for: `label-${name}` }, name),
    h('div', { class: 'control' }, h('input', { id: `label-${name}`, type: 'text', value: String(value), maxlength: 200,
      oninput: event => { test.label[name] = event.target.value; changed(); } })))));
  byId('name').value = test.name;
  byId('repeats').value = test.repeats;
}
byId('name').addEventListener('input', event => { test.name = event.target.value; changed(); });
byId('repeats').addEventListener('input', event => {
  const repeats = Number(event.target.value);
  test.repeats = Number.isInteger(repeats) && repeats > 0 ? repeats : 1;
  changed();
});

// --- what follows from it ---

let timer = 0;
function changed() {
  showRequest();
  const study = isStudy(test);
  byId('study-name').hidden = !study;
  byId('submit').textContent = study ? `Submit ${count(casesIn(test) * test.repeats)} tests` : 'Submit';
  replaceIfChanged(byId('cases'), test.cases, () => test.cases ? [
    `${count(test.cases.length)} cases of the study, which differ from what stands here: `,
    test.cases.slice(0, 12).map(one => one.name ?? JSON.stringify(one.inputs)).join('; '), test.cases.length > 12 ? ' … ' : '. ',
    h('button', { type: 'button', onclick: () => { test.cases = null; changed(); } }, 'Leave the cases out')] : []);
  replaceIfChanged(byId('outline'), [test.process, test.inputs], () => outlineOf(test.process, test.inputs));
  clearTimeout(timer);
  timer = setTimeout(check, TYPING);
}

function showRequest() {
  const { path, body } = requestOf(test);
  const bearer = session.isAsked() ? ' -H "Authorization: Bearer $(cat TOKEN_FILE)"' : '';
  byId('json').textContent = JSON.stringify(body, null, 1);
  byId('curl').textContent = `curl${bearer} ${location.origin}${root}${path} \\\n  --json '${JSON.stringify(body).replaceAll("'", "'\\''")}'`;
}
byId('copy').addEventListener('click', async () => {
  try {
    await navigator.clipboard.writeText(byId('curl').textContent);
    byId('announcements').textContent = 'The curl is in the clipboard.';
  } catch {
    getSelection().selectAllChildren(byId('curl'));
  }
});

// The daemon is asked what it would say of the test, or of some tests of the study, and does nothing.
let turn = 0;
async function check() {
  const mine = ++turn, asked = testsOf(test, TESTS_ASKED), answers = [];
  try {
    for (const one of asked) {
      answers.push(await dryRun(one));
      if (mine !== turn) return;
    }
    showConnected();
    showProblems(answers.flatMap(({ problems }) => problems));
    showEstimate(answers.map(({ estimate }) => estimate).filter(Boolean), answers.flatMap(({ warnings }) => warnings));
  } catch (error) {
    if (mine !== turn) return;
    showFailure(error, AGAIN, check);
    if (error.status === 0) timer = setTimeout(check, AGAIN);
  }
}

async function dryRun({ process, inputs: given }) {
  try {
    const { estimate, warnings = [] } = await json(`${root}processes/${process}/execution?check=true`, { method: 'POST', body: JSON.stringify({ inputs: given }) });
    return { estimate, warnings, problems: [] };
  } catch (error) {
    if (!(error instanceof ApiError) || ![400, 403, 422].includes(error.status) || !error.problem) throw error;
    return { warnings: [], problems: error.problem.errors ?? [] };
  }
}

// "/base/inputs/drum/length", "/vary/~1inputs~1drum~1length/2" and "/cases/3/inputs/drum/length" are all of one field.
const placeOf = pointer => pointer.replace(/^\/vary\/~1inputs((?:~1[^/]*)).*$/, (_, place) => `/inputs${place.replaceAll('~1', '/')}`)
  .replace(/^\/(base|cases\/\d+)(?=\/)/, '').replace(/^\/inputs/, '');

function fieldAt(place) {
  const all = [...inputs.values()];
  return inputs.get(place) ?? all.find(({ field }) => field.pointer.startsWith(`${place}/`) && place !== '') ?? all.find(({ field }) => place.startsWith(`${field.pointer}/`));
}

function showProblems(problems) {
  const told = new Map(), others = new Set();
  for (const { pointer, detail } of problems) {
    const at = fieldAt(placeOf(pointer ?? ''));
    if (!at) others.add(detail);
    else told.set(at, new Set([...told.get(at) ?? [], detail]));
  }
  for (const input of inputs.values()) {
    const text = [...told.get(input) ?? []].map(capital).join(' ');
    input.complain(text);
    if (text) input.element.closest('details')?.setAttribute('open', '');
  }
  const all = told.size + others.size;
  byId('submit').disabled = all > 0;
  replaceIfChanged(byId('problems'), [all, [...others]], () => all === 0 ? [h('p', { class: 'fine' }, 'Nothing is wrong with it.')] : [
    h('p', { class: 'why' }, all === 1 ? 'One thing is to be mended' : `${count(all)} things are to be mended`, told.size ? ': see the marked fields.' : '.'),
    [...others].map(text => h('p', { class: 'why' }, capital(text)))]);
}

const capital = text => `${text.charAt(0).toUpperCase()}${text.slice(1)}${/[.!?]$/.test(text) ? '' : '.'}`;

// Of several tests: from the least to the most; the time of all from the mean of those asked about.
function showEstimate(estimates, warnings) {
  const range = (name, write) => {
    const values = estimates.map(one => one[name]).filter(value => typeof value === 'number');
    const [low, high] = [Math.min(...values), Math.max(...values)];
    return values.length === 0 ? null : write(low) === write(high) ? write(low) : `${write(low)} to ${write(high)}`;
  };
  const tests = casesIn(test) * test.repeats;
  const whole = estimates.reduce((sum, one) => sum + (one.wall_seconds ?? NaN), 0) / estimates.length * tests;
  const rows = [['particles', range('particles', count)], ['steps', range('steps', count)], ['simulated time', range('simulated_seconds', duration)],
    ['memory', range('memory_bytes', bytes)], ['snapshots', range('snapshot_bytes', bytes)],
    [tests > 1 ? 'time of each' : 'time on this machine', range('wall_seconds', duration)],
    tests > 1 ? [`processor time of all ${count(tests)}`, `about ${duration(whole)}`] : null].filter(row => row?.[1]);
  replaceIfChanged(byId('estimate'), [rows, warnings], () => [
    h('dl', { class: 'facts' }, rows.map(([name, value]) => h('div', null, h('dt', null, name), h('dd', null, value)))),
    [...new Set(warnings.map(warning => warning.text ?? warning.detail ?? String(warning)))].slice(0, 6).map(text => h('p', { class: 'news' }, capital(text)))]);
}

byId('form').addEventListener('submit', async event => {
  event.preventDefault();
  const { path, body } = requestOf(test);
  byId('submit').disabled = true;
  try {
    const made = await (await request(`${root}${path}`, { method: 'POST', body: JSON.stringify(body) })).json();
    location.assign(isStudy(test) ? `${root}web/studies.html#${made.studyID}` : `${root}web/job.html?id=${made.jobID}`);
  } catch (error) {
    byId('submit').disabled = false;
    if (error.problem?.errors) showProblems(error.problem.errors);
    else showTrouble(`It was not submitted: ${error.message}.`);
  }
});
