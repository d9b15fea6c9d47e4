// A patch painted on the skin: where a constraint acts, as a line of points and a radius.

import {state, update, newPatch} from "./store.js";
import {constraints, putConstraints} from "./constraints.js";
import {grown, kMostPoints, strokeAlong} from "./brush.js";

/** The region of constraint k as the panel shows it: a patch without a point is not in the case yet. */
export function shownRegion(one, k) {
  const {patch} = state;
  return patch.k === k && patch.isEmpty ? {patch: {path_mm: [], radius_mm: patch.radius_mm}} : one.where;
}

/** The patch that is being painted, {path_mm, radius_mm}; null: none is. */
export function paintedPatch() {
  const list = constraints(),
    {k} = state.patch;
  if (state.placing !== "patch" || !list || !list[k]) return null;
  return (shownRegion(list[k], k) || {}).patch || null;
}

/** Whether the 3D view shows the tissue at rest, where patches are. */
export function isAtRest() {
  return !state.stretch || state.scrub < 0.005;
}

/** Begins a new patch for constraint k. */
export function beginPatch(k) {
  update({patch: {...newPatch(), k, isEmpty: true}, placing: "patch", scrub: 0});
}

/** Paints on the patch of constraint k, or ends it. */
export function togglePainting(k) {
  const isOn = state.placing === "patch" && state.patch.k === k;
  if (isOn) return update({placing: null});
  const patch = state.patch.k === k ? state.patch : {...newPatch(), k};
  return update({patch, placing: "patch", scrub: 0});
}

/** Leaves the patch that was being painted: its constraint has another region, or another number. */
export function leavePatch() {
  update({patch: newPatch(), placing: null});
}

/** Stores the patch of constraint k; without a point it is kept here until it has one. */
export function putPatch(k, patch) {
  const isEmpty = !patch.path_mm.length,
    points = patch.path_mm.length;
  if (points > kMostPoints) return update({patch: {...state.patch, k, refused: points}});
  update({patch: {...state.patch, k, isEmpty, radius_mm: patch.radius_mm, refused: 0}});
  if (isEmpty) return undefined;
  const list = constraints();
  return putConstraints(list.with(k, {...list[k], where: {patch}}));
}

/** Adds a stroke to the patch of constraint k: the line goes on from its last point. */
export function paintPatch(k, patch, path) {
  putPatch(k, {...patch, path_mm: [...patch.path_mm, ...strokeAlong(path, patch.radius_mm)]});
}

/** Makes the radius of the patch that is being painted larger or smaller. */
export function growPatch(steps) {
  const patch = paintedPatch();
  putPatch(state.patch.k, {...patch, radius_mm: grown(patch.radius_mm, steps)});
}
