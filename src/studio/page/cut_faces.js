// A skin in parts: the tissue's own surface, where the region or the scan's end has cut through the tissue, and what
// strokes of the brush have made.

import {skinMesh} from "./things.js";

/** The colour of the cut: as a cut through stone, no tissue's. */
export const kCutColour = "#6f7b86";

/** The colour of skin that the brush made: light, so that the lines on it are seen; no colour vision mixes it up with
 *  the tissue, the cut or refusals. */
export const kPaintedColour = "#a8dcf8";

const kOwn = 0,
  kCut = 1,
  kPainted = 2;
const memo = new WeakMap(); // by skin: {cut, parts}

/** A skin in parts, {own, cut, painted}: the same objects for as long as both arguments are the same. `cut` and
 *  `painted` are null where there is nothing of the kind.   @param cut  of each triangle 1 where it was cut, 2 where the
 *  brush made it, else 0; null where that is not known */
export function partsOf(skin, cut) {
  const known = memo.get(skin);
  if (known && known.cut === cut) return known.parts;
  const parts = split(skin, cut);
  memo.set(skin, {cut, parts});
  return parts;
}

/** The layer of the part that was cut. */
export function cutLayer(cut) {
  return partLayer(cut, "cut-faces", "cut off by the region or scan", kCutColour);
}

/** The layer of the part that the brush made. */
export function paintedLayer(painted) {
  return partLayer(painted, "painted-skin", "skin that the brush made", kPaintedColour);
}

function partLayer(part, name, label, colour) {
  if (!part) return null;
  return {
    name,
    label,
    colour,
    isArea: true,
    parts: [part],
    build: () => [skinMesh(part, {colour, opacity: 1})],
  };
}

function split(skin, made) {
  if (!made || 3 * made.length !== skin.triangles.length || made.every((value) => value === kOwn))
    return {own: skin, cut: null, painted: null};
  const part = (value) => ({...skin, triangles: skin.triangles.filter((_, i) => made[Math.floor(i / 3)] === value)}),
    partOrNone = (value) => (made.includes(value) ? part(value) : null);
  return {own: part(kOwn), cut: partOrNone(kCut), painted: partOrNone(kPainted)};
}
