// Drawing the tumour's edge on the skin: points that are clicked, dragged and removed, or an ellipse laid on it.

import {dot, length, minus, plus, smoothLoop, viewAlong} from "./geometry.js";

const kReach = 13; // px
const kCurveStep = 0.6; // mm
const kEllipsePoints = 24;

/** An edge with its curve: smooth and closed, or straight and open; each of its points lies on the skin. */
export function withCurve(edge, query) {
  const raw = edge.isClosed ? smoothLoop(edge.points, kCurveStep) : edge.points;
  return {...edge, curve: query ? raw.map((point) => query.nearest(point)) : raw};
}

/** Points of an ellipse laid on the skin along the approach; null where one of them misses the skin.
 *  @param diameters_mm  along the picture's right and up, before the turn (degrees, counter-clockwise as seen) */
export function ellipseOnSkin(query, centre, approach, diameters_mm, turn_deg) {
  const {right, up} = viewAlong(approach),
    turn = (turn_deg * Math.PI) / 180;
  const points = Array.from({length: kEllipsePoints}, (_, k) => {
    const angle = (2 * Math.PI * k) / kEllipsePoints;
    const a = 0.5 * diameters_mm[0] * Math.cos(angle),
      b = 0.5 * diameters_mm[1] * Math.sin(angle);
    const x = a * Math.cos(turn) - b * Math.sin(turn),
      y = a * Math.sin(turn) + b * Math.cos(turn);
    return query.along(plus(plus(centre, right, x), up, y), approach);
  });
  return points.includes(null) ? null : points;
}

/** Where in a closed list of points a new one goes: after the end of the nearest side that begins first. */
export function sideNearest(points, point) {
  const off = points.map((from, k) => {
    const along = minus(points[(k + 1) % points.length], from),
      to = minus(point, from);
    const share = Math.max(0, Math.min(1, dot(to, along) / Math.max(1e-9, dot(along, along))));
    return length(minus(to, plus([0, 0, 0], along, share)));
  });
  return off.indexOf(Math.min(...off)) + 1;
}

/** The 3D view's tool for the edge; a drag that is broken off puts its point back. `get()` gives the edge, `set(edge)`
 *  takes it, `query()` gives the skin, or null, `onEllipse(point)` places one. */
export class EdgeTool {
  constructor(scene, {get, set, query, onEllipse}) {
    Object.assign(this, {scene, get, set, query, onEllipse, held: -1, hasMoved: false});
    Object.assign(this, {before: null, dragged: null}); // the edge before a drag, and its points as the drag left them
  }

  /** Number of the point under the pointer, the nearest to the observer first; -1: none. */
  pointAt({offsetX, offsetY}) {
    const towards = this.scene.axes().towards.toArray();
    let best = -1;
    const points = this.get().points;
    points.forEach((point, k) => {
      const [x, y] = this.scene.toScreen(point);
      if (Math.hypot(x - offsetX, y - offsetY) > kReach) return;
      if (best < 0 || dot(point, towards) > dot(points[best], towards)) best = k;
    });
    return best;
  }

  press(event) {
    if (this.get().mode !== "draw") return false;
    this.held = this.pointAt(event);
    this.hasMoved = false;
    this.before = this.get();
    if (this.held >= 0) this.set({...this.get(), selected: this.held});
    return this.held >= 0;
  }

  drag(event) {
    const hit = this.hit(event);
    if (!hit) return;
    this.hasMoved = true;
    this.put(this.held, hit);
    this.dragged = this.get().points;
  }

  drop() {
    const edge = this.get();
    if (this.held === 0 && !this.hasMoved && !edge.isClosed) this.close();
    this.held = -1;
  }

  /** Puts the point that is dragged back, unless the edge has become another meanwhile. */
  cancel() {
    const edge = this.get(),
      {points, curve, isSaved} = this.before;
    if (this.hasMoved && edge.points === this.dragged) this.set({...edge, points, curve, isSaved});
    Object.assign(this, {held: -1, hasMoved: false});
  }

  click(event) {
    const hit = this.hit(event),
      mode = this.get().mode;
    if (!hit) return;
    if (mode === "draw") this.add(hit);
    if (mode === "ellipse") this.onEllipse(hit);
  }

  hit(event) {
    const query = this.query();
    return query ? query.first(this.scene.rayAt(event.offsetX, event.offsetY)) : null;
  }

  /** Adds a point: at the end of an open edge, into the nearest side of a closed one. */
  add(point) {
    const edge = this.get(),
      at = edge.isClosed ? sideNearest(edge.points, point) : edge.points.length;
    this.changed({points: edge.points.toSpliced(at, 0, point), selected: at});
  }

  /** Moves point k onto the skin's point nearest to a place. */
  put(k, point) {
    const query = this.query();
    this.changed({points: this.get().points.with(k, query ? query.nearest(point) : point), selected: k});
  }

  remove(k) {
    const edge = this.get();
    if (!edge.points[k]) return;
    const points = edge.points.toSpliced(k, 1);
    this.changed({points, selected: Math.min(k, points.length - 1), isClosed: edge.isClosed && points.length > 2});
  }

  close() {
    if (this.get().points.length > 2) this.changed({isClosed: true});
  }

  changed(patch) {
    this.set(withCurve({...this.get(), ...patch, isSaved: false}, this.query()));
  }

  key(event) {
    const edge = this.get();
    if (edge.mode === "look") return false;
    if (event.key === "Delete" || event.key === "Backspace") this.remove(edge.selected);
    else if (event.key === "Enter" && !edge.isClosed) this.close();
    else if (event.key === "Escape") this.set({...edge, mode: "look"});
    else return false;
    return true;
  }
}
