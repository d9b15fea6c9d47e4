// The found tissue's skin in two parts: its own surface, and where the region or the scan's end has cut through it.

import {skinMesh} from "./things.js";

const kColour = "#6f7b86"; // as a cut through stone: no tissue's colour

let memo = {skin: null, parts: null};

/** The skin in two parts, {own, cut}: the same objects for as long as the skin is the same one. `cut` is null where
 *  nothing was cut. */
export function tissueParts({skin, cut}) {
  if (memo.skin !== skin) memo = {skin, parts: split(skin, cut)};
  return memo.parts;
}

/** The layer of the part that was cut. */
export function cutLayer(cut) {
  if (!cut) return null;
  return {
    name: "cut-faces",
    label: "cut off by the region or scan",
    colour: kColour,
    isArea: true,
    parts: [cut],
    build: () => [skinMesh(cut, {colour: kColour, opacity: 1})],
  };
}

// @param isCut  1 for each triangle that was cut, else 0
function split(skin, isCut) {
  if (!isCut.includes(1)) return {own: skin, cut: null};
  const part = (flag) => ({...skin, triangles: skin.triangles.filter((_, i) => isCut[Math.floor(i / 3)] === flag)});
  return {own: part(0), cut: part(1)};
}
