// What a form is about: a test or, as soon as anything has several values or is repeated, a study; and the document that is
// sent for it. Numbers are in the units that the daemon keeps them in.

const keysOf = pointer => pointer.split('/').slice(1).map(key => key.replaceAll('~1', '/').replaceAll('~0', '~'));
const isRecord = value => value !== null && typeof value === 'object' && !Array.isArray(value);

export const valueAt = (object, pointer) => keysOf(pointer).reduce((at, key) => at?.[key], object);

// undefined: takes the member out, and with it objects that have no other.
export function setAt(object, pointer, value) {
  const keys = keysOf(pointer), last = keys.pop(), path = [object];
  for (const key of keys) {
    if (!isRecord(path.at(-1)[key]) && !Array.isArray(path.at(-1)[key])) {
      if (value === undefined) return;
      path.at(-1)[key] = {};
    }
    path.push(path.at(-1)[key]);
  }
  if (value !== undefined) path.at(-1)[last] = value;
  else delete path.at(-1)[last];
  for (let i = keys.length; value === undefined && i > 0; i--)
    if (isRecord(path[i]) && Object.keys(path[i]).length === 0 && !Array.isArray(path[i - 1])) delete path[i - 1][keys[i - 1]];
}

// A JSON merge patch (RFC 7396).
export function merged(target, patch) {
  if (!isRecord(patch)) return patch;
  const whole = isRecord(target) ? { ...target } : {};
  for (const [key, value] of Object.entries(patch))
    if (value === null) delete whole[key]; else whole[key] = merged(whole[key], value);
  return whole;
}

// What is null is as good as not given, and a form has no place for it.
function withoutNulls(value) {
  if (Array.isArray(value)) return value.map(withoutNulls);
  if (!isRecord(value)) return value;
  return Object.fromEntries(Object.entries(value).filter(([, member]) => member !== null).map(([key, member]) => [key, withoutNulls(member)]));
}

// given: a request for a test, or a study.
export function documentOf(given, process) {
  const test = given.base ?? given;
  const inputs = withoutNulls(test.inputs ?? {});
  const varied = new Map(Object.entries(given.vary ?? {}).map(([pointer, values]) => [pointer.replace(/^\/inputs/, ''), values]));
  for (const [pointer, [first]] of varied) setAt(inputs, pointer, first);
  return { process: test.process ?? process, inputs, varied, label: { ...test.label }, cases: given.cases ?? null,
    repeats: given.repeats ?? 1, name: given.name ?? '', description: given.description ?? '' };
}

export const isStudy = ({ varied, repeats, cases }) => varied.size > 0 || repeats > 1 || cases !== null;

export const casesIn = ({ varied, cases }) => cases ? cases.length : [...varied.values()].reduce((product, values) => product * values.length, 1);

// {path below the service's root, body} of the request that submits it.
export function requestOf(test) {
  const label = Object.fromEntries(Object.entries(test.label).filter(([, value]) => value !== ''));
  const labelled = Object.keys(label).length ? { label } : {};
  if (!isStudy(test)) return { path: `processes/${test.process}/execution`, body: { inputs: test.inputs, ...labelled } };
  const base = { process: test.process, inputs: structuredClone(test.inputs), ...labelled };
  return { path: 'studies', body: {
    name: test.name || 'unnamed', ...test.description ? { description: test.description } : {}, base,
    ...test.cases ? { cases: test.cases } : {},
    ...test.varied.size ? { vary: Object.fromEntries([...test.varied].map(([pointer, values]) => [`/inputs${pointer}`, values])) } : {},
    ...test.repeats > 1 ? { repeats: test.repeats } : {} } };
}

// Some of the single tests that it stands for, at most `most`, the first and the last among them: [{inputs, varied: [pointer, ...]}].
export function testsOf(test, most) {
  const all = casesIn(test), shown = Math.min(all, most);
  return Array.from({ length: shown }, (_, i) => nthTest(test, shown === 1 ? 0 : Math.round(i * (all - 1) / (shown - 1))));
}

function nthTest({ inputs, varied, cases, process }, n) {
  if (cases) return { process, inputs: merged(inputs, cases[n].inputs ?? {}) };
  const own = structuredClone(inputs);
  for (const [pointer, values] of [...varied].reverse()) {
    setAt(own, pointer, values[n % values.length]);
    n = Math.floor(n / values.length);
  }
  return { process, inputs: own };
}
