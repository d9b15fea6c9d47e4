// The brush's strokes: tissue that is painted or taken away in the slices, kept in the case as `ct.edits`.

import {state, update, setting, isFresh, isSame} from "./store.js";
import {put, redo, undo} from "./history.js";
import {clamp, length, minus, thinned} from "./geometry.js";

const kPath = "ct.edits";
const kRadii = [0.1, 50]; // mm: what a case takes
const kFactor = 1.2; // from one radius to the next, by a key

/** Points of all strokes together, or of one painted line: more would be a large request at every change. */
export const kMostPoints = 2000;

/** The strokes of the case, in their order: [{tissue, radius_mm, path_mm}]. */
export function strokes() {
  return setting(kPath) || [];
}

/** What the chosen brush does, {tissue, radius_mm}; null: no brush is chosen. */
export function brush() {
  const tissue = {"brush-add": true, "brush-take": false}[state.placing];
  return tissue === undefined ? null : {tissue, radius_mm: state.brush.radius_mm};
}

/** Points of a stroke along a path, mm: about half a radius apart, to a hundredth of a millimetre. */
export function strokeAlong(path, radius) {
  const kept = thinned(path, 0.5 * radius),
    last = path.at(-1);
  const points = length(minus(last, kept.at(-1))) > 0 ? [...kept, last] : kept;
  return points.map((point) => point.map((value) => Number(value.toFixed(2))));
}

/** The length of a stroke's path, mm. */
export function lengthOf(path) {
  return path.slice(1).reduce((sum, point, k) => sum + length(minus(point, path[k])), 0);
}

/** Adds a stroke along a path, mm. */
export function addStroke({tissue, radius_mm}, path) {
  const list = [...strokes(), {tissue, radius_mm, path_mm: strokeAlong(path, radius_mm)}];
  const points = list.reduce((sum, stroke) => sum + stroke.path_mm.length, 0);
  if (points > kMostPoints) return update({brush: {...state.brush, refused: points}});
  return putStrokes(list);
}

/** Removes stroke k. */
export function removeStroke(k) {
  putStrokes(strokes().toSpliced(k, 1));
}

/** Removes all strokes. */
export function removeStrokes() {
  putStrokes([]);
}

function putStrokes(list) {
  put(kPath, list.length ? list : null);
}

let last = null; // the tissue that came last: its skin, the strokes in it, and all else that it was found by

/** Takes new tissue: strokes that were added since the last one and have changed nothing are idle. */
export function noteTissue() {
  if (!isFresh("tissue")) return;
  const {file, inputs, settings} = state.case,
    {edits, ...ct} = settings.ct;
  const now = {skin: state.tissue.skin, strokes: edits || [], others: {file, inputs, ct}};
  const isIdle = last && isOnlyStroked(last, now) && isSameSkin(last.skin, now.skin);
  last = now;
  update({brush: {...state.brush, idle: isIdle ? (now.strokes.at(-1).tissue ? "add" : "take") : null}});
}

function isOnlyStroked(before, now) {
  const count = before.strokes.length;
  if (now.strokes.length <= count || !isSame(now.others, before.others)) return false;
  return isSame(now.strokes.slice(0, count), before.strokes);
}

function isSameSkin({vertices: a}, {vertices: b}) {
  return a.length === b.length && a.every((value, i) => value === b[i]);
}

/** Sets the brush's radius, mm. */
export function setRadius(radius) {
  update({brush: {...state.brush, radius_mm: clamp(Number(radius.toFixed(2)), ...kRadii)}});
}

/** Makes the brush larger or smaller by so many steps. */
export function growBrush(steps) {
  setRadius(grown(state.brush.radius_mm, steps));
}

/** A radius, mm, made larger or smaller by so many steps; within what a case takes. */
export function grown(radius, steps) {
  const tenths = Math.round(10 * radius),
    wanted = Math.round(tenths * kFactor ** steps);
  return clamp((wanted === tenths ? tenths + Math.sign(steps) : wanted) / 10, ...kRadii);
}

/** Takes a key that belongs to the brush wherever the focus is, except where one types. @returns whether it did */
export function takeKey({key, ctrlKey, metaKey, shiftKey, target}) {
  if (target.matches("input:not([type=checkbox], [type=range]), select")) return false;
  const isCommand = ctrlKey || metaKey,
    letter = key.toLowerCase();
  if (key === "[") growBrush(-1);
  else if (key === "]") growBrush(1);
  else if (isCommand && letter === "z" && !shiftKey) undo();
  else if (isCommand && (letter === "y" || letter === "z")) redo();
  else return false;
  return true;
}
