// Numbers and names as a person reads them.

const kUnitAtEnd = /_(mm_s2|kpa_mm2|mm_s|mm3|mm2|mm|hu|kpa|deg|s|w)$/;

/** A length in mm with two decimals and its unit; a dash where there is none. */
export function mm(value) {
  return isNumber(value) ? `${fixed(value, 2)} mm` : "–";
}

/** A coordinate in mm with one decimal, without its unit. */
export function place(value) {
  return fixed(value, 1);
}

/** A number with so many decimals and a true minus sign; never "−0". */
export function fixed(value, digits) {
  const text = value.toFixed(digits);
  return Number(text) === 0 ? text.replace("-", "") : text.replace("-", "−");
}

/** A number for an input: at most four decimals, no needless zeros. */
export function plain(value) {
  return isNumber(value) ? String(Number(value.toFixed(4))) : "";
}

/** About how long something takes: "9 s", "3 min". */
export function duration(seconds) {
  if (!isNumber(seconds)) return "";
  return seconds < 90 ? `${Math.max(1, Math.round(seconds))} s` : `${Math.round(seconds / 60)} min`;
}

/** A whole number with narrow spaces between thousands. */
export function whole(value) {
  return Math.round(value).toLocaleString("en").replaceAll(",", "\u202f");
}

/** Bytes as "12.3 MB". */
export function size(bytes) {
  if (!isNumber(bytes)) return "";
  const k = bytes < 1000 ? 0 : bytes < 1e6 ? 1 : bytes < 1e9 ? 2 : 3;
  return `${(bytes / 1000 ** k).toFixed(k ? 1 : 0)} ${["B", "kB", "MB", "GB"][k]}`;
}

/** Whether a value is a finite number. */
export function isNumber(value) {
  return typeof value === "number" && Number.isFinite(value);
}

/** Whether a setting's name ends in a unit. */
export function hasUnitInName(key) {
  return kUnitAtEnd.test(key);
}

/** The name of a setting for a person: "plan.lateral_margin_mm" is "Lateral margin". */
export function nameOf(key) {
  const words = key.split(".").pop().replace(kUnitAtEnd, "").replaceAll("_", " ");
  return words.charAt(0).toUpperCase() + words.slice(1);
}

/** A word of the interface with a capital and spaces: "open_layer" is "Open layer". */
export function spoken(word) {
  return word ? nameOf(String(word)) : "";
}

/** How many reasons a verdict has, above their list. */
export function countText({reasons = []}) {
  if (!reasons.length) return "No reason against it is known.";
  return `${reasons.length} ${reasons.length === 1 ? "reason" : "reasons"}, worst first.`;
}

/** The steps' titles by name, in their order. */
export const kStepTitles = {
  open: "Open",
  see: "See",
  edge: "Tumour edge",
  hold: "Hold",
  plan: "Plan",
  run: "Run",
  compare: "Compare",
  photograph: "Photograph",
  register: "Register",
  program: "Program",
};

/** What a person can do about each reason of a verdict, by its id (docs/models/verdict.md lists them), and where. */
export const kWaysOut = {
  outcome: ["Step Run lists what happened. A smaller pull, a finer mesh or another place may help.", "run", "hold"],
  tumor_distance: [
    "Raise the lateral margin. If the tumour's surface belongs to another edge, remove it from the case.",
    "plan",
    "edge",
  ],
  lateral_margin: [
    "Raise the lateral margin: step Plan says how much fits on this skin. A smaller pull deforms the tissue less.",
    "plan",
    "hold",
  ],
  simulated_margin: [
    "Simulation and photographs disagree about the margin. Raise the lateral margin, or accept the caution if the " +
      "photographs are of cuts like this one.",
    "plan",
  ],
  open_layer: [
    "An open layer: at that depth the ring does not close, so a bridge of tissue still holds the piece. Raise the " +
      "overlap, or make the mesh finer.",
    "plan",
    "hold",
  ],
  contour_surface: ["Draw the tumour's edge again, or remove the tumour's surface from the case.", "edge"],
  contour_flipped: ["Draw the tumour's edge here, or save its file again with its coordinate system.", "edge"],
  platform: ["Plan a smaller depth, or lower the support under the tissue.", "plan", "hold"],
  cut_face: [
    "Move the region box outwards, take away what lies behind its face with the brush, draw the edge elsewhere, or " +
      "use a smaller margin.",
    "see",
    "edge",
    "plan",
  ],
  painted_skin: ["Draw the edge on skin that the scan shows, or remove the strokes of the brush there.", "edge", "see"],
  program_check: [
    "The program's checks name what failed. Most depend on the place under the robot, the depth or the speed.",
    "program",
    "plan",
  ],
  photo_oblique: ["Photograph the cut again, with the camera straight above it.", "photograph"],
  photo_lens: ["Correct the photograph for its lens, or take it again from farther away.", "photograph"],
  depth: ["Plan a greater depth. The tool then drags more tissue along.", "plan"],
  heat: ["Use less power, a higher speed or a greater lateral margin.", "plan"],
  typed_transform: ["Register the tissue under the robot's camera, or measure its place and accept this.", "register"],
  not_simulated: ["Run the case, so that a simulated cut is known for this path.", "run"],
  not_corrected: ["Compare both cuts. A person can accept the path without a correction.", "compare", "program"],
  eligibility: ["The assessment says why. A person can accept the path in spite of it.", "program"],
  registration: ["Register again: a cloud with more of the surface, and with nothing else in it.", "register"],
  cut_rule: ["Set what is cut to whole tetrahedra, or accept this and compare the cut with a real one.", "plan"],
  mesh_resolution: ["Make the mesh finer: more tetrahedra, or a shorter fine edge.", "hold"],
  locking: ["Under Tissue, let the change of volume be averaged, or lower Poisson's ratio.", "hold"],
  convergence: ["A finer mesh or a smaller pull may help.", "hold"],
  photo_scale: ["Give the scale over a longer part of the ruler.", "photograph"],
  photo_specimen: ["Choose the photograph of this specimen, or draw the tumour's edge on it by hand.", "photograph"],
  photo_ring: ["Draw the tumour's edge on the photograph by hand.", "photograph"],
  scan: [
    "Check the region box, the seed and the brush. If the specimen touches another body, as the tongue touches the " +
      "palate, run the brush along the gap between them: take tissue away with a large radius. Values on a wrong " +
      "scale need a new case with other numbers.",
    "see",
    "open",
  ],
};
