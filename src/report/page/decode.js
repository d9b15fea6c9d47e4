"use strict";
// What the page's views share: numbers from text, elements, and the viewer with its legend.

const kTissueColor = 0xdb9a8f;
const kKerfColor = 0x9c1f24;

// Numbers travel as base64 of little-endian integers, which is how every machine that runs a browser stores them.

function bytesOf(text) {
  const raw = atob(text);
  const bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
  return bytes;
}

/** Positions in mm: 16-bit steps within the scene's box. */
function decodePositions(scene, text) {
  const steps = new Uint16Array(bytesOf(text).buffer);
  const positions = new Float32Array(steps.length);
  for (let i = 0; i < steps.length; ++i) positions[i] = scene.low[i % 3] + scene.step_mm[i % 3] * steps[i];
  return positions;
}

/** Vertex numbers, 16 or 32 bits each as the scene says. */
function decodeIndices(scene, text) {
  const buffer = bytesOf(text).buffer;
  return scene.index_bytes === 2 ? new Uint16Array(buffer) : new Uint32Array(buffer);
}

/** An element with properties and children: element("label", {className: "x"}, box, "text"). */
function element(name, properties, ...children) {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(properties || {})) {
    if (key.includes("-") || key === "role") node.setAttribute(key, value);
    else node[key] = value;
  }
  node.append(...children);
  return node;
}

/** A viewer in a stage, in place of the still picture. @param frame  {x, y, z, ends}: the picture's axes seen along the
 *  approach, and the names of the world axes' ends */
function newViewer(stage, frame) {
  const viewer = new Viewer(THREE, stage, {
    gizmo: new Gizmo(frame.ends), names: ["Oblique", "Top", "Front", "Side"], basis: [frame.x, frame.y, frame.z],
    barLength: 150, scrolls: true});
  stage.classList.add("live");
  return viewer;
}

/** Buttons for the named views and a word on the mouse. */
function viewRow(viewer) {
  return element("div", {className: "row"},
    ...viewer.names.map((name) =>
      element("button", {type: "button", textContent: name, onclick: () => viewer.look(name)})),
    element("span", {className: "hint", textContent:
      "drag: turn · shift-drag: move · wheel after a click: zoom · arrow keys, + and − work, too"}));
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
