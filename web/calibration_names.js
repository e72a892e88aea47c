// What a calibration's parameters and targets are called, with their units: by the descriptions of the processes that they are of.
import { describe } from './words.js';

const steps = pointer => pointer.split('/').slice(1).map(step => step.replaceAll('~1', '/').replaceAll('~0', '~'));

// The schema at a path of member names and places in lists; undefined where nothing describes it.
function schemaAt(schema, path) {
  return path.reduce((at, step) => at?.properties?.[step] ?? (/^\d+$/.test(step) ? at?.items : undefined)
    ?? at?.oneOf?.map(one => one.properties?.[step]).find(Boolean), schema);
}

const unitOf = (schema, parent) => schema?.['x-unit'] ?? parent?.['x-unit'] ?? '';
const shownUnit = unit => unit === 'degrees' ? '°' : unit === '1' ? '' : unit;

function nameOfInput(pointer, request, descriptions) {
  const path = steps(pointer), isOfTarget = path[0] === 'targets';
  const target = isOfTarget ? request.targets[Number(path[1])] : null;
  const own = isOfTarget ? path.slice(3) : path.slice(1);
  const base = request.base.process ?? 'drum', process = target?.process ?? base;
  // A parameter of another process than the base's is described there.
  const kinds = [process, ...request.targets.map(one => one.process ?? base)];
  const schema = kinds.map(kind => schemaAt(descriptions.get(kind)?.inputs[own[0]]?.schema, own.slice(1))).find(Boolean);
  const name = own.join('/').replaceAll('_', ' ');
  return { name: target ? `${name} of ${target.name ?? `target ${Number(path[1]) + 1}`}` : name,
    short: own.at(-1).replaceAll('_', ' '), unit: shownUnit(unitOf(schema)), title: schema?.description ?? '' };
}

function nameOfResult(target, base, descriptions) {
  const path = steps(target.result ?? `/${target.curve}`), { outputs } = descriptions.get(target.process ?? base);
  const schema = schemaAt(outputs[path[0]]?.schema, path.slice(1)), parent = schemaAt(outputs[path[0]]?.schema, path.slice(1, -1));
  return { what: `${target.process ?? base}: ${schema?.title ?? path.at(-1).replaceAll('_', ' ')}`, unit: target.curve ? 'm' : shownUnit(unitOf(schema, parent)) };
}

// {parameters: Map of pointer to {name, short, unit, title, low, high, isLog}, measures: [{what, unit}] of targets and of hold-outs}
export async function calibrationNames(request) {
  const base = request.base.process ?? 'drum', all = [...request.targets, ...request.hold_out ?? []];
  const kinds = [...new Set([base, ...all.map(target => target.process ?? base)])];
  const descriptions = new Map(await Promise.all(kinds.map(async kind => [kind, await describe(kind)])));
  const parameters = new Map(Object.entries(request.parameters).map(([pointer, { range, scale }]) =>
    [pointer, { ...nameOfInput(pointer, request, descriptions), low: range[0], high: range[1], isLog: scale === 'log' }]));
  const names = list => list.map(target => ({ ...nameOfResult(target, base, descriptions), points: target.points?.length ?? 1 }));
  return { parameters, targets: names(request.targets), holdOuts: names(request.hold_out ?? []) };
}
