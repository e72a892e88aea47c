// One time for all that is shown of a run, or of several side by side: it stands, is moved, or goes on by itself.
import { h } from './dom.js';
import { significant } from './format.js';

const SPEEDS = [[0.1, '1/10'], [0.25, '1/4'], [0.5, '1/2'], [1, 'as it was'], [2, '2 ×'], [5, '5 ×'], [20, '20 ×']];

// ready(): whether what is to be shown at the present time is there, which the clock waits for while it goes.
export function createClock({ ready = () => true } = {}) {
  const listeners = new Set();
  const clock = { time: 0, from: 0, to: 0, stops: [], isGoing: false, speed: 1 };
  let before = 0;

  const tell = () => listeners.forEach(listener => listener(clock.time));
  const move = time => {
    const next = Math.min(Math.max(time, clock.from), clock.to);
    if (next === clock.time) return;
    clock.time = next;
    tell();
  };

  function tick(now) {
    if (!clock.isGoing) return;
    if (before && ready()) move(clock.time + Math.min(now - before, 250) / 1000 * clock.speed);
    before = now;
    if (clock.time >= clock.to) { clock.isGoing = false; tell(); return; }
    requestAnimationFrame(tick);
  }

  return Object.assign(clock, {
    listen: listener => listeners.add(listener),
    set: time => { clock.isGoing = false; move(time); tell(); },
    // stops: the times of the frames. follows: keeps at the end where it was there.
    extend: (from, to, stops) => {
      const wasAtEnd = clock.time >= clock.to && clock.to > 0;
      Object.assign(clock, { from, to, stops });
      if (wasAtEnd) clock.time = to;
      tell();
    },
    toggle: () => {
      clock.isGoing = !clock.isGoing;
      before = 0;
      if (clock.isGoing && clock.time >= clock.to) clock.time = clock.from;
      tell();
      if (clock.isGoing) requestAnimationFrame(tick);
    },
    // To the next frame, or the one before.
    step: way => {
      const tiny = 1e-9 * (clock.to - clock.from);
      const next = way > 0 ? clock.stops.find(stop => stop > clock.time + tiny) : clock.stops.findLast(stop => stop < clock.time - tiny);
      clock.isGoing = false;
      move(next ?? clock.time);
      tell();
    },
  });
}

// The controls of a clock: play, step, speed, and a slider over the whole run.
export function transport(clock) {
  const play = h('button', { class: 'play', type: 'button', onclick: clock.toggle });
  const slider = h('input', { type: 'range', class: 'time', 'aria-label': 'Time', step: 'any', oninput: () => clock.set(Number(slider.value)) });
  slider.addEventListener('keydown', event => {
    const way = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
    if (!way) return;
    event.preventDefault();
    clock.step(way);
  });
  const shown = h('output', { class: 'now' });
  const speed = h('select', { 'aria-label': 'Speed', onchange: () => { clock.speed = Number(speed.value); } },
    SPEEDS.map(([value, name]) => h('option', { value, selected: value === clock.speed }, name)));
  const show = () => {
    play.textContent = clock.isGoing ? '❚❚' : '▶';
    play.setAttribute('aria-label', clock.isGoing ? 'Pause' : 'Play');
    slider.min = clock.from;
    slider.max = clock.to;
    slider.value = clock.time;
    slider.setAttribute('aria-valuetext', `${significant(clock.time, 4)} s`);
    shown.textContent = `${clock.time.toFixed(clock.to - clock.from < 2 ? 3 : 2)} s`;
  };
  clock.listen(show);
  show();
  return h('div', { class: 'transport', role: 'group', 'aria-label': 'Time of the run' }, play,
    h('button', { type: 'button', 'aria-label': 'Back one frame', onclick: () => clock.step(-1) }, '◂'),
    h('button', { type: 'button', 'aria-label': 'On one frame', onclick: () => clock.step(1) }, '▸'), slider, shown, speed);
}
