"use strict";
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

/** The largest of 1, 2, 5 times a power of ten that is not above the value. */
function roundedDown(value) {
  const decade = Math.pow(10, Math.floor(Math.log10(value)));
  return [5, 2, 1].map((factor) => factor * decade).find((round) => round <= value * (1 + 1e-9));
}
