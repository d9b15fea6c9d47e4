// What the page knows at the moment. Everything in it can be asked of the server again.

/** A photograph's settings before anything is chosen. `scale`: how it is found, with what each way needs; `hand`: what
 *  is drawn by hand, a line each or null; `mode`: what a click on it does. */
export function newPhoto() {
  return {
    file: null,
    scale: {how: "mm_per_pixel", mm_per_pixel: null, ruler_mm: null, points: [], distance_mm: null, size_mm: null},
    red: "annotation",
    max_gap_mm: null,
    hand: {incision: null, tumor_edge: null},
    mode: "look",
    selected: -1,
  };
}

/** A cloud's settings before one is chosen. `from`: "cloud", or "frame" of a colour and depth camera; `isOfFrame`:
 *  whether the chosen one is such a frame's; `frame`: where its coordinates are: "robot" or "camera". */
function newCloud() {
  return {
    from: "cloud",
    file: null,
    isVirtual: false,
    isOfFrame: false,
    scale: "fixed",
    range: [0.9, 1.1],
    settling_mm: 0,
    frame: "robot",
    camera: null,
  };
}

/** A frame of a colour and depth camera before its files are chosen. `isCloud`: it is one organised, coloured cloud;
 *  `planes`: how many flat things are taken out of its cloud. */
function newFraming() {
  const files = {color: null, depth: null, intrinsics: null, organised: null};
  return {...files, isCloud: false, mark: "green", isOpen: false, planes: 1};
}

/** The brush before its first stroke. `through_mm`: how far a stroke goes through the slices; `mode`: what it does, as
 *  `placing` says it, or null where it is put away; `refused`: how many points there would have been with a stroke that
 *  was not added, or 0; `idle`: "add" or "take" where the last stroke did so and changed nothing. */
export function newBrush() {
  return {radius_mm: 2, through_mm: 0, mode: null, refused: 0, idle: null};
}

/** Nothing to undo or to redo: {key, value} of the setting that each step changes, the next one last. */
export function newHistory() {
  return {past: [], future: []};
}

/** No patch is being painted. `k`: of which constraint one is; `isEmpty`: it was cleared, or has no point yet, and the
 *  case keeps what it holds until it has one; `radius_mm`: of such a patch; `stroke`: points under the pointer so far;
 *  `refused`: how many points there would have been with a stroke that was not added, or 0. */
export function newPatch() {
  return {k: -1, isEmpty: false, radius_mm: 5, stroke: [], refused: 0};
}

/** The results of a case before anything is computed. */
export function nothingFound() {
  return {scan: null, tissue: null, body: null, stretch: null, plan: null, room: null, run: null, moment: null};
}

/** Of the steps after the run: without a photograph, a registration and an arm. */
export function nothingMeasured() {
  return {
    picture: null,
    photograph: null,
    photo: newPhoto(),
    cloud: newCloud(),
    framing: newFraming(),
    frame: null,
    register: null,
    ...nothingLaid(),
  };
}

/** Nothing is laid on the cloud, and the arm plays nothing. */
export function nothingLaid() {
  return {lay: null, acceptLaid: [], mark: null, acceptMark: [], arm: null, armOf: "run"};
}

/** The state. `preview`: settings under the pointer, which are not sent before it lets go; `drafts`: settings on
 *  their way to the server; `refused`: settings that it refused; `problems`: the last problem of each call;
 *  `room`: how much margin fits round an edge, as room.js asks for it;
 *  `kept`: results of earlier runs, as kept.js has them; `keptDropped`: how many of them were of something else;
 *  `keptCut`: which of their cuts the plots and the 3D view show; `mark`: the edge as `lay` laid it; `layKind`:
 *  what `lay` was asked for last. */
export const state = {
  link: "starting",
  version: "",
  step: "open",
  case: null,
  preview: {},
  drafts: {},
  refused: {},
  problems: {},
  busy: {},
  running: [],
  progress: {},
  messages: [],
  files: null,
  ...nothingFound(),
  accept: [],
  kept: [],
  keptDropped: 0,
  keptCut: "corrected",
  ...nothingMeasured(),
  layKind: "incise",
  cross: null,
  window: {width: 400, level: 40},
  overlay: 0.35,
  placing: null,
  brush: newBrush(),
  history: newHistory(),
  patch: newPatch(),
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

/** Calls `apply(now)` after an update in which what `select` gives is another. */
export function when(select, apply) {
  let last = null;
  subscribe(() => {
    const now = select();
    if (isSame(now, last)) return;
    last = now;
    apply(now);
  });
}

/** Whether two values are one, or lists and objects with the same in them. Arrays of the server are the same only where
 *  they are one: they are too large to be compared. */
export function isSame(a, b) {
  if (a === b) return true;
  if (!isPlain(a) || !isPlain(b)) return false;
  const keys = Object.keys(a);
  return keys.length === Object.keys(b).length && keys.every((key) => isSame(a[key], b[key]));
}

function isPlain(value) {
  return Array.isArray(value) || (value !== null && typeof value === "object" && value.constructor === Object);
}

/** A value under a dotted key, or undefined. */
export function valueAt(object, key) {
  return key
    .split(".")
    .reduce((value, part) => (value === null || value === undefined ? undefined : value[part]), object);
}

/** A setting as the page shows it: what is under the pointer, else as it was set; null where absent. */
export function setting(key) {
  return key in state.preview ? state.preview[key] : given(key);
}

/** A setting as it was set: what is on its way to the server, else what the case holds; null where absent. */
export function given(key) {
  if (key in state.drafts) return state.drafts[key];
  const value = state.case ? valueAt(state.case.settings, key) : undefined;
  return value === undefined ? null : value;
}

/** Whether the case has voxels, of a scan or of labels, in which tissue is found; else it begins with a mesh. */
export function hasVoxels() {
  const {inputs} = state.case || {};
  return Boolean(inputs && (inputs["ct.volume"] || inputs["ct.labels"]));
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
