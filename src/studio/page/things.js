// What the 3D view is made of: skins, curves, points, planes. Lengths in mm, LPS.

import * as THREE from "three";
import {minus, plus, length} from "./geometry.js";
import {holds, ink} from "./colours.js";

/** A skin. @param look  {colour, opacity, colours: Float32Array of linear RGB per vertex} */
export function skinMesh(skin, look) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(skin.vertices, 3));
  geometry.setIndex(new THREE.BufferAttribute(skin.triangles, 1));
  if (look.colours) geometry.setAttribute("color", new THREE.BufferAttribute(look.colours, 3));
  geometry.computeVertexNormals();
  const isClear = look.opacity < 1;
  const material = new THREE.MeshLambertMaterial({
    color: look.colours ? 0xffffff : look.colour,
    vertexColors: Boolean(look.colours),
    side: THREE.DoubleSide,
    transparent: isClear,
    opacity: isClear ? look.opacity : 1,
    depthWrite: !isClear,
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
  });
  const mesh = new THREE.Mesh(geometry, material);
  mesh.frustumCulled = false;
  return mesh;
}

/** Moves a skin's vertices to `share` of the way from rest to stretched. */
export function blend(mesh, rest, stretched, share) {
  if (!mesh.userData.hasOwnPlaces) {
    // The array that it was made with is the body's: it must not be written to.
    mesh.geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(rest.length), 3));
    mesh.userData.hasOwnPlaces = true;
  }
  const to = mesh.geometry.getAttribute("position");
  for (let i = 0; i < rest.length; ++i) to.array[i] = rest[i] + share * (stretched[i] - rest[i]);
  to.needsUpdate = true;
  mesh.geometry.computeVertexNormals();
}

/** Colours of a body's vertices: bit c of `held` is set where constraint c holds one. The lowest bit wins. */
export function heldColours(held) {
  const palette = [ink.tissue, ...holds].map((colour) => new THREE.Color(colour).toArray());
  const colours = new Float32Array(3 * held.length);
  for (let v = 0; v < held.length; ++v) {
    const bit = held[v] ? 31 - Math.clz32(held[v] & -held[v]) : -1;
    colours.set(palette[bit < 0 ? 0 : 1 + (bit % holds.length)], 3 * v);
  }
  return colours;
}

class Polyline extends THREE.Curve {
  constructor(points, isClosed) {
    super();
    this.points = isClosed ? [...points, points[0]] : points;
  }

  getPoint(share, target = new THREE.Vector3()) {
    const at = share * (this.points.length - 1),
      k = Math.min(Math.floor(at), this.points.length - 2);
    return target.set(...plus(this.points[k], minus(this.points[k + 1], this.points[k]), at - k));
  }
}

/** A curve as a thin tube, with a faint second copy where the tissue hides it. */
export function tubes(points, isClosed, colour, radius) {
  const path = thinned(points, 0.02);
  if (path.length < 2) return [];
  const geometry = new THREE.TubeGeometry(
    new Polyline(path, isClosed),
    Math.min(1500, 2 * path.length),
    radius,
    8,
    isClosed,
  );
  return withGhost(geometry, colour);
}

function thinned(points, least) {
  const kept = [];
  for (const point of points) if (!kept.length || length(minus(point, kept.at(-1))) > least) kept.push(point);
  return kept;
}

function withGhost(geometry, colour) {
  const solid = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({color: colour}));
  const ghost = new THREE.Mesh(
    geometry,
    new THREE.MeshBasicMaterial({color: colour, transparent: true, opacity: 0.35, depthTest: false, depthWrite: false}),
  );
  ghost.renderOrder = 5;
  return [solid, ghost];
}

/** A ball at each point, seen through the tissue as a ghost. */
export function balls(points, colour, radius) {
  const geometry = new THREE.SphereGeometry(radius, 18, 12);
  return points.flatMap((point) =>
    withGhost(geometry, colour).map((mesh) => {
      mesh.position.set(...point);
      return mesh;
    }),
  );
}

/** Lines from a path's surface points down to the tool's tip. @param depth_mm  a number or one for each point */
export function depthLines(points, axes, depth_mm, colour) {
  const ends = points.flatMap((point, k) => {
    const axis = Array.isArray(axes[0]) ? axes[k] : axes;
    return [...point, ...plus(point, axis, Array.isArray(depth_mm) ? depth_mm[k] : depth_mm)];
  });
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(ends), 3));
  return [
    new THREE.LineSegments(
      geometry,
      new THREE.LineBasicMaterial({color: colour, transparent: true, opacity: 0.4, depthTest: false}),
    ),
  ];
}

/** A box [low, high] as twelve lines. */
export function boxLines(box, colour) {
  const size = minus(box[1], box[0]);
  const edges = new THREE.EdgesGeometry(new THREE.BoxGeometry(...size));
  const lines = new THREE.LineSegments(edges, new THREE.LineBasicMaterial({color: colour}));
  lines.position.set(...plus(box[0], size, 0.5));
  return [lines];
}

/** A plane as a square with a grid of 10 mm, below `middle`. @param normal  unit vector */
export function plate(point, normal, middle, radius) {
  const side = 20 * Math.ceil(radius / 8);
  const group = new THREE.Group();
  const sheet = new THREE.Mesh(
    new THREE.PlaneGeometry(side, side),
    new THREE.MeshBasicMaterial({
      color: 0x9fb2c2,
      transparent: true,
      opacity: 0.2,
      side: THREE.DoubleSide,
      depthWrite: false,
    }),
  );
  const grid = new THREE.GridHelper(side, side / 10, 0x8497a6, 0xa9b6c0);
  grid.rotation.x = Math.PI / 2;
  group.add(sheet, grid);
  const up = new THREE.Vector3(...normal);
  group.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), up);
  const centre = new THREE.Vector3(...middle);
  group.position.copy(centre).addScaledVector(up, up.dot(new THREE.Vector3(...point).sub(centre)));
  return [group];
}

/** A needle whose tip is at a point. @param axis  from shaft to tip, unit vector */
export function needle(tip, axis, diameter, reach) {
  const steel = new THREE.MeshPhongMaterial({color: ink.tool, shininess: 60});
  const body = new THREE.Mesh(new THREE.CylinderGeometry(diameter / 2, diameter / 2, reach, 24), steel);
  body.position.y = reach / 2;
  const group = new THREE.Group();
  group.add(body, new THREE.Mesh(new THREE.SphereGeometry(diameter / 2, 24, 12), steel));
  group.position.set(...tip);
  group.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), new THREE.Vector3(...axis).negate().normalize());
  return [group];
}

/** {centre, radius} of a ball about a skin, from its box. */
export function ballAbout(vertices) {
  const low = [Infinity, Infinity, Infinity],
    high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < vertices.length; ++i) {
    low[i % 3] = Math.min(low[i % 3], vertices[i]);
    high[i % 3] = Math.max(high[i % 3], vertices[i]);
  }
  const size = minus(high, low);
  return {centre: plus(low, size, 0.5), radius: 0.5 * length(size), low, high};
}
