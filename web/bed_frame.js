// One picture of a bed: little-endian numbers as api/FRAMES.md has them, told apart without being copied.
const MAGIC = 'RPSFRM1\0', HEAD = 64;
const SPECIES = 1, RADIUS = 2, CLUSTER = 4, SPIN = 8, CONTACTS = 16;

// The frame that begins at this byte: {count, time (s), angle (rad, of the drum), low, high (m), largestSpeed (m/s),
// largestRadius (m), position (3 n int16), speed, and where they vary species, radius, cluster, spin, contacts; bytes}.
export function parseFrame(buffer, start = 0) {
  const head = new DataView(buffer, start, HEAD);
  const magic = String.fromCharCode(...new Uint8Array(buffer, start, MAGIC.length));
  if (magic !== MAGIC) throw new Error('these bytes are no frame of this version');
  const three = at => [0, 4, 8].map(k => head.getFloat32(at + k, true));
  const count = head.getUint32(8, true), flags = head.getUint32(12, true);
  let at = start + HEAD;
  const take = (flag, Kind, width = 1) => {
    if (flag && !(flags & flag)) return null;
    const array = new Kind(buffer, at, width * count);
    at += Math.ceil(array.byteLength / 4) * 4;
    return array;
  };
  return {
    count, time: head.getFloat64(16, true), angle: head.getFloat64(24, true), low: three(32), high: three(44),
    largestSpeed: head.getFloat32(56, true), largestRadius: head.getFloat32(60, true),
    position: take(0, Int16Array, 3), speed: take(0, Uint8Array), species: take(SPECIES, Uint8Array),
    radius: take(RADIUS, Uint16Array), cluster: take(CLUSTER, Uint32Array), spin: take(SPIN, Uint8Array),
    contacts: take(CONTACTS, Uint8Array), bytes: at - start,
  };
}

// What a coordinate of a particle is in metres.
export const placeOf = (frame, particle, axis) =>
  frame.low[axis] + (frame.position[3 * particle + axis] + 32767) / 65534 * (frame.high[axis] - frame.low[axis]);
