// Asking again and again, politely: when the daemon tells of a change; where it can't tell, soon while something runs, seldom
// when nothing does or nobody looks; and ever more seldom while it can't be reached.

import { isOfAddress } from './connection.js';
import { listenTo } from './live.js';

const BUSY = 2_000, IDLE = 5_000, HIDDEN = 60_000, LONGEST = 60_000; // ms
const TOLD_BUSY = 15_000, TOLD = 900_000; // ms, while the daemon tells of changes

// ask(): a promise that resolves to true when something is going on, to SETTLED when nothing will change by itself. Told of every
// failure: failed(error, ms). isOurs(change): whether a change of a job is of what is shown.
export const SETTLED = 'settled';
export function startPolling(ask, failed, isOurs = () => true) {
  let timer = 0, failures = 0, turn = 0;
  const changes = listenTo(now, isOurs);

  function pauseAfter(found) {
    if (found === SETTLED) return LONGEST;
    if (changes.isLive()) return found ? TOLD_BUSY : TOLD;
    return found ? BUSY : IDLE;
  }

  async function now() {
    clearTimeout(timer);
    const mine = ++turn; // a later now() overtakes: an older answer then arms no timer of its own
    let pause;
    try {
      const found = await ask();
      if (found === SETTLED) changes.stop(); else changes.start();
      pause = pauseAfter(found);
      failures = 0;
    } catch (error) {
      if (mine !== turn) return;
      pause = isOfAddress(error) ? LONGEST : Math.min(BUSY * 2 ** failures++, LONGEST);
      failed(error, pause);
    }
    if (mine === turn) timer = setTimeout(now, document.hidden ? Math.max(pause, HIDDEN) : pause);
  }

  document.addEventListener('visibilitychange', () => { if (!document.hidden) now(); });
  window.addEventListener('online', now);
  now();
  return now;
}
