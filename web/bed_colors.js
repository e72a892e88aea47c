// What the particles of a bed may be coloured by, and what the colours mean.
import { placeOf } from './bed_frame.js';
import { millimetres, significant } from './format.js';

// Viridis at nine places: even in lightness, and told apart by those who see red and green alike.
const SCALE = [[68, 1, 84], [71, 45, 123], [59, 82, 139], [44, 114, 142], [33, 145, 140], [40, 174, 128], [94, 201, 98], [173, 220, 48], [253, 231, 37]];
const KINDS = [[201, 139, 75], [70, 110, 150], [120, 150, 80], [165, 85, 95], [130, 105, 160], [85, 155, 150], [190, 175, 90], [120, 120, 120]];
const NONE = [150, 150, 150]; // of which nothing is known

// share: 0 to 1
export function onScale(share) {
  const at = Math.min(Math.max(share, 0), 1) * (SCALE.length - 1), k = Math.min(Math.floor(at), SCALE.length - 2);
  return SCALE[k].map((low, c) => Math.round(low + (at - k) * (SCALE[k + 1][c] - low)));
}
const STEPS = Array.from({ length: 256 }, (_, k) => onScale(k / 255));

const steps = numbers => k => STEPS[numbers[k]];
const span = (low, high, isOf = 0) => ({ low, high, isOf });

// Where each particle was at the start, along an axis, as a share of the bed's extent.
function starts(axis) {
  return (frame, start) => {
    if (!start) return () => NONE;
    let low = Infinity, high = -Infinity;
    for (let k = 0; k < start.count; k++) {
      const place = placeOf(start, k, axis);
      if (place < low) low = place;
      if (place > high) high = place;
    }
    return k => k < start.count ? onScale((placeOf(start, k, axis) - low) / (high - low || 1)) : NONE;
  };
}

const mostContacts = frame => Math.max(1, frame.contacts.reduce((most, one) => Math.max(most, one), 0));
// Neighbours in number get colours far apart.
const ofCluster = number => KINDS[(number * 5 + (number >> 3)) % (KINDS.length - 1)];

// needs: the member of the frame that it is told from; paint(frame, start): gives a function of the particle's number;
// legend(frame): {low, high} in words, or {kinds: how many}; upright: the names where the container stands upright.
const WAYS = {
  speed: { name: 'speed', needs: 'speed', paint: frame => steps(frame.speed), legend: frame => span('0', `${significant(frame.largestSpeed)} m/s`) },
  species: { name: 'species', needs: 'species', paint: frame => k => KINDS[frame.species[k] % KINDS.length],
    legend: frame => ({ kinds: 1 + frame.species.reduce((most, one) => Math.max(most, one), 0) }) },
  size: { name: 'size', needs: 'radius', paint: frame => sizes(frame),
    legend: frame => span(millimetres(2 * frame.largestRadius * least(frame.radius) / 65535), millimetres(2 * frame.largestRadius)) },
  cluster: { name: 'cluster', needs: 'cluster', paint: frame => k => ofCluster(frame.cluster[k]), legend: () => ({ text: 'one colour a cluster' }) },
  spin: { name: 'spin', needs: 'spin', paint: frame => steps(frame.spin),
    legend: frame => span('0', `≥ ${significant(frame.largestSpeed / frame.largestRadius)} rad/s`) },
  contacts: { name: 'contacts', needs: 'contacts',
    paint: frame => { const most = mostContacts(frame); return k => onScale(frame.contacts[k] / most); },
    legend: frame => span('0', String(mostContacts(frame))) },
  'start-x': { name: 'place at the start, left to right', needs: 'position', paint: starts(0), legend: () => span('left', 'right') },
  'start-up': { name: 'place at the start, height', needs: 'position', paint: starts(1), upright: starts(2), legend: () => span('bottom', 'top') },
};

const least = numbers => numbers.reduce((low, one) => Math.min(low, one), Infinity);

function sizes(frame) {
  const low = least(frame.radius);
  return k => onScale((frame.radius[k] - low) / (65535 - low || 1));
}

// [key, name] of the ways that this frame can be coloured.
export const waysOf = frame => Object.entries(WAYS).filter(([, way]) => frame[way.needs]).map(([key, { name }]) => [key, name]);

// {colors: 3 n bytes, legend}
export function paint(frame, start, key, isUpright) {
  const way = frame[WAYS[key]?.needs] ? WAYS[key] : WAYS.speed;
  const of = (isUpright && way.upright || way.paint)(frame, start);
  const colors = new Uint8Array(3 * frame.count);
  for (let k = 0; k < frame.count; k++) colors.set(of(k), 3 * k);
  return { colors, legend: { name: way.name, ...way.legend(frame) } };
}

export const kindColor = k => KINDS[k % KINDS.length];
