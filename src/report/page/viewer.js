"use strict";
// A parallel projection that can be turned, moved and zoomed: lengths in it can be measured, so it has a scale bar.

const kBackground = 0xf6f6f3;
const kTissueColor = 0xdb9a8f;
const kKerfColor = 0x9c1f24;

// Azimuth turns about the approach; elevation 90 degrees looks straight along it.
const kViews = {Oblique: [-0.6, 0.75], Top: [0, Math.PI / 2], Front: [0, 0], Side: [Math.PI / 2, 0]};

class Viewer {
  /** @param frame  {x, y, z, ends}: the picture axes seen along the approach, and the names of the world axes' ends. */
  constructor(stage, frame) {
    this.stage = stage;
    this.frame = ["x", "y", "z"].map((key) => new THREE.Vector3(...frame[key]));
    this.renderer = new THREE.WebGLRenderer({antialias: true, preserveDrawingBuffer: true});
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    this.renderer.setClearColor(kBackground);
    this.scene = new THREE.Scene();
    this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 1, 4000);
    const sky = new THREE.HemisphereLight(0xffffff, 0xb8aaa4, 1.9);
    sky.position.copy(this.frame[2]);
    this.scene.add(sky);
    this.lamp = new THREE.DirectionalLight(0xffffff, 1.7);
    this.scene.add(this.lamp, this.lamp.target);
    this.center = new THREE.Vector3();
    this.radius = 1;
    this.isDirty = false;

    stage.append(this.renderer.domElement);
    this.scaleBar = element("div", {className: "scale-bar", "aria-hidden": "true"}, element("i"), element("span"));
    stage.append(this.scaleBar);
    this.gizmo = new Gizmo(frame.ends);
    stage.append(this.gizmo.node);
    stage.classList.add("live");
    stage.tabIndex = 0;
    stage.setAttribute("role", "application");
    this.listen();
    new ResizeObserver(() => this.resize()).observe(stage);
  }

  /** Makes a ball of this centre and radius fill the view. */
  fit(center, radius) {
    this.center.copy(center);
    this.radius = radius;
    this.look("Oblique");
    this.resize();
  }

  /** Turns to a named view. */
  look(name) {
    [this.azimuth, this.elevation] = kViews[name];
    this.target = this.center.clone();
    this.zoom = 1;
    this.render();
  }

  /** The observer's axes: right, up, and towards the observer. */
  axes() { return this.axesAt(this.azimuth, this.elevation); }
  axesOf(name) { return this.axesAt(...kViews[name]); }
  axesAt(azimuth, elevation) {
    const [x, y, z] = this.frame;
    const mix = (a, u, b, v) => u.clone().multiplyScalar(a).addScaledVector(v, b);
    const right = mix(Math.cos(azimuth), x, Math.sin(azimuth), y);
    const away = mix(-Math.sin(azimuth), x, Math.cos(azimuth), y);
    const up = mix(Math.sin(elevation), away, Math.cos(elevation), z);
    const towards = mix(-Math.cos(elevation), away, Math.sin(elevation), z);
    return {right, up, towards};
  }

  pixelsPerMm() {
    return this.zoom * Math.min(this.stage.clientHeight, this.stage.clientWidth * 0.8) / (2 * this.radius);
  }

  resize() {
    const width = Math.max(1, this.stage.clientWidth), height = Math.max(1, this.stage.clientHeight);
    this.renderer.setSize(width, height);
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
    const {right, up, towards} = this.axes();
    const scale = this.pixelsPerMm();
    const halfWidth = this.stage.clientWidth / (2 * scale), halfHeight = this.stage.clientHeight / (2 * scale);
    Object.assign(this.camera, {left: -halfWidth, right: halfWidth, top: halfHeight, bottom: -halfHeight});
    this.camera.position.copy(this.target).addScaledVector(towards, 2000);
    this.camera.quaternion.setFromRotationMatrix(new THREE.Matrix4().makeBasis(right, up, towards));
    this.camera.updateProjectionMatrix();
    this.lamp.target.position.copy(this.target);
    this.lamp.position.copy(this.target).addScaledVector(towards, 90).addScaledVector(up, 60).addScaledVector(right, -40);
    this.renderer.render(this.scene, this.camera);
    this.drawScaleBar(scale);
    this.gizmo.draw({right, up, towards}, false);
  }

  drawScaleBar(scale) {
    const length = roundedDown(150 / scale);
    this.scaleBar.firstChild.style.width = length * scale + "px";
    this.scaleBar.lastChild.textContent = Number(length.toPrecision(2)) + " mm";
  }

  turn(dx, dy) {
    this.azimuth -= 0.008 * dx;
    this.elevation = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, this.elevation + 0.008 * dy));
    this.render();
  }

  pan(dx, dy) {
    const {right, up} = this.axes();
    const mm = 1 / this.pixelsPerMm();
    this.target.addScaledVector(right, -dx * mm).addScaledVector(up, dy * mm);
    this.render();
  }

  zoomBy(factor) {
    this.zoom = Math.max(0.3, Math.min(40, this.zoom * factor));
    this.render();
  }

  /** Drag turns, drag with the right button or Shift moves, wheel with Ctrl or on the focused view zooms, two fingers zoom. */
  listen() {
    const canvas = this.renderer.domElement;
    const fingers = new Map();
    const spread = () => {
      const [a, b] = [...fingers.values()];
      return Math.hypot(a.x - b.x, a.y - b.y);
    };
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("pointerdown", (event) => {
      this.stage.focus({preventScroll: true});
      canvas.setPointerCapture(event.pointerId);
      fingers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    });
    canvas.addEventListener("pointermove", (event) => {
      const last = fingers.get(event.pointerId);
      if (!last) return;
      const dx = event.clientX - last.x, dy = event.clientY - last.y;
      const before = fingers.size === 2 ? spread() : 0;
      fingers.set(event.pointerId, {x: event.clientX, y: event.clientY});
      if (fingers.size === 2) {
        this.zoomBy(spread() / Math.max(1, before));
        this.pan(dx / 2, dy / 2);
      } else if (event.buttons & 2 || event.shiftKey) {
        this.pan(dx, dy);
      } else {
        this.turn(dx, dy);
      }
    });
    for (const name of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(name, (event) => fingers.delete(event.pointerId));
    }
    canvas.addEventListener("wheel", (event) => {
      if (document.activeElement !== this.stage && !event.ctrlKey) return;  // let the page scroll
      event.preventDefault();
      this.zoomBy(Math.exp(-0.0012 * event.deltaY));
    }, {passive: false});
    this.stage.addEventListener("keydown", (event) => {
      const turns = {ArrowLeft: [-12, 0], ArrowRight: [12, 0], ArrowUp: [0, -12], ArrowDown: [0, 12]};
      if (turns[event.key]) {
        if (event.shiftKey) this.pan(...turns[event.key]);
        else this.turn(...turns[event.key]);
      } else if (event.key === "+" || event.key === "=") {
        this.zoomBy(1.15);
      } else if (event.key === "-") {
        this.zoomBy(1 / 1.15);
      } else {
        return;
      }
      event.preventDefault();
    });
  }

  /** Share of the picture that is not background: proof that something is to be seen. */
  coverage() {
    this.draw();
    const gl = this.renderer.getContext();
    const width = gl.drawingBufferWidth, height = gl.drawingBufferHeight;
    const pixels = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let drawn = 0;
    for (let i = 0; i < pixels.length; i += 4) {
      if (Math.abs(pixels[i] - 0xf6) + Math.abs(pixels[i + 1] - 0xf6) + Math.abs(pixels[i + 2] - 0xf3) > 24) ++drawn;
    }
    return drawn / (width * height);
  }

  /** Buttons for the named views and a word on the mouse. */
  viewRow() {
    const row = element("div", {className: "row"});
    for (const name of ["Oblique", "Top", "Front", "Side"]) {
      row.append(element("button", {type: "button", textContent: name, onclick: () => this.look(name)}));
    }
    row.append(element("span", {className: "hint", textContent:
      "drag: turn · shift-drag: move · wheel after a click: zoom · arrow keys, + and − work, too"}));
    return row;
  }
}

/** A switch that is also the legend: a coloured mark, a name, and whether the things are shown. */
function legendSwitch(viewer, label, color, things, isOn, isArea) {
  const apply = (visible) => {
    for (const thing of things) thing.visible = visible;
    viewer.render();
  };
  const box = element("input", {type: "checkbox", checked: isOn, onchange: () => apply(box.checked)});
  const swatch = element("span", {className: isArea ? "swatch area" : "swatch"});
  swatch.style.background = color;
  apply(isOn);
  return element("label", {}, box, swatch, label);
}

/** A curve as a thin tube, with a faint second copy where the tissue hides it. */
function curveTubes(points, isClosed, color, radius) {
  const path = [];
  for (let i = 0; i < points.length; i += 3) path.push(new THREE.Vector3(points[i], points[i + 1], points[i + 2]));
  const curve = new THREE.CatmullRomCurve3(path, isClosed, "centripetal");
  const geometry = new THREE.TubeGeometry(curve, Math.max(64, 3 * path.length), radius, 8, isClosed);
  const solid = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({color}));
  const ghost = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial(
    {color, transparent: true, opacity: 0.35, depthTest: false, depthWrite: false}));
  ghost.renderOrder = 5;
  return [solid, ghost];
}
