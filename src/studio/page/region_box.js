// The region box: where a new one lies, and how one is changed.

import {isSame, setting, update} from "./store.js";
import {put, putStep} from "./history.js";

const kPath = "ct.roi_box_mm";
const kLength = 70; // mm: what holds a tongue

/** The box [low, high], mm; null: the whole scan is searched. */
export function regionBox() {
  return setting(kPath);
}

/** A box about a point, to be dragged to where it should be; clipped to the scan. */
export function boxAbout(point, grid) {
  const ends = boundsOfGrid(grid);
  const spans = point.map((value, k) => spanAt(value, kLength, [ends[0][k], ends[1][k]]));
  return [0, 1].map((side) => spans.map((span) => span[side]));
}

// The box [low, high] about a grid's voxels, mm.
function boundsOfGrid({size, spacing_mm: spacing, origin_mm: origin, axes}) {
  const ends = origin.map((start, world) => {
    const reach = axes.map((axis, k) => [-0.5 * spacing[k] * axis[world], (size[k] - 0.5) * spacing[k] * axis[world]]);
    return [Math.min, Math.max].map((pick) => reach.reduce((sum, pair) => sum + pick(...pair), start));
  });
  return [0, 1].map((side) => ends.map((pair) => pair[side]));
}

// An interval of whole numbers about a value, so long and clipped to [low, high].
function spanAt(value, length, [low, high]) {
  const ends = [Math.round(value - length / 2), Math.round(value + length / 2)];
  return [Math.max(Math.ceil(low), ends[0]) + 0, Math.min(Math.floor(high), ends[1]) + 0]; // no -0
}

/** Sets the box, or removes it with null. */
export function putBox(box) {
  put(kPath, box);
}

/** Sets a box whose numbers are stepped. */
export function stepBox(box) {
  putStep(kPath, box);
}

/** Shows the box while one of its faces is dragged; the case keeps its own. With null it is shown again. */
export function showBox(box) {
  update({preview: box ? {[kPath]: box} : {}});
}

/** Sets the box to where a face was dragged. */
export function dropBox(box) {
  if (!isSame(box, regionBox())) putBox(box);
}
