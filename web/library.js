// The library at work in its threads (worker.js): what the page asks of them, and what they say of
// their progress and their failures.

export const $ = (id) => document.getElementById(id);

// Asking -----------------------------------------------------------------------------------------

const waiting = new Map();
let next_id = 0;
const make_worker = () => new Worker(new URL('worker.js', import.meta.url), { type: 'module' });
const worker = make_worker();
// Built-in environments are drawn in another thread, as that takes seconds.
let painter;

// Resolves to the answer; one with an `error` is shown and thrown.
function ask_of(one, call, args, transfer = []) {
  const id = ++next_id;
  one.postMessage({ id, call, args }, transfer);
  return new Promise((resolve, reject) => waiting.set(id, { resolve, reject }));
}
export const ask = (call, args = [], transfer = []) => ask_of(worker, call, args, transfer);
export function ask_painter(call, args) {
  painter ??= listen_to(make_worker(), 'painter');
  return ask_of(painter, call, args);
}

// Changes go one after the other; while one is on its way only the newest of a kind waits.
const newest = new Map();
export const is_waiting = (kind) => Boolean(newest.get(kind));
export async function ask_newest(kind, make) {
  const before = newest.get(kind);
  newest.set(kind, make);
  if (before !== undefined) return;
  try {
    while (newest.get(kind)) {
      const run = newest.get(kind);
      newest.set(kind, null);
      await run();
    }
  } catch { /* it is on the page */ } finally {
    newest.delete(kind);
  }
}

// What the threads say -----------------------------------------------------------------------------

const listeners = { frame: () => {}, map: () => {} };
export const listen = (more) => Object.assign(listeners, more);

function listen_to(one, who) {
  one.onerror = (event) => stop(event.message || 'The page’s files could not be loaded.');
  one.onmessage = ({ data }) => {
    if (data.id) answer(data);
    if (data.stage !== undefined) show_stage(who, data.stage, data.share);
    if (data.frame) listeners.frame(data.frame);
    if (data.failure) show_error(data.failure);
    for (const map of data.maps ?? []) listeners.map(map);
  };
  return one;
}

function answer({ id, result }) {
  const { resolve, reject } = waiting.get(id);
  waiting.delete(id);
  if (result.error) {
    show_error(result.error);
    reject(new Error(result.error));
  } else {
    resolve(result);
  }
}

// Words for people ---------------------------------------------------------------------------------

// What takes its time, by who says so; the last to begin is shown.
const stages = new Map();
let ready_text = '';

// `share` is how much of it is done, from 0 to 1; without it, or when all of what can be told is, the
// bar says only that something goes on.
export function show_stage(who, text, share) {
  if (text) stages.set(who, { text, share }); else stages.delete(who);
  const stage = [...stages.values()].at(-1);
  document.body.classList.toggle('busy', stage !== undefined);
  $('status').textContent = stage?.text ?? ready_text;
  const bar = $('progress');
  const is_known = stage?.share < 1;
  if (is_known) bar.value = stage.share; else bar.removeAttribute('value');
  bar.setAttribute('aria-valuetext',
    is_known ? `${stage.text} ${Math.floor(100 * stage.share)} %` : stage?.text ?? '');
}

// What is said when nothing else is.
export function show_ready(text) {
  ready_text = text;
  if (!stages.size) $('status').textContent = text;
}

export function show_error(text) {
  $('error').textContent = text;
  $('error').hidden = !text;
}

export function stop(why) {
  stages.clear();
  ready_text = 'Stopped.';
  show_stage('page', '');
  show_error(why);
}

listen_to(worker, 'worker');
