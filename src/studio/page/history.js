// What was changed by hand in step See, strokes of the brush and the region box: it can be undone, and made again.

import {state, update, given} from "./store.js";
import {change, changeSoon, isWaiting} from "./actions.js";

const kMostSteps = 100;
const kStrokes = "ct.edits";

let stepped = null; // the setting whose steps go on

/** Sets a setting so that it can be undone. */
export function put(key, value) {
  remember(key);
  change({[key]: value});
}

/** The same for a value that is stepped: steps that are sent together are undone together. */
export function putStep(key, value) {
  if (stepped !== key || !isWaiting(key)) remember(key);
  stepped = key;
  changeSoon({[key]: value});
}

function remember(key) {
  const past = [...state.history.past, {key, value: given(key)}].slice(-kMostSteps);
  turnTo({past, future: []});
}

// The message about the last stroke no longer applies, and a step from here on is undone by itself.
function turnTo(history) {
  stepped = null;
  update({history, brush: {...state.brush, refused: 0, idle: null}});
}

/** What an undo brings back, {key, value}, or null. Strokes from before the page was opened go one by one. */
export function lastChange() {
  const {past} = state.history,
    strokes = given(kStrokes) || [];
  if (past.length) return past.at(-1);
  return strokes.length ? {key: kStrokes, value: strokes.length > 1 ? strokes.slice(0, -1) : null} : null;
}

/** Takes the last change back. */
export function undo() {
  const last = lastChange(),
    {past, future} = state.history;
  if (!last) return;
  turnTo({past: past.slice(0, -1), future: [...future, {key: last.key, value: given(last.key)}]});
  change({[last.key]: last.value});
}

/** Makes the change that was undone last again. */
export function redo() {
  const {past, future} = state.history,
    next = future.at(-1);
  if (!next) return;
  turnTo({past: [...past, {key: next.key, value: given(next.key)}], future: future.slice(0, -1)});
  change({[next.key]: next.value});
}
