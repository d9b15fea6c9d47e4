// The brush's strokes: tissue that is painted or taken away in the slices, kept in the case as `ct.edits`.

import {state, update, setting, isFresh, isSame} from "./store.js";
import {put, redo, undo} from "./history.js";
import {regionBox} from "./region_box.js";
import {clamp, length, minus, plus, simplified, spanInBox, thinned} from "./geometry.js";

const kPath = "ct.edits";
const kRadii = [0.1, 50]; // mm: what a case takes
const kFactor = 1.2; // from one radius to the next, by a key

/** Points of all strokes together, or of one painted line: more would be a large request at every change. */
export const kMostPoints = 2000;

/** The strokes of the case, in their order: [{tissue, radius_mm, path_mm}]. */
export function strokes() {
  return setting(kPath) || [];
}

/** What the chosen brush does, {tissue, radius_mm, through_mm}; null: no brush is chosen. */
export function brush() {
  const tissue = {"brush-add": true, "brush-take": false}[state.placing];
  const {radius_mm, through_mm} = state.brush;
  return tissue === undefined ? null : {tissue, radius_mm, through_mm};
}

/** Points of a stroke along a path, mm: about half a radius apart, to a hundredth of a millimetre. */
export function strokeAlong(path, radius) {
  return thinnedToEnd(path, 0.5 * radius).map(rounded);
}

function thinnedToEnd(path, least) {
  const kept = thinned(path, least),
    last = path.at(-1);
  return length(minus(last, kept.at(-1))) > 0 ? [...kept, last] : kept;
}

function rounded(point) {
  return point.map((value) => Number(value.toFixed(2)));
}

/** Points of a stroke that goes through the slices as well: along the path, there and back, at offsets along the
 *  slices' normal that are at most a radius apart. A region box limits the offsets: beyond it nothing is changed. */
export function strokeThrough(path, {radius_mm: radius, through_mm: through}, normal) {
  const line = simplified(thinnedToEnd(path, radius / 3), 0.1 * radius),
    [from, to] = spanThrough(path, 0.5 * through, normal),
    steps = Math.max(1, Math.ceil((to - from) / radius));
  const pass = (k) => (k % 2 ? line.toReversed() : line),
    offset = (k) => from + ((to - from) * k) / steps;
  const passes = Array.from({length: steps + 1}, (_, k) => pass(k).map((point) => plus(point, normal, offset(k))));
  return passes.flat().map(rounded);
}

// [least, greatest] offset, mm: as far as any point of the path stays in the region box.
function spanThrough(path, half, normal) {
  const box = regionBox(),
    spans = box ? path.map((point) => spanInBox(box, point, normal)).filter(Boolean) : [[-half, half]];
  const from = Math.max(-half, Math.min(...spans.map(([low]) => low))),
    to = Math.min(half, Math.max(...spans.map(([, high]) => high)));
  return from < to ? [from, to] : [0, 0];
}

/** The length of a stroke's path, mm. */
export function lengthOf(path) {
  return path.slice(1).reduce((sum, point, k) => sum + length(minus(point, path[k])), 0);
}

/** Adds a stroke along a path, mm. @param normal  of the slice that it was drawn in, through which it may go */
export function addStroke(one, path, normal = null) {
  const {tissue, radius_mm, through_mm} = one,
    passes = through_mm / radius_mm;
  if (normal && passes > kMostPoints) return update({brush: {...state.brush, refused: Math.ceil(passes)}});
  const path_mm = normal && through_mm > 0 ? strokeThrough(path, one, normal) : strokeAlong(path, radius_mm);
  const list = [...strokes(), {tissue, radius_mm, path_mm}];
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

/** Sets how far a stroke goes through the slices, mm: as far as the input takes. */
export function setThrough(through) {
  update({brush: {...state.brush, through_mm: Number(through.toFixed(2))}});
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
