// What changes, as the daemon tells it: one stream while the page is looked at, since a browser opens only few at once.
import { root } from './api.js';

const GAP = 2_000;    // ms at least between two tellings
const AGAIN = 30_000; // ms until a stream that was refused is asked for again

// heard(): something has changed, or was missed. Returns {start, isLive}: start may be called any time.
export function listenTo(heard) {
  let source = null, isLive = false, timer = 0, wanted = false;

  function tell() {
    timer ||= setTimeout(() => { timer = 0; heard(); }, GAP);
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
    for (const kind of ['job', 'jobs']) source.addEventListener(kind, tell);
  }
  document.addEventListener('visibilitychange', () => document.hidden ? close() : open());
  window.addEventListener('pagehide', close);
  return { start: () => { wanted = true; open(); }, isLive: () => isLive };
}
