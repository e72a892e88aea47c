// What changes, as the daemon tells it: one stream while the page is looked at, since a browser opens only few at once.
import { root } from './api.js';

const GAP = 2_000;    // ms at least between two tellings
const TOGETHER = 200; // ms in which changes may come together
const AGAIN = 30_000; // ms until a stream that was refused is asked for again

// heard(): something has changed, or was missed; isOurs(change): whether a job's change is worth it. Returns {start, stop, isLive}: start
// may be called any time.
export function listenTo(heard, isOurs) {
  let source = null, isLive = false, timer = 0, wanted = false, told = 0;

  function tell() {
    timer ||= setTimeout(() => { timer = 0; told = performance.now(); heard(); }, Math.max(told + GAP - performance.now(), TOGETHER));
  }
  function close() {
    source?.close();
    source = null;
    isLive = false;
  }
  function open() {
    if (source || document.hidden || !wanted) return;
    source = new EventSource(`${root}events`);
    source.onopen = () => { isLive = true; };
    source.onerror = () => {
      if (isLive) tell(); // so that what is wrong is seen at once
      isLive = false;
      if (source?.readyState !== EventSource.CLOSED) return; // the browser tries again by itself
      close();
      setTimeout(open, AGAIN);
    };
    source.addEventListener('job', event => { if (isOurs(JSON.parse(event.data))) tell(); });
    source.addEventListener('jobs', tell);
  }
  document.addEventListener('visibilitychange', () => document.hidden ? close() : open());
  window.addEventListener('pagehide', close);
  return { start: () => { wanted = true; open(); }, stop: () => { wanted = false; close(); }, isLive: () => isLive };
}
