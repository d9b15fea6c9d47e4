// What the page knows at the moment. Everything in it can be asked of the server again.

/** The state. `drafts`: settings on their way to the server; `refused`: settings that it refused; `problems`: the last
 *  problem of each call. */
export const state = {
  link: "starting",
  version: "",
  step: "open",
  case: null,
  drafts: {},
  refused: {},
  problems: {},
  busy: {},
  running: [],
  progress: {},
  messages: [],
  moment: null,
  files: null,
  scan: null,
  tissue: null,
  body: null,
  stretch: null,
  plan: null,
  run: null,
  accept: [],
  cross: null,
  window: {width: 400, level: 40},
  overlay: 0.35,
  placing: null,
  focus: null,
  edge: {points: [], isClosed: false, selected: -1, curve: [], isSaved: true, mode: "look", where: "rest"},
  scrub: 1,
  layers: 0,
  notice: "",
  large: "",
  noScene: "",
};

const listeners = new Set();
let isTold = false;

/** Puts new values into the state and tells the listeners, once however often it is called in one turn. */
export function update(patch) {
  Object.assign(state, patch);
  if (isTold) return;
  isTold = true;
  queueMicrotask(() => {
    isTold = false;
    for (const listener of listeners) listener();
  });
}

/** Calls back after each update. */
export function subscribe(listener) {
  listeners.add(listener);
}

/** Calls `apply` after an update in which one of the values that `select` gives is another object or number. */
export function when(select, apply) {
  let last = [];
  subscribe(() => {
    const now = select();
    if (now.length === last.length && now.every((value, k) => value === last[k])) return;
    last = now;
    apply();
  });
}

/** A value under a dotted key, or undefined. */
export function valueAt(object, key) {
  return key
    .split(".")
    .reduce((value, part) => (value === null || value === undefined ? undefined : value[part]), object);
}

/** A setting as the page shows it: what is on its way to the server, else what the case holds; null where absent. */
export function setting(key) {
  if (key in state.drafts) return state.drafts[key];
  const value = state.case ? valueAt(state.case.settings, key) : undefined;
  return value === undefined ? null : value;
}

/** The unit of a setting, or "". */
export function unitOf(key) {
  const units = (state.case && state.case.units) || {};
  return units[key] || units[key.split(".").pop()] || "";
}

/** Whether a result was computed with the settings as they are now. */
export function isFresh(name) {
  return Boolean(state[name] && state.case && state[name].revision === state.case.revision);
}
