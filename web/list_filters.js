// What narrows the list and orders it: a panel that opens, and what is set as words that can be taken away one by one.
import { h } from './dom.js';
import { headingOf } from './columns.js';

// processes: [{id, title}]; columns: of columns.js; go(change).
export function filterPanel(view, processes, columns, go) {
  const numbers = columns.filter(column => column.isNumber && !column.isFact || column.name === 'estimated_seconds');
  const regimes = columns.find(({ name }) => name === 'regime')?.choices ?? [];
  const first = { cursor: '', at: 0 };
  const select = (id, value, options, change) => {
    const element = h('select', { id, onchange: event => change(event.target.value) }, options.map(([key, text]) => h('option', { value: key }, text)));
    element.value = value;
    return element;
  };
  const values = (name, range) => {
    const map = new Map(view.values);
    if (range) map.set(name, range); else map.delete(name);
    return map;
  };
  const descending = view.sort.startsWith('-') || view.sort === '', sorted = view.sort.replace(/^-/, '') || 'created';
  return [
    pair('f-process', 'Test', select('f-process', view.processID, [['', 'any'], ...processes.map(({ id, title }) => [id, title ?? id])], processID => go({ processID, ...first }))),
    pair('f-regime', 'Regime', select('f-regime', view.values.get('regime') ?? '', [['', 'any'], ...regimes.map(name => [name, name])], name => go({ values: values('regime', name), ...first }))),
    pair('f-date', 'Submitted until', h('input', { id: 'f-date', type: 'date', value: view.datetime.replace('../', ''),
      onchange: event => go({ datetime: event.target.value ? `../${event.target.value}` : '', ...first }) })),
    h('form', { class: 'filter-pair', onsubmit: event => {
      event.preventDefault();
      const [name, value] = ['f-label', 'f-label-value'].map(id => event.target.querySelector(`#${id}`).value.trim());
      go({ labels: name ? new Map([[name, value]]) : new Map(), ...first });
    } }, h('label', { for: 'f-label' }, 'Label'), h('input', { id: 'f-label', placeholder: 'project', size: 9, value: [...view.labels.keys()][0] ?? '' }),
    h('input', { id: 'f-label-value', 'aria-label': 'value of the label', placeholder: 'value', size: 10, value: [...view.labels.values()][0] ?? '' }), h('button', null, 'Apply')),
    h('form', { class: 'filter-pair', onsubmit: event => {
      event.preventDefault();
      const [name, low, high] = ['f-column', 'f-low', 'f-high'].map(id => event.target.querySelector(`#${id}`).value.trim());
      if (low || high) go({ values: values(name, `${low}..${high}`), ...first });
    } }, h('label', { for: 'f-column' }, 'Value'), h('select', { id: 'f-column' }, numbers.map(({ name, title, unit }) => h('option', { value: name }, unit ? `${title}, ${unit}` : title))),
    h('input', { id: 'f-low', 'aria-label': 'least value', placeholder: 'from', inputmode: 'decimal', size: 6 }),
    h('input', { id: 'f-high', 'aria-label': 'largest value', placeholder: 'to', inputmode: 'decimal', size: 6 }), h('button', null, 'Apply')),
    pair('f-sort', 'Sort by', select('f-sort', sorted, columns.map(({ name, title }) => [name, title]), name => go({ sort: name === 'created' ? '' : `-${name}`, ...first })),
      h('button', { type: 'button', onclick: () => go({ sort: descending ? sorted : sorted === 'created' ? '' : `-${sorted}`, ...first }) }, descending ? 'largest first' : 'smallest first')),
    h('fieldset', { class: 'columns' }, h('legend', null, 'More columns'), columns.filter(({ name }) => name !== 'regime' && name !== 'created').map(column =>
      h('label', null, h('input', { type: 'checkbox', checked: view.columns.includes(column.name), onchange: event =>
        go({ columns: event.target.checked ? [...view.columns, column.name] : view.columns.filter(name => name !== column.name) }, { step: false }) }), ` ${headingOf(column)}`))),
  ];
}

const pair = (id, text, ...controls) => h('div', { class: 'filter-pair' }, h('label', { for: id }, text), controls);

// [what is set, without it] of each.
export function chipsOf(view, columns, go) {
  const titleOf = name => columns.find(column => column.name === name)?.title ?? name;
  const without = (map, name) => new Map([...map].filter(([key]) => key !== name));
  const set = [
    view.processID && [view.processID, { processID: '' }],
    view.datetime && [`submitted until ${view.datetime.replace('../', '')}`, { datetime: '' }],
    ...[...view.labels].map(([name, value]) => [`${name}: ${value}`, { labels: without(view.labels, name) }]),
    ...[...view.values].map(([name, range]) => [`${titleOf(name)}: ${range.replace('..', ' to ').trim()}`, { values: without(view.values, name) }]),
    view.sort && [`sorted by ${titleOf(view.sort.replace(/^-/, ''))}`, { sort: '' }],
  ].filter(Boolean);
  return set.map(([text, change]) => h('span', { class: 'chip' }, h('bdi', null, text),
    h('button', { type: 'button', 'aria-label': `Without ${text}`, onclick: () => go({ ...change, cursor: '', at: 0 }) }, '×')));
}
