// The 3D view of the studio: the viewer with layers that have names, and tools that draw on what it shows.

import * as THREE from "three";
import {MeshBVH} from "three-mesh-bvh";
import {isDark} from "./colours.js";
import {Gizmo} from "./gizmo.js";
import {geometryOf} from "./things.js";
import {Viewer} from "./viewer.js";

/** The names of the views that a button turns to. */
export const kViewNames = ["Oblique", "Top", "Front", "Left"];

/** The scene. Things in it are layers with names; mm, LPS. `onLayers()` is called when a layer comes or goes.
 *  `tool` (or null) sees the pointer and keys first: {press(event), drag(event), drop(), click(event), key(event)}, and
 *  if it likes hover(event) and cancel(), for a second finger; press and key answer whether they took the event. */
export class Scene extends Viewer {
  constructor(host, onLayers) {
    super(THREE, host, {gizmo: new Gizmo(), names: kViewNames, isDark});
    this.onLayers = onLayers;
    this.layers = new Map();
    this.hidden = new Set();
    this.tool = null;
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.render());
  }

  // --- Layers. ---

  /** Puts a layer in place of the one of this name.
   *  @param objects  list of Object3D   @param about  {label, colour, isArea} */
  put(name, objects, about) {
    this.drop(name, true);
    const isShown = !this.hidden.has(name);
    for (const object of objects) object.visible = isShown;
    this.scene.add(...objects);
    this.layers.set(name, {name, objects, ...about});
    this.changed();
  }

  /** Takes a layer away. */
  drop(name, isReplaced = false) {
    const layer = this.layers.get(name);
    if (!layer) return;
    for (const object of layer.objects) this.discard(object);
    this.layers.delete(name);
    if (!isReplaced) this.changed();
  }

  discard(object) {
    this.scene.remove(object);
    object.traverse((part) => {
      if (part.geometry) part.geometry.dispose();
    });
  }

  // A frame later: the slices, which cost little, are on the screen before a scene that takes long to draw.
  changed() {
    requestAnimationFrame(() => this.render());
    this.onLayers();
  }

  /** Shows or hides a layer. */
  setShown(name, isShown) {
    if (isShown) this.hidden.delete(name);
    else this.hidden.add(name);
    const layer = this.layers.get(name);
    if (layer) for (const object of layer.objects) object.visible = isShown;
    this.changed();
  }

  isShown(name) {
    return !this.hidden.has(name);
  }

  // --- Camera. ---

  /** Makes a ball fill the view without turning it. */
  frame(centre, radius) {
    this.centre.set(...centre);
    this.target.copy(this.centre);
    this.radius = radius;
    this.zoom = 1;
    this.render();
  }

  /** As `fit`, for something of another extent: a camera that was moved stays as it is where it sees the whole of it,
   *  else the whole fills the view. */
  frameWhole(centre, radius) {
    const isMoved = this.zoom !== 1 || !this.target.equals(this.centre);
    if (!isMoved) return this.fit(centre, radius);
    if (!this.sees(centre, radius)) return this.frame(centre, radius);
    const before = this.pixelsPerMm();
    this.centre.set(...centre);
    this.radius = radius;
    this.zoom *= before / this.pixelsPerMm();
    return this.render();
  }

  /** Whether a ball lies in the view as a whole. */
  sees(centre, radius) {
    const {right, up} = this.axes(),
      off = new THREE.Vector3(...centre).sub(this.target),
      mm = 0.5 / this.pixelsPerMm();
    const isWithin = (axis, pixels) => Math.abs(off.dot(axis)) + 0.95 * radius <= pixels * mm;
    return isWithin(right, this.host.clientWidth) && isWithin(up, this.host.clientHeight);
  }

  /** Forgets what was fitted: the next fit is a first one. */
  forget() {
    this.radius = 0;
  }

  /** Moves a place, mm, to the middle, near enough to be seen. */
  goTo(point) {
    this.target.set(...point);
    this.zoom = Math.max(this.zoom, 2.5);
    this.render();
  }

  drawFurniture(axes, scale) {
    super.drawFurniture(axes, scale);
    this.scaleBar.hidden = !this.layers.size;
    this.host.dataset.ready = this.layers.size ? "yes" : "empty";
  }

  // --- Where the pointer is. ---

  /** Where a point, mm, is on the screen, px. */
  toScreen(point) {
    const at = new THREE.Vector3(...point).project(this.camera);
    return [(0.5 + 0.5 * at.x) * this.host.clientWidth, (0.5 - 0.5 * at.y) * this.host.clientHeight];
  }

  /** The ray under a place on the screen, px. */
  rayAt(x, y) {
    const at = new THREE.Vector2((2 * x) / this.host.clientWidth - 1, 1 - (2 * y) / this.host.clientHeight);
    const caster = new THREE.Raycaster();
    caster.setFromCamera(at, this.camera);
    return caster.ray;
  }

  // --- The tool. ---

  press(event) {
    super.press(event);
    if (this.isTaken && this.tool && this.tool.cancel) this.tool.cancel();
    this.isTaken = event.button === 0 && this.fingers.size === 1 && Boolean(this.tool) && this.tool.press(event);
  }

  move(event) {
    if (this.fingers.has(event.pointerId)) super.move(event);
    else if (this.tool && this.tool.hover) this.tool.hover(event);
  }

  drag(event, dx, dy, before) {
    if (!this.isTaken) super.drag(event, dx, dy, before);
    else if (this.tool) this.tool.drag(event);
  }

  release(event) {
    if (!this.fingers.has(event.pointerId)) return;
    if (event.type !== "pointerup") this.breakOff();
    super.release(event);
    if (this.isTaken && this.tool) this.tool.drop();
    else if (this.tool && event.button === 0 && this.isClick()) this.tool.click(event);
    this.isTaken = false;
  }

  /** Ends what is done with the pointer without effect: a stroke is not painted, and a point goes back. */
  breakOff() {
    if (this.isTaken && this.tool && this.tool.cancel) this.tool.cancel();
    this.isTaken = false;
    this.fingers.clear();
  }

  key(event) {
    if (event.key === "Escape" && this.isTaken) this.breakOff();
    else if (this.tool && this.tool.key(event)) event.preventDefault();
    else super.key(event);
  }
}

/** A skin that can be asked where a ray meets it and which of its points is nearest. Indices are left as they are. */
export class SkinQuery {
  /** @param skin  {vertices: Float32Array, triangles: Uint32Array}, mm */
  constructor(skin) {
    this.tree = new MeshBVH(geometryOf(skin.vertices, {triangles: skin.triangles}), {indirect: true});
  }

  /** The first point on a ray, [x, y, z], or null. */
  first(ray) {
    const hit = this.tree.raycastFirst(ray, THREE.DoubleSide);
    return hit ? hit.point.toArray() : null;
  }

  /** The first point met from outside along a direction through a point, or null. */
  along(point, direction) {
    const start = new THREE.Vector3(...point).addScaledVector(new THREE.Vector3(...direction), -2000);
    return this.first(new THREE.Ray(start, new THREE.Vector3(...direction)));
  }

  /** The point of the skin nearest to a point. */
  nearest(point) {
    return this.tree.closestPointToPoint(new THREE.Vector3(...point)).point.toArray();
  }
}
