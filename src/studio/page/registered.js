// A registration as the 3D view shows it: the cloud laid over the simulated surface, in the simulation's coordinates.

import {roundedDown} from "./geometry.js";

let memo = {result: null};

/** {cloud, sample: Float32Array, residuals_mm, edge, marked, hasUnseen, top_mm}; `edge`: the case's tumour edge,
 *  `marked`: the one that is marked on the tissue, points or null; `top_mm`: the end of the colours on both sides. The
 *  same object for as long as the result is the same; null where there is no pose. */
export function registeredView(result) {
  if (!result || !result.sample) return null;
  if (memo.result !== result) memo = {result, view: makeView(result)};
  return memo.view;
}

function makeView({registration, target, sample, edges}) {
  const pose = registration.T_target_source;
  return {
    cloud: movedBack(target.points, pose),
    sample: movedBack(sample.points, pose),
    residuals_mm: sample.residuals_mm,
    ...edgesOf(edges, pose),
    hasUnseen: sample.residuals_mm.some(Number.isNaN),
    top_mm: topOf(sample.residuals_mm),
  };
}

function edgesOf(edges, pose) {
  const points = (list) => {
    if (!list || !list.length) return null;
    const flat = movedBack(new Float32Array(list.flat()), pose);
    return list.map((_, k) => [...flat.slice(3 * k, 3 * k + 3)]);
  };
  return {edge: points(edges && edges.simulated_mm), marked: points(edges && edges.marked_mm)};
}

/** Points moved by the inverse of a similarity transform. @param pose  4 rows of 4 */
function movedBack(points, pose) {
  const square = pose[0][0] ** 2 + pose[1][0] ** 2 + pose[2][0] ** 2; // of the scale
  const moved = new Float32Array(points.length);
  for (let i = 0; i < points.length; i += 3) {
    const from = [0, 1, 2].map((k) => points[i + k] - pose[k][3]);
    for (let k = 0; k < 3; ++k)
      moved[i + k] = (pose[0][k] * from[0] + pose[1][k] * from[1] + pose[2][k] * from[2]) / square;
  }
  return moved;
}

/** A point moved by a transform of 4 rows of 4. */
export function moved(point, pose) {
  return pose.slice(0, 3).map((row) => row[0] * point[0] + row[1] * point[1] + row[2] * point[2] + row[3]);
}

// Nineteen of twenty residuals lie below it; a round number, so that the legend can be read.
function topOf(residuals) {
  const sorted = residuals
    .filter((value) => !Number.isNaN(value))
    .map(Math.abs)
    .sort();
  const most = Math.max(0.05, sorted[Math.floor(0.95 * (sorted.length - 1))] || 0);
  const step = roundedDown(most) / 2;
  return Number((Math.ceil(most / step - 1e-9) * step).toPrecision(3));
}
