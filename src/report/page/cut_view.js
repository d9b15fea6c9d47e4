"use strict";
// The player: the tissue's skin frame by frame, the needle, and the paths.

class CutView {
  constructor(host, animations, frame) {
    this.host = host;
    this.stage = host.querySelector(".stage");
    this.viewer = newViewer(this.stage, frame);
    this.animations = animations;
    this.decoded = animations.map((animation) => new Array(animation.frames.length));
    this.clock = element("div", {className: "clock", "aria-live": "off"});
    this.stage.append(this.clock);
    this.controls = host.querySelector(".controls");
    this.show(0);
  }

  /** Switches to one of the animations (before or after compensation, say) and shows its last frame. */
  show(which) {
    this.stop();
    const viewer = this.viewer;
    if (this.group) viewer.scene.remove(this.group);
    this.scene = this.animations[which];
    this.group = new THREE.Group();
    viewer.scene.add(this.group);
    this.skins = this.decoded[which];
    this.makeTissue();
    this.makeTool();
    this.controls.replaceChildren(this.playerRow(which), this.legendRow(), viewRow(viewer));

    const last = this.scene.frames.length - 1;
    this.showFrame(last);
    if (which === 0 && !this.isFitted) {
      const geometry = this.skin(last).outer;
      geometry.computeBoundingSphere();
      viewer.fit(geometry.boundingSphere.center.toArray(), 0.86 * geometry.boundingSphere.radius);
      this.isFitted = true;
    }
    const frame = this.scene.frames[last];
    const count = (this.skin(last).outer.index.count + this.skin(last).kerf.index.count) / 3;
    this.host.dataset.coverage = viewer.coverage().toFixed(3);
    this.host.dataset.viewerReady = `triangles=${count} frames=${this.scene.frames.length} time_s=${frame.time_s}`;
  }

  makeTissue() {
    // DoubleSide: through the open kerf one looks at the inside of faces, too.
    const tissue = new THREE.MeshLambertMaterial({color: kTissueColor, side: THREE.DoubleSide,
                                                  polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1});
    const kerf = tissue.clone();
    kerf.color.setHex(kKerfColor);
    const lines = new THREE.MeshBasicMaterial({color: 0x5a2b27, wireframe: true, transparent: true, opacity: 0.28});
    this.outer = new THREE.Mesh(undefined, tissue);
    this.kerf = new THREE.Mesh(undefined, kerf);
    this.outerLines = new THREE.Mesh(undefined, lines);
    this.kerfLines = new THREE.Mesh(undefined, lines);
    for (const mesh of [this.outer, this.kerf, this.outerLines, this.kerfLines]) {
      mesh.frustumCulled = false;
      this.group.add(mesh);
    }
  }

  makeTool() {
    const {diameter_mm: diameter, length_mm: length} = this.scene.tool;
    const steel = new THREE.MeshPhongMaterial({color: 0x8d979f, shininess: 60});
    const body = new THREE.Mesh(new THREE.CylinderGeometry(diameter / 2, diameter / 2, length, 24), steel);
    body.position.y = length / 2;
    const tip = new THREE.Mesh(new THREE.SphereGeometry(diameter / 2, 24, 12), steel);
    this.tool = new THREE.Group();
    this.tool.add(body, tip);
    this.toolSwitch = new THREE.Group();  // the legend shows and hides this one, frames the inner one
    this.toolSwitch.add(this.tool);
    this.group.add(this.toolSwitch);
  }

  /** Geometries of a frame, decoded when first looked at. */
  skin(k) {
    if (!this.skins[k]) {
      const frame = this.scene.frames[k];
      const positions = new THREE.BufferAttribute(decodePositions(this.scene, frame.positions), 3);
      const part = (text) => {
        const geometry = new THREE.BufferGeometry();
        geometry.setAttribute("position", positions);
        geometry.setIndex(new THREE.BufferAttribute(decodeIndices(this.scene, text), 1));
        geometry.computeVertexNormals();
        return geometry;
      };
      this.skins[k] = {outer: part(frame.outer), kerf: part(frame.kerf)};
    }
    return this.skins[k];
  }

  showFrame(k) {
    const frame = this.scene.frames[k];
    const {outer, kerf} = this.skin(k);
    this.outer.geometry = this.outerLines.geometry = outer;
    this.kerf.geometry = this.kerfLines.geometry = kerf;
    this.tool.visible = Boolean(frame.tip);
    if (frame.tip) {
      this.tool.position.set(...frame.tip);
      const up = new THREE.Vector3(...frame.axis).negate().normalize();
      this.tool.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), up);
    }
    const time = frame.time_s.toFixed(2) + " s";
    this.clock.replaceChildren(time, element("small", {textContent: frame.phase}));
    this.slider.value = k;
    this.slider.setAttribute("aria-valuetext", `${time}, ${frame.phase}`);
    this.viewer.render();
  }

  playerRow(which) {
    const count = this.scene.frames.length;
    this.slider = element("input", {type: "range", min: 0, max: count - 1, step: 1, value: count - 1,
                                    "aria-label": "Time in the cut", oninput: () => {
                                      this.stop();
                                      this.showFrame(Number(this.slider.value));
                                    }});
    this.playButton = element("button", {type: "button", className: "play", textContent: "▶ Play",
                                         onclick: () => (this.timer ? this.stop() : this.play())});
    const row = element("div", {className: "row"});
    if (this.animations.length > 1) {
      this.animations.forEach((animation, k) => row.append(element("button", {
        type: "button", textContent: animation.name, "aria-pressed": String(k === which),
        onclick: () => this.show(k)})));
    }
    row.append(this.playButton, this.slider);
    if (this.scene.total_frames > count) {
      row.append(element("span", {className: "hint", textContent: `${count} of ${this.scene.total_frames} frames`}));
    }
    return row;
  }

  play() {
    const count = this.scene.frames.length;
    if (Number(this.slider.value) === count - 1) this.showFrame(0);
    this.playButton.textContent = "❚❚ Pause";
    this.timer = setInterval(() => {
      const next = Number(this.slider.value) + 1;
      if (next >= count) this.stop();
      else this.showFrame(next);
    }, Math.max(80, Math.min(400, 6000 / count)));
  }

  stop() {
    clearInterval(this.timer);
    this.timer = null;
    if (this.playButton) this.playButton.textContent = "▶ Play";
  }

  legendRow() {
    const row = element("div", {className: "row"});
    const viewer = this.viewer;
    const add = (...rest) => row.append(legendSwitch(viewer, ...rest));
    add("tissue", "#db9a8f", [this.outer], true, true);
    add("kerf", "#9c1f24", [this.kerf], true, true);
    for (const line of this.scene.lines) {
      const tubes = curveTubes(line.points, line.closed, line.color, 0.24);
      this.group.add(...tubes);
      add(line.label, line.color, tubes, true);
    }
    if (this.scene.frames.some((frame) => frame.tip)) add("needle", "#8d979f", [this.toolSwitch], true);
    add("element edges", "#5a2b27", [this.outerLines, this.kerfLines], false);
    return row;
  }
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
