// Points, grids and curves. Coordinates are LPS, mm; a point is [x, y, z].

export {roundedDown} from "./viewer.js";

export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const plus = (a, b, factor = 1) => [a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const length = (a) => Math.hypot(a[0], a[1], a[2]);
export const unit = (a) => plus([0, 0, 0], a, 1 / length(a));
export const clamp = (value, least, most) => Math.max(least, Math.min(most, value));

/** The anatomical directions in LPS, by the words that settings use. */
export const kDirections = {
  left: [1, 0, 0],
  right: [-1, 0, 0],
  posterior: [0, 1, 0],
  anterior: [0, -1, 0],
  superior: [0, 0, 1],
  inferior: [0, 0, -1],
};

/** A direction of a setting (a word or three numbers) as a unit vector; `otherwise` where there is none. */
export function directionOf(value, otherwise) {
  if (Array.isArray(value) && length(value) > 0) return unit(value);
  return kDirections[value] || otherwise;
}

/** The letter of the anatomical direction nearest to a vector: one of L R P A S I. */
export function letterOf(vector) {
  const word = Object.keys(kDirections).reduce((best, name) =>
    dot(kDirections[name], vector) > dot(kDirections[best], vector) ? name : best,
  );
  return word.charAt(0).toUpperCase();
}

// Radiological: the patient's left on the picture's right; anterior on top, or on the left of a sagittal picture.
const kPictures = {
  axial: {right: [1, 0, 0], down: [0, 1, 0], through: [0, 0, 1], axes: [0, 1, 2]},
  coronal: {right: [1, 0, 0], down: [0, 0, -1], through: [0, 1, 0], axes: [0, 2, 1]},
  sagittal: {right: [0, 1, 0], down: [0, 0, -1], through: [1, 0, 0], axes: [1, 2, 0]},
};

/** The names of the three pictures. */
export const kPlanes = Object.keys(kPictures);

const kOrders = [
  [0, 1, 2],
  [0, 2, 1],
  [1, 0, 2],
  [1, 2, 0],
  [2, 0, 1],
  [2, 1, 0],
];

/** Which index axis runs nearest to x, y and z. */
function nearestAxes(axes) {
  const fit = (order) => order.reduce((sum, axis, world) => sum + Math.abs(axes[axis][world]), 0);
  return kOrders.reduce((best, order) => (fit(order) > fit(best) + 1e-9 ? order : best));
}

/** How one picture lies in a grid. Pixel centres are at whole columns and rows, slices at whole numbers. */
export class Plane {
  /** @param grid  {size, spacing_mm, origin_mm, axes}   @param name  "axial", "coronal" or "sagittal" */
  constructor(grid, name) {
    const picture = kPictures[name],
      nearest = nearestAxes(grid.axes);
    this.grid = grid;
    this.name = name;
    this.index = picture.axes.map((world) => nearest[world]);
    const wanted = [picture.right, picture.down, picture.through];
    this.signs = this.index.map((axis, k) => (dot(grid.axes[axis], wanted[k]) < 0 ? -1 : 1));
    [this.columns, this.rows, this.slices] = this.index.map((axis) => grid.size[axis]);
    this.step = this.index.map((axis) => grid.spacing_mm[axis]);
    [this.right, this.down, this.through] = this.index.map((axis, k) =>
      plus([0, 0, 0], grid.axes[axis], this.signs[k]),
    );
  }

  /** [column, row, slice] of a point, mm; fractions between centres. */
  toPixel(point) {
    const from = minus(point, this.grid.origin_mm);
    return this.index.map((axis, k) => {
      const at = dot(from, this.grid.axes[axis]) / this.grid.spacing_mm[axis];
      return this.signs[k] > 0 ? at : this.grid.size[axis] - 1 - at;
    });
  }

  /** The point, mm, of a column, row and slice. */
  toPoint(pixel) {
    return this.index.reduce((point, axis, k) => {
      const at = this.signs[k] > 0 ? pixel[k] : this.grid.size[axis] - 1 - pixel[k];
      return plus(point, this.grid.axes[axis], at * this.grid.spacing_mm[axis]);
    }, this.grid.origin_mm);
  }

  /** Where a slice's voxels lie in the array: the first one, and the steps from column to column and row to row. */
  strides(slice) {
    const size = this.grid.size,
      step = [1, size[0], size[0] * size[1]];
    const along = this.index.map((axis, k) => this.signs[k] * step[axis]);
    const corner = this.index.map((axis, k) => (this.signs[k] > 0 ? 0 : (size[axis] - 1) * step[axis]));
    return {first: corner[0] + corner[1] + corner[2] + slice * along[2], column: along[0], row: along[1]};
  }
}

/** The middle of a grid, mm. */
export function middleOf(grid) {
  return grid.axes.reduce(
    (point, axis, k) => plus(point, axis, 0.5 * (grid.size[k] - 1) * grid.spacing_mm[k]),
    grid.origin_mm,
  );
}

/** The mean of points. */
export function meanOf(points) {
  return [0, 1, 2].map((k) => points.reduce((sum, point) => sum + point[k], 0) / points.length);
}

/** The number of a voxel at a point, or -1 outside the grid. */
export function voxelAt(grid, point) {
  const from = minus(point, grid.origin_mm);
  const at = grid.axes.map((axis, k) => Math.round(dot(from, axis) / grid.spacing_mm[k]));
  const isInside = at.every((index, k) => index >= 0 && index < grid.size[k]);
  return isInside ? at[0] + grid.size[0] * (at[1] + grid.size[1] * at[2]) : -1;
}

/** The polygon that a box [low, high] cuts out of a plane through `at`; each corner has `face`, the face on which the
 *  edge that begins there lies (2 * axis + (0 low, 1 high)), or -1. Empty where the plane misses the box. */
export function boxOutline(box, at, right, down) {
  const far = 4 * length(minus(box[1], box[0])) + length(minus(box[0], at));
  const corner = (a, b) => ({point: plus(plus(at, right, a * far), down, b * far), face: -1});
  let outline = [corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)];
  for (let face = 0; face < 6; ++face) outline = clipped(outline, face, box[face & 1][face >> 1]);
  return outline;
}

function clipped(outline, face, limit) {
  const axis = face >> 1,
    sign = face & 1 ? -1 : 1;
  const depth = (corner) => sign * (corner.point[axis] - limit);
  const kept = [];
  outline.forEach((from, k) => {
    const to = outline[(k + 1) % outline.length];
    const a = depth(from),
      b = depth(to);
    if (a >= 0) kept.push(from);
    if (a >= 0 !== b >= 0) {
      const point = plus(from.point, minus(to.point, from.point), a / (a - b));
      kept.push({point, face: a >= 0 ? face : from.face});
    }
  });
  return kept;
}

/** Points on a smooth closed curve (centripetal Catmull-Rom) through control points, about `step` mm apart. */
export function smoothLoop(points, step) {
  return points.length < 3 ? points : points.flatMap((_, k) => smoothSide(points, k, step));
}

/** Those of its side from point k up to the next, which is left out. */
export function smoothSide(points, k, step) {
  const at = (place) => points[(place + points.length) % points.length];
  const parts = clamp(Math.round(length(minus(at(k + 1), at(k))) / step), 1, 60);
  return Array.from({length: parts}, (_, part) => between(at(k - 1), at(k), at(k + 1), at(k + 2), part / parts));
}

function between(a, b, c, d, share) {
  const knot = (p, q) => Math.max(1e-6, Math.sqrt(length(minus(q, p))));
  const t1 = knot(a, b),
    t2 = t1 + knot(b, c),
    t3 = t2 + knot(c, d);
  const t = t1 + share * (t2 - t1);
  const mix = (p, q, from, to) => plus(p, minus(q, p), (t - from) / (to - from));
  const ab = mix(a, b, 0, t1),
    bc = mix(b, c, t1, t2),
    cd = mix(c, d, t2, t3);
  return mix(mix(ab, bc, 0, t2), mix(bc, cd, t1, t3), t1, t2);
}

/** Points of a line more than `least` mm from the one kept before. */
export function thinned(points, least) {
  const kept = [];
  for (const point of points) if (!kept.length || length(minus(point, kept.at(-1))) > least) kept.push(point);
  return kept;
}

/** Those points of a line that keep it within `most` mm of what it was; its ends stay. */
export function simplified(points, most) {
  if (points.length < 3) return points;
  const last = points.at(-1),
    away = points.map((point) => distanceToLine(point, points[0], last)),
    far = away.indexOf(Math.max(...away));
  if (away[far] <= most) return [points[0], last];
  return [...simplified(points.slice(0, far + 1), most), ...simplified(points.slice(far), most).slice(1)];
}

function distanceToLine(point, from, to) {
  const along = minus(to, from),
    whole = dot(along, along);
  const share = whole > 0 ? clamp(dot(minus(point, from), along) / whole, 0, 1) : 0;
  return length(minus(point, plus(from, along, share)));
}

/** [least, greatest] distance from a point along a direction within a box [low, high]; null where it misses the box. */
export function spanInBox(box, point, direction) {
  const span = [-Infinity, Infinity];
  direction.forEach((part, axis) => {
    const slope = Math.abs(part) < 1e-9 ? 1e-9 : part; // along a face: in the box all the way, or never
    const ends = box.map((corner) => (corner[axis] - point[axis]) / slope);
    span[0] = Math.max(span[0], Math.min(...ends));
    span[1] = Math.min(span[1], Math.max(...ends));
  });
  return span[0] <= span[1] ? span : null;
}

/** Points on a line of points, at most `step` mm apart. */
export function filled(points, step) {
  return points.flatMap((from, k) => {
    const along = minus(points[k + 1] || from, from),
      parts = Math.max(1, Math.ceil(length(along) / step));
    return Array.from({length: parts}, (_, part) => plus(from, along, part / parts));
  });
}

/** A list of points from what the server calls a curve: [[x, y, z]], or an object with `points_mm`. */
export function pointsOf(curve) {
  if (!curve) return [];
  return Array.isArray(curve) ? curve : curve.points_mm || [];
}

/** The picture's axes for someone who looks along `approach`, as in the report: right, up, towards the observer. */
export function viewAlong(approach) {
  const towards = plus([0, 0, 0], unit(approach), -1);
  const flat = (axis) => unit(plus(axis, towards, -dot(axis, towards)));
  if (Math.abs(towards[0]) < 0.9) {
    const right = flat([1, 0, 0]);
    return {right, up: cross(towards, right), towards};
  }
  const up = flat([0, 1, 0]);
  return {right: cross(up, towards), up, towards};
}
