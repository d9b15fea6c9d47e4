// What was changed by hand in step See, strokes of the brush and the region box: it can be undone, and made again.

import {state, update, setting} from "./store.js";
import {change, changeSoon, isWaiting} from "./actions.js";

const kMostSteps = 100;
const kStrokes = "ct.edits";

/** Sets a setting so that it can be undone. */
export function put(key, value) {
  remember(key);
  change({[key]: value});
}

/** The same for a value that is stepped: steps that are sent together are undone together. */
export function putStep(key, value) {
  if (!isWaiting(key)) remember(key);
  changeSoon({[key]: value});
}

function remember(key) {
  const past = [...state.history.past, {key, value: setting(key)}].slice(-kMostSteps);
  turnTo({past, future: []});
}

// What was said about the last stroke holds no longer.
function turnTo(history) {
  update({history, brush: {...state.brush, refused: 0, idle: null}});
}

/** What an undo brings back, {key, value}, or null. Strokes from before the page was opened go one by one. */
export function lastChange() {
  const {past} = state.history,
    strokes = setting(kStrokes) || [];
  if (past.length) return past.at(-1);
  return strokes.length ? {key: kStrokes, value: strokes.length > 1 ? strokes.slice(0, -1) : null} : null;
}

/** Takes the last change back. */
export function undo() {
  const last = lastChange(),
    {past, future} = state.history;
  if (!last) return;
  turnTo({past: past.slice(0, -1), future: [...future, {key: last.key, value: setting(last.key)}]});
  change({[last.key]: last.value});
}

/** Makes the change that was undone last again. */
export function redo() {
  const {past, future} = state.history,
    next = future.at(-1);
  if (!next) return;
  turnTo({past: [...past, {key: next.key, value: setting(next.key)}], future: future.slice(0, -1)});
  change({[next.key]: next.value});
}
