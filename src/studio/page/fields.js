// The settings by the names that the page gives them: the label of each input, and the step that has it.

import {state, unitOf, valueAt} from "./store.js";
import {hasUnitInName, isNumber, kStepTitles, nameOf} from "./words.js";

const kAutomatic = "automatic";

// Settings with an input of their own. `label`: where the key does not give one; `said`: in messages;
// `whenEmpty`: of one that may be empty.
const kFields = {
  "ct.spacing_mm": {step: "open", label: "Spacing", said: "Spacing of a new case"},
  "ct.hu": {step: "open", label: "HU from grey value", said: "HU from grey value, of a new case"},
  "ct.window_hu": {step: "see", label: "Tissue", said: "Which values are tissue"},
  "ct.label_values": {step: "see", label: "Which labels are tissue"},
  "ct.roi_box_mm": {step: "see", label: "Region box"},
  "ct.seed_mm": {step: "see", label: "Seed"},
  "ct.opening_radius_mm": {step: "see"},
  "ct.smoothing_mm": {step: "see", whenEmpty: kAutomatic},
  "ct.edits": {step: "see", label: "Brush"},
  "tumor.contour": {step: "edge", label: "Tumour's edge"},
  "tumor.surface": {step: "edge", label: "Tumour's surface"},
  "tumor.configuration": {step: "edge", label: "Drawn on"},
  "specimen.constraints": {step: "hold", label: "Held by"},
  "specimen.constraints.displacement_mm": {step: "hold", label: "Displacement"},
  "specimen.constraints.within_mm": {step: "hold", label: "Within"},
  "specimen.gravity_mm_s2": {step: "hold"},
  "robot.T_robot_sim": {step: "plan", label: "Place under the robot"},
};

// Groups whose every setting has an input.
const kGroups = {
  meshing: {step: "hold"},
  "specimen.material": {step: "hold"},
  plan: {step: "plan"},
  cut: {step: "plan", of: "simulated cut"},
  tool: {step: "plan", of: "tool"},
  thermal: {step: "plan", of: "heat"},
};

const kLabels = {
  "meshing.tets": {label: "Tetrahedra, about", said: "Tetrahedra of the mesh"},
  "meshing.fine_mm": {label: "Edge near the cut", whenEmpty: kAutomatic},
  "meshing.coarse_mm": {label: "Edge far from the cut", whenEmpty: kAutomatic},
  "meshing.survey_mm": {label: "Edge of the first, coarse mesh", whenEmpty: kAutomatic},
  "specimen.material.model": {label: "Law of elasticity"},
  "specimen.material.volume": {
    label: "Change of volume",
    words: {per_tet: "Tet by tet", averaged: "Averaged"},
  },
  "specimen.material.youngs_modulus_kpa": {label: "Young's modulus"},
  "specimen.material.poissons_ratio": {label: "Poisson's ratio"},
  "specimen.material.density_kg_m3": {label: "Density"},
  "specimen.material.stiffening": {label: "Stiffening of the tissue"},
  "specimen.material.fibre_modulus_kpa": {label: "Fibre stiffness"},
  "specimen.material.fibre_stiffening": {label: "Stiffening of the fibres"},
  "specimen.material.kelvin_voigt_time_s": {label: "Viscosity"},
  "plan.lateral_margin_mm": {hint: "From the tumour's edge to the middle of the cut."},
  "plan.depth_mm": {hint: "Of the tool's tip below the skin. The deeper, the less energy each area of the cut gets."},
  "plan.speed_mm_s": {hint: "Of the robot. The faster, the less energy each area of the cut gets."},
  "plan.approach": {hint: "Into the tissue, as one looks at it: 0, 0, −1 is straight down."},
  "plan.start_direction": {hint: "The ring starts where it lies farthest along this."},
  "plan.close_margin_mm": {hint: "Less tissue than this beside the tumour is refused."},
  "cut.speed_mm_s": {
    label: "Simulated speed",
    said: "Simulated speed",
    hint: "Of the simulated tool. Calibration fits it, with the dullness, to photographs of cuts.",
  },
  "cut.rule": {label: "What is cut", words: {tets: "Whole tetrahedra", lattice: "Points of a lattice", paper: "As the paper does it"}},
  "cut.dullness": {hint: "How long contact lasts before tissue is cut."},
  "cut.overlap_mm": {hint: "The ring is cut so far beyond its start."},
  "thermal.conductivity_w_m_k": {label: "Conductivity"},
  "thermal.heat_capacity_mj_m3_k": {label: "Heat capacity"},
  "thermal.body_c": {label: "Temperature of the tissue"},
  "thermal.damage_c": {label: "Temperature of damage"},
  "thermal.absorbed_fraction": {label: "Share of the power that heats tissue"},
  "tool.thickness_mm": {whenEmpty: kAutomatic},
  "tool.width_mm": {whenEmpty: kAutomatic},
  "cut.tear_energy_kpa": {whenEmpty: "never tears"},
  "cut.slip_mm": {whenEmpty: "never slips"},
};

// Options of the command that messages name: what does the same here.
const kOptions = {
  "--accept": {step: "program", label: "the boxes of the cautions"},
  "--mm-per-pixel": {step: "photograph", label: "Found from: mm per pixel"},
  "--two-points": {step: "photograph", label: "Found from: two points and their distance"},
  "--ruler": {step: "photograph", label: "Found from: a ruler's ticks, or a scale bar"},
  "--ruler-mm": {step: "photograph", label: "From one finest tick to the next"},
  "--max-gap-mm": {step: "photograph", label: "Greatest gap of a closed line"},
  "--scale": {step: "register", label: "Scale"},
};

/** A setting's place on the page: {step, label, said, of, whenEmpty, hint, words}; null where no step has an input
 *  for it. `of`: what the label is about, where another setting has the same one; `words`: of its choices. */
export function fieldOf(key) {
  const plainKey = key.replaceAll(/\[\d+\]/g, ""),
    group = plainKey.slice(0, plainKey.lastIndexOf("."));
  const found = kFields[plainKey] || (rowsOf(group).includes(plainKey) ? kGroups[group] : null);
  return found && {label: nameOf(plainKey), ...found, ...kLabels[plainKey]};
}

/** The settings of a group that have an input. */
export function rowsOf(group) {
  const {settings, inputs = {}} = state.case || {};
  if (!settings || !kGroups[group]) return [];
  const hasMesh = Boolean(inputs["specimen.mesh"]),
    isBlade = settings.tool.kind === "blade";
  return Object.entries(valueAt(settings, group) || {})
    .map(([name, value]) => [`${group}.${name}`, value])
    .filter(([key, value]) => !(key in inputs) && isSimple(value) && (Boolean(unitOf(key)) || !hasUnitInName(key)))
    .filter(([key]) => !kGroupsThatMayBeAbsent.includes(key))
    .filter(([key]) => (hasMesh || !key.endsWith("from_mesh")) && (isBlade || !kOfBlade.includes(key)))
    .map(([key]) => key);
}

const kGroupsThatMayBeAbsent = ["specimen.material.fibre_field"];
const kOfBlade = ["tool.thickness_mm", "tool.width_mm"];

// Whether one input can hold a value.
function isSimple(value) {
  return value === null || typeof value !== "object" || (value.length > 0 && value.length < 5 && value.every(isNumber));
}

const kPerson = /^(?:Young|Poisson)'s/; // with a capital everywhere

/** A setting's label within a sentence: 'lateral margin', "Young's modulus". */
export function nameInText(key) {
  const {label} = fieldOf(key) || {label: nameOf(key)};
  return kPerson.test(label) ? label : label.charAt(0).toLowerCase() + label.slice(1);
}

/** A field as a message says it: 'Dullness of the simulated cut, step Plan'. */
export function fieldText({label, said, of, step}) {
  return [said || (of ? `${label} of the ${of}` : label), step === state.step ? "" : `step ${kStepTitles[step]}`]
    .filter(Boolean)
    .join(", ");
}

const kWord = /--[a-z]+(?:-[a-z]+)*|[a-z][A-Za-z]*(?:[._][A-Za-z_\d[\]]+)+/g;

/** A message in parts: [{text, field}], with a field after each text that ends with the key of one, with its last part,
 *  or with an option of the command. */
export function partsOf(message) {
  const parts = [];
  let done = 0;
  for (const match of message.matchAll(kWord)) {
    const end = match.index + match[0].length,
      field = kOptions[match[0]] || nearestField(match[0]);
    if (!field) continue;
    parts.push({text: message.slice(done, end), field});
    done = end;
  }
  return [...parts, {text: message.slice(done), field: null}];
}

// Of a key, or of the setting that it is a part of.
function nearestField(word) {
  const whole = word.includes(".") ? word : Object.keys(kFields).find((key) => key.endsWith(`.${word}`));
  for (let key = whole; key; key = key.slice(0, Math.max(0, key.lastIndexOf(".")))) {
    const field = fieldOf(key);
    if (field) return field;
  }
  return null;
}

/** The setting that a problem is about, as fieldOf() gives it, or null. */
export function fieldOfProblem({path}) {
  return path ? nearestField(path) : null;
}
