// What a study's page shows of its cases: the plot first, of which the address keeps the choices; the map of regimes; the table.
import { h, replaceIfChanged } from './dom.js';
import { root } from './api.js';
import { regimeMap } from './regime_map.js';
import { caseTable, measuresIn, named } from './study_table.js';
import { studyPlot } from './study_plot.js';
import { showShared } from './study_sheet.js';

const jobPage = id => `${root}web/job.html?id=${encodeURIComponent(id)}`;
const NO = '–';
const ON_PAPER = 660; // CSS pixels of an A4 sheet

// {"contact/friction": "m"} of all inputs of a process.
function unitsOf(inputs) {
  const units = {};
  const walk = (schema, path) => {
    if (schema['x-unit']) units[path] = schema['x-unit'];
    for (const [name, member] of Object.entries(schema['x-unit'] ? {} : schema.properties ?? {})) walk(member, `${path}/${name}`);
    if (schema.items) walk(schema.items, `${path}/0`);
  };
  for (const [name, { schema }] of Object.entries(inputs)) walk(schema, name);
  return units;
}

export function createStudyView(data, description) {
  const { inputs, schemas } = description;
  const units = unitsOf(inputs);
  const choices = h('form', { class: 'plot-choices', onsubmit: event => event.preventDefault() }), drawn = h('div', { class: 'drawn' });
  const map = h('figure', { class: 'study-map', hidden: true });
  const plots = h('section', { class: 'study-plots', 'aria-label': 'Plot' }, choices, h('div', { class: 'study-drawings' }, drawn, map));
  const table = h('div', { id: 'cases', class: 'wide', tabindex: '0', role: 'group', 'aria-label': 'Table of cases' });
  const shared = h('section', { class: 'shared' });
  let study = null, isPaper = false, order = { head: null, falls: false, page: 0 };

  const known = () => data.cases.filter(Boolean);
  const chosen = () => new URLSearchParams(location.hash.split('&').slice(1).join('&'));
  function choose(name, value) {
    const query = chosen();
    if (value) query.set(name, value); else query.delete(name);
    history.replaceState(null, '', `#${encodeURIComponent(data.id)}${query.size ? `&${query}` : ''}`);
    draw();
  }

  function draw() {
    const cases = known(), query = chosen();
    const varied = named(cases, 'inputs').filter(name => cases.some(one => typeof one.inputs[name] === 'number'));
    const measures = measuresIn(cases, schemas).filter(([name]) => cases.some(one => one.results[name]));
    const x = varied.includes(query.get('x')) ? query.get('x') : varied.at(-1) === varied[0] ? varied[0] ?? '' : varied.find(name => name.endsWith('rotation_rate')) ?? varied[0] ?? '';
    const y = measures.find(([name]) => name === query.get('y')) ?? measures[0];
    const others = named(cases, 'inputs').filter(name => name !== x);
    const series = others.includes(query.get('by')) ? query.get('by') : query.get('by') === NO ? '' : others[0] ?? '';
    const log = query.get('log') === 'yes';
    showChoices(varied, measures, others, { x, y: y?.[0], series, log });
    if (!y) drawn.replaceChildren(h('p', { class: 'quiet' }, 'No case has a result yet.'));
    else drawn.replaceChildren(studyPlot(cases, data.runs(), { x, y: y[0], series, log, width: isPaper ? ON_PAPER : Math.max(300, Math.floor(drawn.clientWidth)),
      titles: { x: x ? `${x}${units[x] ? `, ${units[x]}` : ''}` : 'case', y: y[3] ? `${y[1]}, ${y[3]}` : y[1] }, references: y[0] === 'angle_deg',
      hrefOf: ({ one, index }) => hrefOf(one, index), hrefOfRun: run => jobPage(run.id) }));
    drawMap();
  }

  // The one run of a case, or its runs in the list.
  function hrefOf(one, index) {
    const own = data.runs().filter(run => run.study_case === index);
    return own.length === 1 ? jobPage(own[0].id) : `${root}?${new URLSearchParams({ study: data.id, 'label.case': one.case })}`;
  }

  function showChoices(varied, measures, others, { x, y, series, log }) {
    const select = (name, text, value, options) => {
      const element = h('select', { id: `plot-${name}`, onchange: event => choose(name, event.target.value) }, options.map(([key, words]) => h('option', { value: key }, words)));
      element.value = value;
      return [h('label', { for: `plot-${name}` }, text), element];
    };
    replaceIfChanged(choices, [varied, measures, others, x, y, series, log], () => [
      ...select('y', 'Result', y ?? '', measures.map(([name, heading]) => [name, heading])),
      ...select('x', 'against', x, varied.length ? varied.map(name => [name, name]) : [['', 'case']]),
      ...others.length ? select('by', 'series by', series || NO, [[NO, 'none'], ...others.map(name => [name, name])]) : [],
      h('label', null, h('input', { type: 'checkbox', checked: log, onchange: event => choose('log', event.target.checked ? 'yes' : '') }), ' logarithmic')]);
  }

  function drawMap() {
    const points = data.runs().filter(run => typeof run.omega2_inner === 'number' && typeof run.angle_deg === 'number')
      .map(run => ({ angle_deg: run.angle_deg, omega2: run.omega2_inner, name: `${run.regime ?? 'no regime'}${run.certain === 0 ? ', not certain' : ''}` }));
    map.hidden = points.length === 0;
    const kinds = [...new Set(points.map(({ name }) => name))];
    replaceIfChanged(map, points, () => points.length === 0 ? [] : [regimeMap(points),
      h('figcaption', null, `Runs on the paper’s map: ${kinds.map(kind => `${kind} ${points.filter(({ name }) => name === kind).length}`).join(', ')}`)]);
  }

  function showTable() {
    table.replaceChildren(...caseTable(known(), study.cases, schemas, { order, units, isWhole: isPaper, go: to => { order = to; showTable(); } }));
  }
  // On paper all rows, and the plot as wide as the sheet leaves it.
  const turn = to => () => {
    isPaper = to;
    if (study) { showTable(); draw(); }
  };
  addEventListener('beforeprint', turn(true));
  addEventListener('afterprint', turn(false));
  let width = 0;
  new ResizeObserver(() => {
    if (study && Math.abs(drawn.clientWidth - width) > 8) { width = drawn.clientWidth; draw(); }
  }).observe(drawn);
  return { plots, table, shared, show: now => {
    study = now;
    showTable();
    draw();
    showShared(shared, data.id, named(known(), 'inputs'), description).catch(() => {}); // the next poll tells what is wrong
  } };
}
