// The frames of one job: which there are and when, each fetched when it is asked for, the latest kept.
import { ApiError, jobPath, json, request } from './api.js';
import { parseFrame } from './bed_frame.js';

const KEPT = 96 << 20; // bytes

export function createFrameStore(id) {
  const list = [];         // {number, time, name, size, hasFrame} in order of time
  const kept = new Map();  // number: frame; the longest unused first
  const coming = new Map();
  let bytes = 0, last = -1;

  // Learns of the snapshots written since it last asked.
  async function update() {
    for (let more = true; more;) {
      const { snapshots, links } = await json(`${jobPath(id)}/snapshots?after=${last}`);
      for (const { number, time, href, bytes: size, frame } of snapshots) {
        list.push({ number, time, name: href.split('/').pop().replace(/\.hdf$/, ''), size, hasFrame: Boolean(frame) });
        last = number;
      }
      more = links.some(link => link.rel === 'next');
    }
    return list;
  }

  // The place in the list of what is nearest in time; -1: there are none.
  function nearest(time) {
    let low = 0, high = list.length - 1;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (list[middle].time < time) low = middle + 1; else high = middle;
    }
    return low > 0 && time - list[low - 1].time < list[low].time - time ? low - 1 : high < 0 ? -1 : low;
  }

  const has = place => kept.get(list[place]?.number);

  async function load(place) {
    const wanted = list[place];
    if (!wanted.hasFrame) throw new ApiError(404, 'it has no frame');
    if (kept.has(wanted.number)) {
      const frame = kept.get(wanted.number);
      kept.delete(wanted.number);
      kept.set(wanted.number, frame);
      return frame;
    }
    if (!coming.has(wanted.number)) coming.set(wanted.number, fetched(wanted).finally(() => coming.delete(wanted.number)));
    return coming.get(wanted.number);
  }

  async function fetched({ number, name }) {
    const answer = await request(`${jobPath(id)}/snapshots/${name}.bin`, { accept: '*/*', cache: 'default' });
    const frame = parseFrame(await answer.arrayBuffer());
    kept.set(number, frame);
    bytes += frame.bytes;
    for (const [old, { bytes: size }] of kept) {
      if (bytes <= KEPT || old === number) break;
      kept.delete(old);
      bytes -= size;
    }
    return frame;
  }

  return { list, update, nearest, has, load };
}
