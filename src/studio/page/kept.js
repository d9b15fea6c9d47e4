// Results of the run that are kept on this page, to lay later ones over them: what they are called, how they are drawn.

import {state, isSame, unitOf} from "./store.js";
import {nameInText} from "./fields.js";
import {minus, plus, length, pointsOf} from "./geometry.js";
import {isDark} from "./colours.js";
import {isNumber, plain, spoken} from "./words.js";

/** How many results are kept at most. */
export const kMostKept = 4;

// Colours that stay apart for colour-blind people, on both grounds and from the cuts' own; each has a dash of its own.
const kLooks = {
  A: {light: "#a3267a", dark: "#f08cc4", dash: [9, 3]},
  B: {light: "#b84700", dark: "#ff9155", dash: [2, 3]},
  C: {light: "#5b3fa8", dark: "#b9a1ff", dash: [10, 3, 2, 3]},
  D: {light: "#6f6200", dark: "#e3d64b", dash: [5, 3]},
};

// Names and the format's version: no result depends on them.
const kIdle = ["schema", "title", "specimen_id"];

/** The first letter that no kept result has; undefined where there are as many as can be. */
export function freeLetter(kept) {
  return Object.keys(kLooks).find((letter) => !kept.some((one) => one.letter === letter));
}

/** {colour, dash} of a kept result. */
export function lookOf({letter}) {
  const {light, dark, dash} = kLooks[letter];
  return {colour: isDark() ? dark : light, dash};
}

/** What a result was computed on, as a text: results of the same case, tissue, mesh and tumour's edge have the same. */
export function basisOf({file, inputs, edge, settings}) {
  const {ct, meshing, tumor} = settings;
  return JSON.stringify([file, inputs, edge, ct, meshing, tumor]);
}

// --- Settings. ---

// [key, value] of each setting; a list is one value.
function leavesOf(settings, stem = "") {
  return Object.entries(settings).flatMap(([key, value]) =>
    value !== null && typeof value === "object" && !Array.isArray(value)
      ? leavesOf(value, `${stem}${key}.`)
      : kIdle.includes(stem + key)
        ? []
        : [[stem + key, value]],
  );
}

/** {key: value} of the settings that have to be changed to get from some to others. */
export function differences(from, to) {
  const [before, after] = [from, to].map((settings) => Object.fromEntries(leavesOf(settings)));
  const keys = [...new Set([...Object.keys(before), ...Object.keys(after)])];
  const isSame = (key) => JSON.stringify(before[key] ?? null) === JSON.stringify(after[key] ?? null);
  return Object.fromEntries(keys.filter((key) => !isSame(key)).map((key) => [key, after[key] ?? null]));
}

/** Whether two results have the same settings. */
export function isAlike(one, other) {
  return one.basis === other.basis && !Object.keys(differences(one.settings, other.settings)).length;
}

/** Whether a result with the settings of this one is kept. */
export function isKept(result) {
  return state.kept.some((one) => isAlike(one, result));
}

/** The kept results that are to be laid over the one that is shown: not that one itself. */
export function laidOver() {
  return state.kept.filter((one) => !state.run || !isAlike(one, state.run));
}

/** A result by those of its settings in which the kept ones, the one that is shown and the case differ. */
export function labelOf({settings}) {
  const all = [state.case.settings, state.run && state.run.settings, ...state.kept.map((one) => one.settings)];
  const others = all.filter((one) => one && one !== settings);
  const keys = new Set(others.flatMap((one) => Object.keys(differences(settings, one))));
  const values = Object.fromEntries(leavesOf(settings)),
    order = Object.keys(values);
  const sorted = [...keys].sort((a, b) => order.indexOf(a) - order.indexOf(b));
  return sorted.map((key) => wordsOf(key, values[key] ?? null)).join(", ");
}

function wordsOf(key, value) {
  const name = nameInText(key),
    unit = unitOf(key);
  if (isNumber(value)) return [name, plain(value), unit].filter(Boolean).join(" ");
  if (value === null) return `${name} as by default`;
  if (typeof value === "boolean") return `${name}: ${value ? "yes" : "no"}`;
  if (typeof value === "string") return `${name}: ${spoken(value).toLowerCase()}`;
  if (Array.isArray(value) && value.length < 5 && value.every(isNumber))
    return `${name} ${value.map(plain).join(", ")}`;
  return `${name}: other`;
}

/** A kept result's letter, with what makes it different. */
export function titleOf(one) {
  return `${one.letter}: ${labelOf(one) || "the settings as they are now"}`;
}

// --- Curves. ---

/** A kept result's mid-line, as the contour view shows it. @param which  "as_planned" or "corrected" */
export function contourOf(one, which, isClosed) {
  const cut = one[which];
  if (!cut || pointsOf(cut.centerline).length < 2) return null;
  return {label: titleOf(one), letter: one.letter, ...lookOf(one), width: 2, points: cut.centerline, isClosed};
}

/** The corrected cut of a result; null where there is none, and where its path is the planned one: it is that cut. */
export function correctedOf({as_planned: before, corrected: after}) {
  return after && before && isSame(after.path, before.path) ? null : after;
}

/** The cut that plots and 3D view show of a kept result. */
export function shownCut(one) {
  return one[state.keptCut];
}

/** The parts of a line that a dash pattern, mm, leaves. */
export function dashesOf(points, isClosed, pattern) {
  const line = isClosed ? [...points, points[0]] : points,
    parts = [];
  let [part, k, left] = [[line[0]], 0, pattern[0]];
  line.slice(1).forEach((to, i) => {
    let from = line[i];
    for (let way = length(minus(to, from)); way > left; way = length(minus(to, from))) {
      from = plus(from, minus(to, from), left / way);
      if (k % 2 === 0) parts.push([...part, from]);
      [part, k] = [[from], (k + 1) % pattern.length];
      left = pattern[k];
    }
    left -= length(minus(to, from));
    part.push(to);
  });
  return k % 2 === 0 ? [...parts, part] : parts;
}
