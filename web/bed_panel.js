// A bed with its frames, controls and legend, which follows a clock. Where it can't be drawn, it says why and shows what there is.
import { h } from './dom.js';
import { ApiError, jobPath, request } from './api.js';
import { waysOf } from './bed_colors.js';
import { sharedRenderer } from './bed_renderer.js';
import { createFrameStore } from './bed_store.js';
import { createBedView } from './bed_view.js';
import { parseWalls } from './bed_walls.js';
import { drumPicture } from './drum_picture.js';

const AHEAD = 4; // frames fetched before they are needed, while the clock goes

// scene: {process, inputs}; angleAt(time), liftAt(time): of the samples, or null. chosen: {colorBy}, from the address; told(choice):
// where another is made.
export function createBedPanel(job, scene, clock, { angleAt = () => null, liftAt = () => 0, chosen = {}, told = () => {}, isSmall = false } = {}) {
  const store = createFrameStore(job.jobID);
  const element = h('div', { class: 'bed-panel' });
  if (!sharedRenderer()) return withoutWebGl(element, store, job);
  const view = createBedView(scene, { label: `The bed of ${job.processID} ${job.jobID}: drag or use the arrow keys to turn it` });
  const legend = h('div', { class: 'legend-box' });
  const colorBy = h('select', { class: 'color-by', onchange: () => choose({ colorBy: colorBy.value }, true) });
  const cut = h('input', { type: 'range', class: 'cut', min: 0, max: 1, step: 0.01, value: 1, oninput: () => view.set({ cut: Number(cut.value) }) });
  const save = h('button', { type: 'button', class: 'save-png', onclick: () => savePicture(view, `${job.jobID}-${clock.time.toFixed(3)}s.png`) }, 'Save as PNG');
  const tools = h('div', { class: 'bed-tools' }, h('label', null, 'Colour by ', colorBy), h('label', null, `Cut ${view.isDrum ? 'along the axis' : 'from the front'} `, cut), save);
  element.append(h('div', { class: 'bed-box' }, view.element), legend, ...(isSmall ? [] : [tools]));
  view.element.addEventListener('drawn', () => legend.replaceChildren(view.legend()));
  let wanted = -1, wallsOf = null, wallHeight = 0, failed = '', ways = '';

  function choose({ colorBy: key }, isOfUser) {
    colorBy.value = key;
    view.set({ colorBy: colorBy.value || 'speed' });
    if (isOfUser) told({ colorBy: key });
  }

  function offerWays(frame) {
    const offered = waysOf(frame), key = JSON.stringify(offered);
    if (key === ways) return;
    ways = key;
    const now = colorBy.value || chosen.colorBy || 'speed';
    colorBy.replaceChildren(...offered.map(([value, name]) => h('option', { value }, name)));
    choose({ colorBy: offered.some(([value]) => value === now) ? now : 'speed' });
  }

  async function showAt(time) {
    const place = store.nearest(time);
    if (place < 0) return;
    view.set({ angle: angleAt(time), raised: liftAt(time) - wallHeight });
    if (place === wanted) return;
    wanted = place;
    try {
      const frame = await store.load(place);
      if (wanted !== place) return; // another is wanted meanwhile
      offerWays(frame);
      view.set({ frame });
      for (let k = 1; clock.isGoing && k <= AHEAD && place + k < store.list.length; k++) store.load(place + k).catch(() => {});
    } catch (error) {
      if (wanted === place) wanted = -1;
      explain(error);
    }
  }

  function explain(error) {
    if (!(error instanceof ApiError)) console.error(error);
    if (failed) return;
    failed = error.message;
    if (error.status === 404) showInstead(element, job, 'This job was run before beds were kept for the page.', false);
    else legend.replaceChildren(h('p', { class: 'quiet' }, `The bed was not loaded: ${error.message}.`));
    if (error.status !== 404) failed = '';
  }

  async function loadWalls() {
    if (wallsOf === job.jobID) return;
    wallsOf = job.jobID;
    try {
      const walls = parseWalls(await (await request(`${jobPath(job.jobID)}/walls.vtp`, { accept: '*/*' })).text());
      view.set({ walls });
      wallHeight = view.shellLow();
      if (view.isDrum || scene.process !== 'heap') wallHeight = 0;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      wallsOf = null;
    }
  }

  // Learns of new frames, and shows the one of the clock.
  async function update() {
    await store.update();
    if (store.list.length === 0 || failed) return;
    try {
      const start = await store.load(0);
      view.set({ start });
      if (start.count > 0) await loadWalls();
    } catch (error) {
      explain(error);
    }
    await showAt(clock.time);
  }

  clock.listen(showAt);
  return { element, store, update, view, choose, isReady: () => Boolean(failed) || store.nearest(clock.time) < 0 || Boolean(store.has(store.nearest(clock.time))) };
}

function withoutWebGl(element, store, job) {
  let known = null; // whether there is a picture
  const update = async () => {
    const hasPicture = (await store.update()).some(({ hasFrame }) => hasFrame);
    if (hasPicture !== known) showInstead(element, job, 'This browser has no WebGL2, which the moving bed is drawn with.', hasPicture);
    known = hasPicture;
  };
  return { element, store, update, isReady: () => true, view: null, choose: () => {} };
}

// The picture that the worker drew, or, of an older job, a drawing of the angle.
function showInstead(element, job, why, hasPicture) {
  element.replaceChildren(h('p', { class: 'notice', role: 'note' }, why),
    hasPicture ? h('img', { class: 'still', alt: `The bed of ${job.jobID}`, src: `${jobPath(job.jobID)}/picture.png` })
      : job.processID === 'drum' ? drumPicture(job.summary ?? {}, 240, 'The drum with its measured angle') : '');
}

function savePicture(view, name) {
  view.draw();
  view.element.toBlob(blob => {
    const address = URL.createObjectURL(blob);
    h('a', { href: address, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(address), 10_000);
  });
}
