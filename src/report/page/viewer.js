// The 3D viewer of the studio and of the report: a parallel projection that can be turned, moved and zoomed, so that
// lengths in it can be measured. It imports nothing, for a page on a disk cannot: three.js and the gizmo are handed
// over.

const kSmallMove = 5; // px: less is a click

const kWorld = [
  [1, 0, 0],
  [0, 1, 0],
  [0, 0, 1],
];

// Azimuth turns about the basis' z axis; elevation 90 degrees looks straight down along it.
const kAngles = [
  [-0.6, 0.75],
  [0, Math.PI / 2],
  [0, 0],
  [Math.PI / 2, 0],
];

/** The viewer in an element; mm. @param three  the library   @param options
 *  `gizmo`: turned with the view; `names`: of the views: oblique, from above, from the front, from the side;
 *  `basis`: axes that the views refer to, three vectors; `barLength`: about that of the scale bar, px;
 *  `scrolls`: the page about it, so that the wheel is taken only where the view has the focus, or with Ctrl;
 *  `isDark()`: whether the page is dark. */
export class Viewer {
  constructor(three, host, {gizmo, names, basis = kWorld, barLength = 110, scrolls = false, isDark = () => false}) {
    Object.assign(this, {three, host, gizmo, names, barLength, scrolls, isDark});
    this.basis = basis.map((axis) => new three.Vector3(...axis));
    this.centre = new three.Vector3();
    this.target = new three.Vector3();
    this.radius = 0;
    this.zoom = 1;
    [this.azimuth, this.elevation] = kAngles[0];
    this.fingers = new Map();
    this.makeRenderer();
    this.makeLights();
    this.makeFurniture();
    this.listen();
    this.resize();
    new ResizeObserver(() => this.resize()).observe(host);
  }

  makeRenderer() {
    const {three} = this;
    this.renderer = new three.WebGLRenderer({antialias: true, alpha: true, preserveDrawingBuffer: true});
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    this.renderer.setClearColor(0x000000, 0);
    this.scene = new three.Scene();
    this.camera = new three.OrthographicCamera(-1, 1, 1, -1, 1, 6000);
    this.canvas = this.renderer.domElement;
    this.host.append(this.canvas);
  }

  makeLights() {
    const sky = new this.three.HemisphereLight(0xffffff, 0xb8aaa4, 1.9);
    sky.position.copy(this.basis[2]);
    this.lamp = new this.three.DirectionalLight(0xffffff, 1.7);
    this.scene.add(sky, this.lamp, this.lamp.target);
  }

  makeFurniture() {
    this.scaleBar = document.createElement("div");
    this.scaleBar.className = "scale-bar";
    this.scaleBar.setAttribute("aria-hidden", "true");
    this.scaleBar.append(document.createElement("i"), document.createElement("span"));
    this.host.append(this.scaleBar, this.gizmo.node);
  }

  // --- Camera. ---

  /** Makes a ball of this centre ([x, y, z]) and radius fill the view; turns to the oblique view the first time. */
  fit(centre, radius) {
    const isFirst = this.radius === 0,
      isCentred = this.target.equals(this.centre);
    this.centre.set(...centre);
    if (isCentred) this.target.copy(this.centre);
    this.radius = radius;
    if (isFirst) this.look(this.names[0]);
    else this.render();
  }

  /** Turns to a named view. */
  look(name) {
    [this.azimuth, this.elevation] = this.anglesOf(name);
    this.target.copy(this.centre);
    this.zoom = 1;
    this.render();
  }

  anglesOf(name) {
    return kAngles[this.names.indexOf(name)];
  }

  /** The observer's axes: right, up, and towards the observer; as they are now, or of a named view. */
  axes(name) {
    const [azimuth, elevation] = name ? this.anglesOf(name) : [this.azimuth, this.elevation],
      [x, y, z] = this.basis;
    const mix = (a, u, b, v) => u.clone().multiplyScalar(a).addScaledVector(v, b);
    const away = mix(-Math.sin(azimuth), x, Math.cos(azimuth), y);
    return {
      right: mix(Math.cos(azimuth), x, Math.sin(azimuth), y),
      up: mix(Math.sin(elevation), away, Math.cos(elevation), z),
      towards: mix(-Math.cos(elevation), away, Math.sin(elevation), z),
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
    this.drawFurniture(axes, scale);
  }

  placeCamera({right, up, towards}, halfWidth, halfHeight) {
    Object.assign(this.camera, {left: -halfWidth, right: halfWidth, top: halfHeight, bottom: -halfHeight});
    this.camera.position.copy(this.target).addScaledVector(towards, 3000);
    this.camera.quaternion.setFromRotationMatrix(new this.three.Matrix4().makeBasis(right, up, towards));
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
    this.lamp.target.position.copy(this.target);
    this.lamp.position
      .copy(this.target)
      .addScaledVector(towards, 90)
      .addScaledVector(up, 60)
      .addScaledVector(right, -40);
  }

  drawFurniture(axes, scale) {
    const bar = roundedDown(this.barLength / scale);
    this.scaleBar.firstChild.style.width = `${bar * scale}px`;
    this.scaleBar.lastChild.textContent = `${Number(bar.toPrecision(2))} mm`;
    this.gizmo.draw(axes, this.isDark());
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

  // --- Mouse, touch and keyboard. ---

  listen() {
    const {canvas} = this;
    canvas.tabIndex = 0;
    canvas.style.outlineOffset = "-2px"; // else the host's border hides the focus
    canvas.setAttribute("role", "application");
    canvas.setAttribute(
      "aria-label",
      "3D view. Arrow keys turn it, with Shift they move it, plus and minus zoom, 1 to 4 choose a view.",
    );
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("pointerdown", (event) => this.press(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, (event) => this.release(event));
    canvas.addEventListener("wheel", (event) => this.roll(event), {passive: false});
    canvas.addEventListener("keydown", (event) => this.key(event));
  }

  press(event) {
    this.canvas.focus({preventScroll: true});
    this.canvas.setPointerCapture(event.pointerId);
    this.fingers.set(event.pointerId, [event.offsetX, event.offsetY]);
    this.travel = 0;
  }

  move(event) {
    const last = this.fingers.get(event.pointerId);
    if (!last) return;
    const dx = event.offsetX - last[0],
      dy = event.offsetY - last[1];
    this.travel += Math.abs(dx) + Math.abs(dy);
    const before = this.spread();
    this.fingers.set(event.pointerId, [event.offsetX, event.offsetY]);
    this.drag(event, dx, dy, before);
  }

  /** @param before  the distance of two fingers before the move; 0: there is one */
  drag(event, dx, dy, before) {
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
  }

  isClick() {
    return this.travel <= kSmallMove;
  }

  roll(event) {
    if (this.scrolls && document.activeElement !== this.canvas && !event.ctrlKey) return;
    event.preventDefault();
    this.zoomBy(Math.exp(-0.0012 * event.deltaY));
  }

  key(event) {
    const turns = {ArrowLeft: [-12, 0], ArrowRight: [12, 0], ArrowUp: [0, -12], ArrowDown: [0, 12]}[event.key];
    const view = this.names[Number(event.key) - 1];
    if (turns && event.shiftKey) this.pan(...turns);
    else if (turns) this.turn(...turns);
    else if (event.key === "+" || event.key === "=") this.zoomBy(1.15);
    else if (event.key === "-") this.zoomBy(1 / 1.15);
    else if (view) this.look(view);
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
}

/** The largest of 1, 2, 5 times a power of ten that is not above the value: the length of a scale bar. */
export function roundedDown(value) {
  const decade = 10 ** Math.floor(Math.log10(value));
  return [5, 2, 1].map((factor) => factor * decade).find((round) => round <= value * (1 + 1e-9)) || decade;
}
