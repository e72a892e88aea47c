// The inputs of a process as a form asks for them: made of the process's description, so that no name, unit, range or
// default stands here.

const isNumber = schema => ['number', 'integer'].some(type => [schema.type].flat().includes(type));
const isObject = schema => [schema.type].flat().includes('object') && schema.properties;

function kindOf(schema) {
  if (schema.oneOf) return 'choice';
  if (schema.const === true) return 'true';
  if (isNumber(schema)) return 'number';
  if (schema.enum) return 'choice';
  return schema.type === 'string' ? 'text' : 'json';
}

// {pointer: '/particles/0/diameter', names: ['particles', 'diameter'], kind, schema, order, unit}; order: among the usual ones.
function fieldOf(schema, pointer, names, entry, units) {
  const own = schema['x-unit'] ?? '', form = schema['x-form'] ?? {};
  const kind = kindOf(schema);
  return { pointer, names, entry, kind, schema, order: form.order ?? 0,
    choices: schema.enum ?? schema.oneOf?.[0].enum ?? [],
    unit: form.unit ?? units[own]?.usual ?? own, // in which it is asked for
    multiples: kind === 'number' ? multiplesOf(schema, units[own]?.multiples ?? {}) : {} };
}

// {unit: how many of the field's own one of it is}; of several names of one unit the first.
function multiplesOf(schema, all) {
  const own = schema['x-unit'] ?? '', allowed = [own, ...schema.properties?.unit?.enum ?? []];
  const kept = { [own]: 1 };
  for (const name of allowed)
    if (name in all && !Object.values(kept).includes(all[name])) kept[name] = all[name];
  return kept;
}

function fieldsIn(schema, pointer, names, entry, units) {
  return isObject(schema) && !isNumber(schema)
    ? Object.entries(schema.properties).flatMap(([name, member]) => fieldsIn(member, `${pointer}/${name}`, [...names, name], entry, units))
    : [fieldOf(schema, pointer, names, entry, units)];
}

// Entries of a list that every test needs are asked for one by one; other lists are written as JSON. entries: how many it has.
function fieldsOfInput(name, { schema, minOccurs }, entries, units) {
  if (schema.type !== 'array' || minOccurs === 0 || !isObject(schema.items)) return fieldsIn(schema, `/${name}`, [name], null, units);
  return Array.from({ length: Math.max(entries, 1) }, (_, i) => fieldsIn(schema.items, `/${name}/${i}`, [name], i, units)).flat();
}

export function fieldsOf(description, inputs) {
  const units = description['x-units'] ?? {};
  return Object.entries(description.inputs).flatMap(([name, input]) =>
    fieldsOfInput(name, input, Array.isArray(inputs[name]) ? inputs[name].length : 1, units));
}

// Lists whose entries are fields: [{name, most}].
export const listsOf = description => Object.entries(description.inputs)
  .filter(([, { schema, minOccurs }]) => schema.type === 'array' && minOccurs > 0 && isObject(schema.items))
  .map(([name, { schema }]) => ({ name, most: schema.maxItems }));
