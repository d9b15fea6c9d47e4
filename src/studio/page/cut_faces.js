// The region box: where a new one lies, and which part of the skin it has made by cutting through tissue.

import {setting} from "./store.js";
import {skinMesh} from "./things.js";

/** The box [low, high] about a grid's voxels, mm. */
export function boundsOfGrid({size, spacing_mm: spacing, origin_mm: origin, axes}) {
  const ends = origin.map((start, world) => {
    const reach = axes.map((axis, k) => [-0.5 * spacing[k] * axis[world], (size[k] - 0.5) * spacing[k] * axis[world]]);
    return [Math.min, Math.max].map((pick) => reach.reduce((sum, pair) => sum + pick(...pair), start));
  });
  return [0, 1].map((side) => ends.map((pair) => pair[side]));
}

/** An interval of whole numbers about a value, so long and clipped to [low, high]. */
export function spanAt(value, length, [low, high]) {
  const ends = [Math.round(value - length / 2), Math.round(value + length / 2)];
  return [Math.max(Math.ceil(low), ends[0]) + 0, Math.min(Math.floor(high), ends[1]) + 0]; // no -0
}

const kColour = "#6f7b86"; // as a cut through stone: no tissue's colour

let memo = {skin: null, key: "", parts: null};

/** The found tissue's skin in two parts, {own, cut}: its own surface, and what lies on the faces of the region box. The
 *  same objects for as long as skin and box are the same; `cut` is null where the box cuts through no tissue. */
export function tissueParts({skin, grid}) {
  const box = setting("ct.roi_box_mm"),
    key = JSON.stringify(box);
  if (memo.skin !== skin || memo.key !== key)
    memo = {skin, key, parts: box ? split(skin, box, Math.max(...grid.spacing_mm)) : {own: skin, cut: null}};
  return memo.parts;
}

/** The layer of the part that the box has cut. */
export function cutLayer(cut) {
  if (!cut) return null;
  return {
    name: "cut-faces",
    label: "cut by the region box",
    colour: kColour,
    isArea: true,
    parts: [cut],
    build: () => [skinMesh(cut, {colour: kColour, opacity: 1})],
  };
}

function split({vertices, triangles}, box, reach) {
  const faces = facesNear(vertices, box, reach);
  const own = [],
    cut = [];
  for (let t = 0; t < triangles.length; t += 3) {
    const corners = triangles.subarray(t, t + 3);
    const isOnFace = (faces[corners[0]] & faces[corners[1]] & faces[corners[2]]) !== 0;
    (isOnFace ? cut : own).push(...corners);
  }
  const part = (list) => ({vertices, triangles: Uint32Array.from(list)});
  return {own: part(own), cut: cut.length ? part(cut) : null};
}

// For each vertex, bit 2 * axis + side is set where it is within a voxel of that face.
function facesNear(vertices, box, reach) {
  const faces = new Uint8Array(vertices.length / 3);
  for (let i = 0; i < vertices.length; ++i) {
    const axis = i % 3;
    for (const side of [0, 1]) {
      if (Math.abs(vertices[i] - box[side][axis]) <= reach) faces[(i - axis) / 3] |= 1 << (2 * axis + side);
    }
  }
  return faces;
}
