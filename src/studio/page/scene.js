// The 3D view: a parallel projection that can be turned, moved and zoomed, so that lengths in it can be measured.

import * as THREE from "three";
import {MeshBVH} from "three-mesh-bvh";
import {letterOf, roundedDown} from "./geometry.js";
import {isDark} from "./colours.js";
import {Gizmo} from "./gizmo.js";

const kSmallMove = 5; // px: less is a click

// Azimuth turns about the z axis; elevation 90 degrees looks straight down.
const kViews = {Oblique: [-0.6, 0.75], Top: [0, Math.PI / 2], Front: [0, 0], Left: [Math.PI / 2, 0]};

/** The names of the views that a button turns to. */
export const kViewNames = Object.keys(kViews);

/** The scene. Things in it are layers with names; mm, LPS. `onLayers()` is called when a layer comes or goes.
 *  `tool` (or null) sees the pointer and keys first: {press(event), drag(event), drop(), click(event), key(event)}, and
 *  if it likes hover(event) and cancel(), for a second finger; press and key answer whether they took the event. */
export class Scene {
  constructor(host, onLayers) {
    this.host = host;
    this.onLayers = onLayers;
    this.layers = new Map();
    this.hidden = new Set();
    this.tool = null;
    this.centre = new THREE.Vector3();
    this.target = new THREE.Vector3();
    this.radius = 0;
    this.zoom = 1;
    [this.azimuth, this.elevation] = kViews.Oblique;
    this.makeRenderer();
    this.makeLights();
    this.makeFurniture();
    this.listen();
    new ResizeObserver(() => this.resize()).observe(host);
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.render());
  }

  makeRenderer() {
    this.renderer = new THREE.WebGLRenderer({antialias: true, alpha: true, preserveDrawingBuffer: true});
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    this.renderer.setClearColor(0x000000, 0);
    this.scene = new THREE.Scene();
    this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 1, 6000);
    this.host.append(this.renderer.domElement);
  }

  makeLights() {
    const sky = new THREE.HemisphereLight(0xffffff, 0xb8aaa4, 1.9);
    sky.position.set(0, 0, 1);
    this.lamp = new THREE.DirectionalLight(0xffffff, 1.7);
    this.scene.add(sky, this.lamp, this.lamp.target);
  }

  makeFurniture() {
    this.scaleBar = document.createElement("div");
    this.scaleBar.className = "scale-bar";
    this.scaleBar.setAttribute("aria-hidden", "true");
    this.scaleBar.append(document.createElement("i"), document.createElement("span"));
    this.gizmo = new Gizmo();
    this.host.append(this.scaleBar, this.gizmo.node);
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

  /** Makes a ball of this centre ([x, y, z]) and radius fill the view; turns to the oblique view the first time. */
  fit(centre, radius) {
    const isFirst = this.radius === 0,
      isCentred = this.target.equals(this.centre);
    this.centre.set(...centre);
    if (isCentred) this.target.copy(this.centre);
    this.radius = radius;
    if (isFirst) this.look("Oblique");
    else this.render();
  }

  /** Makes a ball fill the view without turning it. */
  frame(centre, radius) {
    this.centre.set(...centre);
    this.target.copy(this.centre);
    this.radius = radius;
    this.zoom = 1;
    this.render();
  }

  /** Forgets what was fitted: the next fit is a first one. */
  forget() {
    this.radius = 0;
  }

  look(name) {
    [this.azimuth, this.elevation] = kViews[name];
    this.target.copy(this.centre);
    this.zoom = 1;
    this.render();
  }

  /** Moves a place, mm, to the middle, near enough to be seen. */
  goTo(point) {
    this.target.set(...point);
    this.zoom = Math.max(this.zoom, 2.5);
    this.render();
  }

  /** The observer's axes: right, up, and towards the observer. */
  axes() {
    const [ca, sa] = [Math.cos(this.azimuth), Math.sin(this.azimuth)];
    const [ce, se] = [Math.cos(this.elevation), Math.sin(this.elevation)];
    return {
      right: new THREE.Vector3(ca, sa, 0),
      up: new THREE.Vector3(-sa * se, ca * se, ce),
      towards: new THREE.Vector3(sa * ce, -ca * ce, se),
    };
  }

  pixelsPerMm() {
    return (this.zoom * Math.min(this.host.clientHeight, 0.8 * this.host.clientWidth)) / (2 * Math.max(1, this.radius));
  }

  resize() {
    this.renderer.setSize(Math.max(1, this.host.clientWidth), Math.max(1, this.host.clientHeight));
    this.render();
  }

  /** Draws at the next chance, once however often it is asked. */
  render() {
    if (this.isDirty) return;
    this.isDirty = true;
    requestAnimationFrame(() => this.draw());
  }

  draw() {
    this.isDirty = false;
    const width = this.host.clientWidth,
      height = this.host.clientHeight;
    if (!width || !height) return;
    const axes = this.axes(),
      scale = this.pixelsPerMm();
    this.placeCamera(axes, width / (2 * scale), height / (2 * scale));
    this.renderer.render(this.scene, this.camera);
    this.drawScaleBar(scale);
    this.gizmo.draw(axes, isDark());
    this.host.dataset.ready = this.layers.size ? "yes" : "empty";
  }

  placeCamera({right, up, towards}, halfWidth, halfHeight) {
    Object.assign(this.camera, {left: -halfWidth, right: halfWidth, top: halfHeight, bottom: -halfHeight});
    this.camera.position.copy(this.target).addScaledVector(towards, 3000);
    this.camera.quaternion.setFromRotationMatrix(new THREE.Matrix4().makeBasis(right, up, towards));
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
    this.lamp.target.position.copy(this.target);
    this.lamp.position
      .copy(this.target)
      .addScaledVector(towards, 90)
      .addScaledVector(up, 60)
      .addScaledVector(right, -40);
  }

  drawScaleBar(scale) {
    const bar = roundedDown(110 / scale);
    this.scaleBar.hidden = !this.layers.size;
    this.scaleBar.firstChild.style.width = `${bar * scale}px`;
    this.scaleBar.lastChild.textContent = `${Number(bar.toPrecision(2))} mm`;
  }

  turn(dx, dy) {
    this.azimuth -= 0.008 * dx;
    this.elevation = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, this.elevation + 0.008 * dy));
    this.render();
  }

  pan(dx, dy) {
    const {right, up} = this.axes(),
      mm = 1 / this.pixelsPerMm();
    this.target.addScaledVector(right, -dx * mm).addScaledVector(up, dy * mm);
    this.render();
  }

  zoomBy(factor) {
    this.zoom = Math.max(0.3, Math.min(40, this.zoom * factor));
    this.render();
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

  // --- Mouse, touch and keyboard. ---

  listen() {
    const canvas = this.renderer.domElement;
    this.fingers = new Map();
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "application");
    canvas.setAttribute(
      "aria-label",
      "3D view. Arrow keys turn it, with Shift they move it, plus and minus zoom, " + "1 to 4 choose a view.",
    );
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("pointerdown", (event) => this.press(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.release(event));
    canvas.addEventListener("pointercancel", (event) => this.release(event));
    canvas.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        this.zoomBy(Math.exp(-0.0012 * event.deltaY));
      },
      {passive: false},
    );
    canvas.addEventListener("keydown", (event) => this.key(event));
  }

  press(event) {
    const canvas = this.renderer.domElement;
    canvas.focus({preventScroll: true});
    canvas.setPointerCapture(event.pointerId);
    this.fingers.set(event.pointerId, [event.offsetX, event.offsetY]);
    this.travel = 0;
    if (this.isTaken && this.tool && this.tool.cancel) this.tool.cancel();
    this.isTaken = event.button === 0 && this.fingers.size === 1 && Boolean(this.tool) && this.tool.press(event);
  }

  move(event) {
    const last = this.fingers.get(event.pointerId);
    if (!last) return this.tool && this.tool.hover && this.tool.hover(event);
    const dx = event.offsetX - last[0],
      dy = event.offsetY - last[1];
    this.travel += Math.abs(dx) + Math.abs(dy);
    const before = this.spread();
    this.fingers.set(event.pointerId, [event.offsetX, event.offsetY]);
    if (this.isTaken) return this.tool && this.tool.drag(event);
    if (before > 0) {
      this.zoomBy(Math.max(1, this.spread()) / before);
      this.pan(dx / 2, dy / 2);
    } else if (event.buttons & 6 || event.shiftKey) {
      this.pan(dx, dy);
    } else if (this.travel > kSmallMove) {
      this.turn(dx, dy);
    }
  }

  spread() {
    const [a, b] = [...this.fingers.values()];
    return b ? Math.hypot(a[0] - b[0], a[1] - b[1]) : 0;
  }

  release(event) {
    this.fingers.delete(event.pointerId);
    if (this.isTaken && this.tool) this.tool.drop();
    else if (this.tool && event.button === 0 && this.travel <= kSmallMove) this.tool.click(event);
    this.isTaken = false;
  }

  key(event) {
    if (this.tool && this.tool.key(event)) return event.preventDefault();
    const turns = {ArrowLeft: [-12, 0], ArrowRight: [12, 0], ArrowUp: [0, -12], ArrowDown: [0, 12]}[event.key];
    if (turns && event.shiftKey) this.pan(...turns);
    else if (turns) this.turn(...turns);
    else if (event.key === "+" || event.key === "=") this.zoomBy(1.15);
    else if (event.key === "-") this.zoomBy(1 / 1.15);
    else if (kViewNames[Number(event.key) - 1]) this.look(kViewNames[Number(event.key) - 1]);
    else return;
    event.preventDefault();
  }

  /** Share of the picture that is not background: proof that something is to be seen. */
  coverage() {
    this.draw();
    const gl = this.renderer.getContext();
    const pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
    gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let drawn = 0;
    for (let i = 3; i < pixels.length; i += 4) if (pixels[i] > 24) ++drawn;
    return drawn / (pixels.length / 4);
  }

  /** The letter of the direction that points up on the screen. */
  upLetter() {
    return letterOf(this.axes().up.toArray());
  }
}

/** A skin that can be asked where a ray meets it and which of its points is nearest. Indices are left as they are. */
export class SkinQuery {
  /** @param skin  {vertices: Float32Array, triangles: Uint32Array}, mm */
  constructor(skin) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(skin.vertices, 3));
    geometry.setIndex(new THREE.BufferAttribute(skin.triangles, 1));
    this.tree = new MeshBVH(geometry, {indirect: true});
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
