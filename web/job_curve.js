// Which of what was measured the curve of a job shows, and the choice of it.
import { h, replaceIfChanged } from './dom.js';

const MARKS = [['transient', 'before and after the measuring window'], ['band', 'mean ± 2 standard errors'], ['slump', 'slump or avalanche, by the centre of mass']];

const isOfAngles = (angles, { quantity }) => angles.length > 0 && (quantity || 'angle') === 'angle';

// [{key, name, place}] of the columns that are drawn.
export function columnsShown({ series, choice }) {
  const angles = series.definitions(), others = series.others();
  return isOfAngles(angles, choice) ? angles.map((one, place) => ({ ...one, place })).filter(({ key, place }) => place === 0 || choice.extra.has(key))
    : others.filter(({ key }) => key === (choice.quantity || others[0]?.key));
}

export function showCurve(box, view) {
  const { series, choice, curve } = view, wanted = columnsShown(view).filter(({ key }) => series.columns.has(key));
  if (series.times.length < 2 || wanted.length === 0) {
    box.classList.add('nothing-yet');
    return;
  }
  box.classList.remove('nothing-yet');
  curve.show({ data: [series.times, ...wanted.map(({ key }) => series.columns.get(key))], of: series.of,
    series: wanted.map(({ name, place }) => ({ name, place })), unit: isOfAngles(series.definitions(), choice) ? '°' : '' });
}

export function showCurveTools(box, view, changed) {
  const { series, choice, results } = view, angles = series.definitions(), others = series.others();
  const events = results?.repose?.slumps?.events ?? [];
  replaceIfChanged(box, [angles, others, choice.quantity, events.length, Boolean(results)], () => {
    const quantity = h('select', { class: 'quantity', 'aria-label': 'What is drawn', onchange: () => {
      choice.quantity = quantity.value;
      box.dataset.shown = '';
      showCurveTools(box, view, changed);
      changed();
    } }, angles.length ? h('option', { value: 'angle' }, 'angle') : null, others.map(({ key, name }) => h('option', { value: key, selected: key === choice.quantity }, name)));
    const isAngle = isOfAngles(angles, choice);
    const toggle = ({ key, name }, k) => h('label', { class: `series s${k + 1}` }, h('input', { type: 'checkbox', value: key, checked: choice.extra.has(key), onchange: event => {
      if (event.target.checked) choice.extra.add(key); else choice.extra.delete(key);
      changed();
    } }), name);
    return [h('label', null, 'Shown ', quantity),
      isAngle && angles.length > 1 ? h('fieldset', { class: 'definitions' }, h('legend', { class: 'unseen' }, 'Other definitions'), angles.slice(1).map(toggle)) : null,
      h('button', { type: 'button', class: 'unzoom', onclick: () => { const { times } = series; view.curve.zoom(times[0], times.at(-1)); } }, 'Whole run'),
      results?.repose?.window && isAngle ? h('p', { class: 'marks' }, MARKS.filter(([name]) => name !== 'slump' || events.length).map(([name, words]) => h('span', { class: name }, words))) : null];
  });
}
