// How a photograph is to be measured: its scale and the lines drawn by hand, as the page holds and the call takes them.
// A point of a photograph is [u, v], px, from the middle of its upper left pixel to the right and down.

import {smoothSide} from "./geometry.js";
import {isNumber} from "./words.js";

const kCurveStep = 3; // px, of a line drawn by hand
const kMostHandles = 40; // of a line that was found

/** The ways to find the scale: [word, label, number of points to click, hint]. */
export const kScales = [
  ["mm_per_pixel", "mm per pixel", 0, "Known from the camera."],
  ["two_points", "two points and their distance", 2, "Click two points whose distance is known."],
  ["ticks", "a ruler's ticks", 0, "The ruler is found in the photograph."],
  ["bar", "a scale bar", 0, "The bar is found in the photograph."],
  [
    "rectangle",
    "a rectangle's corners",
    4,
    "Click the corners, the lower left first, then counter-clockwise. The contours are corrected for perspective.",
  ],
];

/** How many points the chosen way needs. */
export function scalePointCount({scale}) {
  return kScales.find(([how]) => how === scale.how)[2];
}

/** The argument `scale` of the call `photograph`, or null while something is missing. */
export function scaleArgument({scale}) {
  const {how, points, ruler_mm, distance_mm, size_mm} = scale;
  const rulerOf = (ruler) => ({ruler, ...(isNumber(ruler_mm) ? {ruler_mm} : {})});
  if (how === "mm_per_pixel") return isNumber(scale.mm_per_pixel) ? {mm_per_pixel: scale.mm_per_pixel} : null;
  if (how === "ticks") return rulerOf("ticks");
  if (how === "bar") return isNumber(ruler_mm) ? rulerOf("bar") : null;
  if (how === "two_points")
    return points.length === 2 && isNumber(distance_mm) ? {two_points: [...points.flat(), distance_mm]} : null;
  return points.length === 4 && size_mm ? {rectangle: points.flat(), rectangle_mm: size_mm} : null;
}

/** All arguments of the call `photograph`. */
export function argumentsOf(photo) {
  const {incision, tumor_edge: edge} = photo.hand;
  return {
    file: photo.file.id,
    scale: scaleArgument(photo),
    red: photo.red,
    ...(isNumber(photo.max_gap_mm) ? {max_gap_mm: photo.max_gap_mm} : {}),
    ...(incision ? {incision_px: curveOf(incision), incision_closed: incision.isClosed} : {}),
    ...(edge ? {tumor_edge_px: curveOf(edge)} : {}),
  };
}

/** Whether the lines drawn by hand can be measured. */
export function isHandComplete({hand}) {
  const {incision, tumor_edge: edge} = hand;
  return (!incision || incision.points.length > 2) && (!edge || (edge.points.length > 2 && edge.isClosed));
}

// --- Lines drawn by hand. ---
//
// A line is {points, sides, isClosed}. Its points are the handles; side k leads from point k to the next: the points
// between that were found, or null for one that a person drew or moved an end of.

/** A line without points. */
export function emptyLine() {
  return {points: [], sides: [], isClosed: false};
}

/** All points of a line: as found where nothing was changed, else smooth on a closed line, straight on an open one. */
export function curveOf({points, sides, isClosed}) {
  if (points.length < 3) return points;
  const flat = points.map(([u, v]) => [u, v, 0]);
  const drawn = (k) => (isClosed ? smoothSide(flat, k, kCurveStep).map(([u, v]) => [u, v]) : [points[k]]);
  const ends = isClosed ? points : points.slice(0, -1);
  const curve = ends.flatMap((point, k) => (sides[k] ? [point, ...sides[k]] : drawn(k)));
  return isClosed ? curve : [...curve, points.at(-1)];
}

/** A line through many points, with few handles. */
export function withHandles(points, isClosed) {
  for (let tolerance = 1; ; tolerance *= 1.25) {
    const kept = isClosed ? thinnedRing(points, tolerance) : thinned(points, 0, points.length - 1, tolerance);
    if (kept.length > kMostHandles) continue;
    const handles = isClosed ? kept.slice(0, -1) : kept;
    const sides = handles.map((from, k) => (k + 1 < kept.length ? points.slice(from + 1, kept[k + 1]) : null));
    return {points: handles.map((k) => tenths(points[k])), sides, isClosed};
  }
}

/** A line with point k elsewhere. */
export function withMoved(line, k, point) {
  const before = (k - 1 + line.points.length) % line.points.length;
  const sides = line.sides.map((side, at) => (at === k || at === before ? null : side));
  return {...line, points: line.points.with(k, point), sides};
}

/** A line with a new point k. */
export function withAdded(line, k, point) {
  const sides = k > 0 ? line.sides.toSpliced(k - 1, 1, null, null) : [null, ...line.sides];
  return {...line, points: line.points.toSpliced(k, 0, point), sides};
}

/** A line without point k, closed only while it has three. */
export function withRemoved(line, k) {
  const points = line.points.toSpliced(k, 1);
  const sides =
    k > 0 ? line.sides.toSpliced(k - 1, 2, null) : [...line.sides.slice(1, -1), null].slice(0, points.length);
  return {points, sides, isClosed: line.isClosed && points.length > 2};
}

/** A point to a tenth of a pixel. */
export function tenths(point) {
  return point.map((value) => Math.round(10 * value) / 10);
}

// In two halves, between the first point and the one farthest from it, because a ring has no ends. The first point is
// there once more at the end.
function thinnedRing(points, tolerance) {
  const away = points.map((point) => distance(point, points[0]));
  const far = away.indexOf(Math.max(...away));
  return [...thinned(points, 0, far, tolerance), ...thinned(points, far, points.length, tolerance).slice(1)];
}

// Douglas and Peucker: numbers of the points that stay, because the line would otherwise be off by more than the
// tolerance, px.
function thinned(points, first, last, tolerance) {
  const [from, to] = [points[first], points[last % points.length]];
  let worst = first,
    most = tolerance;
  for (let k = first + 1; k < last; ++k) {
    const off = offLine(points[k], from, to);
    if (off > most) [worst, most] = [k, off];
  }
  if (worst === first) return [first, last];
  return [...thinned(points, first, worst, tolerance).slice(0, -1), ...thinned(points, worst, last, tolerance)];
}

function offLine(point, from, to) {
  const along = [to[0] - from[0], to[1] - from[1]],
    square = along[0] ** 2 + along[1] ** 2;
  const share = square ? ((point[0] - from[0]) * along[0] + (point[1] - from[1]) * along[1]) / square : 0;
  const inside = Math.max(0, Math.min(1, share));
  return distance(point, [from[0] + inside * along[0], from[1] + inside * along[1]]);
}

function distance(a, b) {
  return Math.hypot(a[0] - b[0], a[1] - b[1]);
}

/** Where a new handle goes: into the nearest side of a closed line, at the end of an open one. */
export function placeForHandle({points, isClosed}, point) {
  if (!isClosed || points.length < 3) return points.length;
  const off = points.map((from, k) => offLine(point, from, points[(k + 1) % points.length]));
  return off.indexOf(Math.min(...off)) + 1;
}

/** The point at a share of a line's length. */
export function pointAt(points, isClosed, share) {
  const line = isClosed ? [...points, points[0]] : points;
  const steps = line.slice(1).map((point, k) => distance(line[k], point));
  let left = share * steps.reduce((sum, step) => sum + step, 0);
  for (let k = 0; k < steps.length; ++k) {
    if (left <= steps[k] && steps[k] > 0) {
      const part = left / steps[k];
      return [0, 1].map((axis) => line[k][axis] + part * (line[k + 1][axis] - line[k][axis]));
    }
    left -= steps[k];
  }
  return line.at(-1);
}
