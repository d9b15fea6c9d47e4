// The colours of what has one meaning everywhere, as in the report; safe for colour-blind people (Okabe and Ito).

/** CSS colours by meaning. On the black ground of a slice the lighter ones of `onBlack` are used. */
export const ink = {
  tissue: "#db9a8f",
  kerf: "#e69f00",
  tumour: "#009e73",
  corrected: "#0072b2",
  reached: "#b3123f",
  tool: "#8d979f",
};
export const onBlack = {
  tissue: "#56b4e9",
  box: "#f0a818",
  seed: "#f0e442",
  tumour: "#2fd6a3",
  cross: "#b8c4cc",
  add: "#56b4e9",
  take: "#ff8a5c",
  words: "#d7dde2",
};

/** On a photograph, where red and green are the inks: as in the figure of `incise evaluate`. */
export const onPhoto = {
  tumour: "#35d7f5",
  incision: "#ffffff",
  scale: "#f0e442",
  handle: "#ffd9a8",
  chosen: "#ff9d00",
  words: "#f4f6f7",
  border: "#000a",
};

/** Colours of a case's constraints, by their place in the list; they start again after the last. */
export const holds = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00"];

/** @returns whether the person asked for a dark page. */
export function isDark() {
  return window.matchMedia("(prefers-color-scheme: dark)").matches;
}

/** The colour of the intended path: black, or nearly white on a dark page. */
export function intended() {
  return isDark() ? "#f2f4f5" : "#111111";
}

/** Red, green and blue of "#rrggbb", each in 0..255. */
export function rgbOf(colour) {
  return [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
}

// From below through none to above: blue, grey and vermilion, which nobody's colour vision mixes up.
const kScale = ["#00456b", "#0072b2", "#74b3d8", "#e3e3e0", "#f0a070", "#d55e00", "#7f3800"].map(rgbOf);

/** Of a point without a residual. */
export const kUnseen = "#8a9097";

/** The colour of a share in -1..1 of the scale for residuals: red, green and blue, each in 0..255. */
export function scaleColour(share) {
  const at = (0.5 + 0.5 * Math.max(-1, Math.min(1, share))) * (kScale.length - 1),
    k = Math.min(Math.floor(at), kScale.length - 2);
  return kScale[k].map((value, c) => value + (at - k) * (kScale[k + 1][c] - value));
}
