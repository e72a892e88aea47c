// One field of a form: its control, its unit, what its number is in SI, and what is wrong with it.
import { h } from './dom.js';
import { significant } from './format.js';

const spoken = names => names.map(name => name.replaceAll('_', ' ').replace(/ deg$/, '')).join(', ');

// 15 digits: what was typed and nothing of how it was converted.
const rounded = value => Number(value.toPrecision(15));
const written = value => String(Number(value.toPrecision(12)));

// "0.1", "0.1 0.2; 0.5", "0.1 to 0.5 in 5": [number]; null: not numbers.
export function numbersIn(text) {
  const range = /^(\S+)\s+to\s+(\S+)\s+in\s+(\d{1,4})$/.exec(text.trim());
  const words = range ? range.slice(1) : text.trim().split(/[\s,;]+/).filter(Boolean);
  const numbers = words.map(Number);
  if (numbers.some(number => !Number.isFinite(number))) return null;
  if (!range) return numbers;
  const [from, to, count] = numbers;
  return count < 2 ? [from] : Array.from({ length: count }, (_, i) => rounded(from + (to - from) * i / (count - 1)));
}

// changed(field, value): a value, an array of several for a number, or undefined for none. element, show(value), complain(text).
export function createInput(field, changed) {
  const { names, order, entry } = field;
  const label = spoken(order > 0 || names.length === 1 ? names : names.slice(1)) + (entry > 0 ? ` (${entry + 1})` : '');
  const id = `input${field.pointer.replaceAll('/', '-')}`;
  const problem = h('p', { class: 'problem', id: `${id}-problem` });
  const control = CONTROLS[field.kind](field, id, value => changed(field, value), text => complain(text));
  const complain = text => {
    problem.textContent = text;
    for (const input of control.inputs)
      if (text) input.setAttribute('aria-invalid', 'true'); else input.removeAttribute('aria-invalid');
  };
  for (const input of control.inputs) input.setAttribute('aria-describedby', `${id}-help ${id}-problem`);
  const element = h('div', { class: `field ${field.kind}` },
    h('label', { for: id }, label),
    h('div', { class: 'control' }, control.parts), problem, h('p', { class: 'help', id: `${id}-help` }, field.schema.description));
  return { field, element, complain, show: control.show };
}

const CONTROLS = { number: numberControl, choice: choiceControl, text: textControl, true: trueControl, json: jsonControl };

function numberControl(field, id, changed, complain) {
  const { multiples, schema } = field, own = schema['x-unit'] ?? '', units = Object.keys(multiples);
  const input = h('input', { id, type: 'text', inputmode: 'text', autocomplete: 'off', spellcheck: 'false', oninput: read });
  const unit = units.length > 1 && (own || field.unit)
    ? h('select', { 'aria-label': `unit of ${spoken(field.names)}`, onchange: convert }, units.map(name => h('option', { value: name }, name || 'share')))
    : null;
  const echo = h('output', { class: 'si', for: id });
  if (unit) unit.value = units.includes(field.unit) ? field.unit : own;
  let kept = []; // in the field's own unit
  const factor = () => unit ? multiples[unit.value] : 1;

  function showEcho() {
    echo.textContent = kept.length > 1 ? `${kept.length} values: a study` : unit?.value === own || kept.length === 0 ? '' : `${significant(kept[0], 6)} ${own}`;
  }
  function read() {
    const numbers = numbersIn(input.value);
    if (numbers === null) return complain('Numbers only: one, or several with spaces between them, or "0.1 to 0.5 in 5".');
    complain('');
    kept = numbers.map(number => rounded(number * factor()));
    showEcho();
    return changed(kept.length === 0 ? undefined : kept.length === 1 ? kept[0] : kept);
  }
  function convert() {
    input.value = kept.map(number => written(number / factor())).join(' ');
    hint();
    showEcho();
  }
  const hint = () => { if (schema.default !== undefined) input.placeholder = written(schema.default / factor()); };
  hint();
  return { inputs: [input], parts: [input, unit ?? (own ? h('span', { class: 'unit' }, own) : null), echo], show: value => {
    const text = [value ?? []].flat();
    if (text.some(one => typeof one !== 'number')) return; // a quantity with a unit of its own: shown in the JSON alone
    kept = text;
    convert();
  } };
}

function choiceControl(field, id, changed) {
  const select = h('select', { id, onchange: () => changed(select.value || undefined) },
    h('option', { value: '' }, field.schema.default ?? field.choices[0]), field.choices.slice(1).map(choice => h('option', { value: choice }, choice)));
  return { inputs: [select], parts: [select], show: value => { select.value = value === field.choices[0] ? '' : typeof value === 'string' ? value : ''; } };
}

function textControl(field, id, changed) {
  const input = h('input', { id, type: 'text', autocomplete: 'off', spellcheck: 'false', oninput: () => changed(input.value || undefined) });
  return { inputs: [input], parts: [input], show: value => { input.value = value ?? ''; } };
}

function trueControl(field, id, changed) {
  const input = h('input', { id, type: 'checkbox', onchange: () => changed(input.checked || undefined) });
  return { inputs: [input], parts: [input], show: value => { input.checked = value === true; } };
}

function jsonControl(field, id, changed, complain) {
  const input = h('textarea', { id, rows: 2, spellcheck: 'false', placeholder: 'JSON', oninput: () => {
    try {
      changed(input.value.trim() === '' ? undefined : JSON.parse(input.value));
      complain('');
    } catch {
      complain('This is not JSON.');
    }
  } });
  return { inputs: [input], parts: [input], show: value => { input.value = value === undefined ? '' : JSON.stringify(value); } };
}
