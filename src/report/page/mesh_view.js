"use strict";
// The tetrahedral mesh, opened along a plane: whole elements stay or go, so that their sizes inside are seen.

/** For each face (4 * tet + corner opposite) the face of the neighbour that it touches, or -1. */
function neighboursOf(tets) {
  const faceCount = tets.length;
  const neighbours = new Int32Array(faceCount).fill(-1);
  let capacity = 1;
  while (capacity < 2 * faceCount) capacity *= 2;
  const table = new Int32Array(capacity).fill(-1);
  const keys = new Uint32Array(3 * faceCount);
  for (let face = 0; face < faceCount; ++face) {
    const first = face - face % 4;
    const corners = [];
    for (let k = 0; k < 4; ++k) if (first + k !== face) corners.push(tets[first + k]);
    const [a, b, c] = corners.sort((u, v) => u - v);
    keys.set([a, b, c], 3 * face);
    let place = (Math.imul(a, 73856093) ^ Math.imul(b, 19349663) ^ Math.imul(c, 83492791)) & (capacity - 1);
    for (; table[place] >= 0; place = (place + 1) & (capacity - 1)) {
      const other = table[place];
      if (keys[3 * other] === a && keys[3 * other + 1] === b && keys[3 * other + 2] === c) {
        neighbours[face] = other;
        neighbours[other] = face;
        break;
      }
    }
    if (table[place] < 0) table[place] = face;
  }
  return neighbours;
}

// Corners of the face opposite corner k, counter-clockwise seen from outside.
const kFaces = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

class MeshView {
  constructor(host, scene, frame) {
    this.host = host;
    this.viewer = newViewer(host.querySelector(".stage"), frame);
    this.ends = frame.ends;
    this.positions = decodePositions(scene, scene.positions);
    this.attribute = new THREE.BufferAttribute(this.positions, 3);
    this.tets = decodeIndices(scene, scene.tets);
    this.neighbours = neighboursOf(this.tets);
    this.low = scene.low;
    this.size = scene.step_mm.map((step) => 65535 * step);
    this.makeMeshes();
    this.makeControls(host.querySelector(".controls"));
    this.open();

    const ball = new THREE.Sphere().setFromPoints([new THREE.Vector3(...this.low),
      new THREE.Vector3(...this.low.map((low, k) => low + this.size[k]))]);
    this.viewer.fit(ball.center.toArray(), 0.8 * ball.radius);
    host.dataset.coverage = this.viewer.coverage().toFixed(3);
    host.dataset.viewerReady = `tets=${scene.tet_count} triangles=${this.outer.geometry.index.count / 3}`;
  }

  makeMeshes() {
    const look = {flatShading: true, shininess: 0, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1};
    const lines = new THREE.MeshBasicMaterial({color: 0x26323a, wireframe: true, transparent: true, opacity: 0.32});
    this.outer = new THREE.Mesh(undefined, new THREE.MeshPhongMaterial({...look, color: kTissueColor}));
    this.inner = new THREE.Mesh(undefined, new THREE.MeshPhongMaterial({...look, color: 0xf0d9a8}));
    this.outerLines = new THREE.Mesh(undefined, lines);
    this.innerLines = new THREE.Mesh(undefined, lines);
    this.viewer.scene.add(this.outer, this.inner, this.outerLines, this.innerLines);
  }

  /** Takes away the elements whose centre lies beyond the plane, on the side that faces the oblique view. */
  open() {
    const axis = Number(this.axisSelect.value);
    const plane = this.low[axis] + this.size[axis] * Number(this.slider.value) / 100;
    const side = this.viewer.axes("Oblique").towards.getComponent(axis) < 0 ? -1 : 1;
    const count = this.tets.length / 4;
    const isKept = new Uint8Array(count);
    for (let tet = 0; tet < count; ++tet) {
      let sum = 0;
      for (let k = 0; k < 4; ++k) sum += this.positions[3 * this.tets[4 * tet + k] + axis];
      isKept[tet] = side * (sum / 4 - plane) <= 1e-6 ? 1 : 0;
    }
    const outer = [], inner = [];
    for (let face = 0; face < this.tets.length; ++face) {
      const tet = face >> 2;
      if (!isKept[tet]) continue;
      const other = this.neighbours[face];
      if (other >= 0 && isKept[other >> 2]) continue;
      for (const corner of kFaces[face % 4]) (other < 0 ? outer : inner).push(this.tets[4 * tet + corner]);
    }
    this.replace([this.outer, this.outerLines], outer);
    this.replace([this.inner, this.innerLines], inner);
    this.slider.setAttribute("aria-valuetext", plane.toFixed(1) + " mm");
    this.label.textContent = `${"xyz"[axis]} = ${plane.toFixed(1)} mm`;
    this.viewer.render();
  }

  replace(meshes, corners) {
    if (meshes[0].geometry.index) meshes[0].geometry.dispose();
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", this.attribute);
    geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(corners), 1));
    for (const mesh of meshes) {
      mesh.geometry = geometry;
      mesh.frustumCulled = false;
    }
  }

  makeControls(controls) {
    const range = {type: "range", min: 0, max: 100, step: 1, value: 50};
    this.slider = element("input", {...range, "aria-label": "Place of the cutting plane", oninput: () => this.open()});
    this.axisSelect = element("select", {"aria-label": "Axis across the cutting plane", onchange: () => this.open()});
    [0, 1, 2].forEach((axis) => this.axisSelect.append(element("option", {
      value: axis, textContent: `${this.ends[2 * axis]} – ${this.ends[2 * axis + 1]}`})));
    this.axisSelect.value = 1;
    this.label = element("span", {className: "unit"});
    const row = element("div", {className: "row"}, "Open along ", this.axisSelect, this.slider, this.label);
    const legend = element("div", {className: "row"},
      legendSwitch(this.viewer, "surface", "#db9a8f", [this.outer], true, true),
      legendSwitch(this.viewer, "inside", "#f0d9a8", [this.inner], true, true),
      legendSwitch(this.viewer, "element edges", "#26323a", [this.outerLines, this.innerLines], true));
    controls.replaceChildren(row, legend, viewRow(this.viewer));
  }
}
