// What the 3D view is made of: skins, curves, points, planes. Lengths in mm, LPS.

import * as THREE from "three";
import {minus, plus, length, thinned} from "./geometry.js";
import {holds, ink, kUnseen, scaleColour} from "./colours.js";

/** A geometry of points, x y z in turn, with triangles and with colours, linear RGB of each point, if there are any. */
export function geometryOf(points, {triangles, colours} = {}) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(points, 3));
  if (triangles) geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
  if (colours) geometry.setAttribute("color", new THREE.BufferAttribute(colours, 3));
  return geometry;
}

/** A skin. @param look  {colour, opacity, colours: Float32Array of linear RGB per vertex} */
export function skinMesh(skin, look) {
  const geometry = geometryOf(skin.vertices, {triangles: skin.triangles, colours: look.colours});
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

/** Colours of a body's vertices: bit c of `held` is set where constraint c holds one. The lowest bit wins.
 *  @param free  the colour of those that nothing holds   @param share  of it in all the others, 0..1 */
export function heldColours(held, free, share = 0) {
  const ground = new THREE.Color(free),
    palette = [free, ...holds].map((colour) => new THREE.Color(colour).lerp(ground, share).toArray());
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

/** Lines from a path's surface points down to the tool's tip, with an axis and a depth for each point. */
export function depthLines(points, axes, depth_mm, colour) {
  const ends = points.flatMap((point, k) => [...point, ...plus(point, axes[k], depth_mm[k])]);
  return [
    new THREE.LineSegments(
      geometryOf(new Float32Array(ends)),
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

/** A plane as a square with a grid of `step` mm, below `middle`. @param normal  unit vector */
export function plate(point, normal, middle, radius, step = 10) {
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
  const grid = new THREE.GridHelper(side, side / step, 0x8497a6, 0xa9b6c0);
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

let disc = null;

/** A white disc, so that points are round. */
function discTexture() {
  if (disc) return disc;
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 32;
  const pen = canvas.getContext("2d");
  pen.fillStyle = "#fff";
  pen.arc(16, 16, 15, 0, 2 * Math.PI);
  pen.fill();
  disc = new THREE.CanvasTexture(canvas);
  return disc;
}

/** Points of a cloud, as dots of so many pixels. @param look  {colour, size} or {colours: Float32Array, size} */
export function cloudPoints(points, {colour, colours, size}) {
  const material = new THREE.PointsMaterial({
    color: colours ? 0xffffff : colour,
    vertexColors: Boolean(colours),
    size,
    sizeAttenuation: false,
    map: discTexture(),
    alphaTest: 0.5,
  });
  const dots = new THREE.Points(geometryOf(points, {colours}), material);
  dots.frustumCulled = false;
  return dots;
}

/** Colours of residuals, mm, from minus `top` to `top`: linear RGB for each; one that is no number was not seen. */
export function residualColours(residuals, top) {
  const colours = new Float32Array(3 * residuals.length),
    colour = new THREE.Color();
  residuals.forEach((residual, k) => {
    if (Number.isNaN(residual)) colour.set(kUnseen);
    else colour.setRGB(...scaleColour(residual / top).map((value) => value / 255), THREE.SRGBColorSpace);
    colours.set(colour.toArray(), 3 * k);
  });
  return colours;
}

/** Moves objects by a rigid transform of 4 rows of 4. */
export function placed(objects, pose) {
  const matrix = new THREE.Matrix4().set(...pose.flat());
  for (const object of objects) object.applyMatrix4(matrix);
  return objects;
}

// --- The arm. ---

const kUp = new THREE.Vector3(0, 1, 0);

/** An arm's hulls as capsules; poseArm() puts them where they belong. */
export function armHulls(hulls, colourOf) {
  return hulls.map(({name, radius_mm: radius}) => {
    const material = new THREE.MeshPhongMaterial({color: colourOf(name), shininess: 25});
    const ball = new THREE.SphereGeometry(radius, 28, 18);
    const group = new THREE.Group();
    group.add(
      new THREE.Mesh(ball, material),
      new THREE.Mesh(ball, material),
      new THREE.Mesh(new THREE.CylinderGeometry(radius, radius, 1, 28, 1, true), material),
    );
    return group;
  });
}

/** Puts each capsule between its two ends. @param ends  [[x, y, z, x, y, z]], mm */
export function poseArm(groups, ends) {
  groups.forEach((group, k) => {
    const [from, to, rod] = group.children;
    from.position.set(...ends[k].slice(0, 3));
    to.position.set(...ends[k].slice(3));
    const along = to.position.clone().sub(from.position),
      reach = along.length();
    rod.visible = reach > 1e-6;
    rod.position.copy(from.position).addScaledVector(along, 0.5);
    if (rod.visible) rod.quaternion.setFromUnitVectors(kUp, along.divideScalar(reach));
    rod.scale.set(1, Math.max(reach, 1e-6), 1);
  });
}

/** A line of which showTrace() shows the first part. @param points  Float32Array */
export function trace(points, colour) {
  const line = new THREE.Line(geometryOf(points), new THREE.LineBasicMaterial({color: colour, depthTest: false}));
  line.renderOrder = 6;
  line.frustumCulled = false;
  return line;
}

/** Shows the first points of a trace. */
export function showTrace(line, count) {
  line.geometry.setDrawRange(0, count);
}
