// The case's constraints as a person writes them, and how they are stored.

import {setting} from "./store.js";
import {change} from "./actions.js";
import {kDirections, length} from "./geometry.js";
import {plain, spoken} from "./words.js";

/** The key of the constraints. */
export const kConstraints = "specimen.constraints";

/** The words for directions, and how a person names that end of a body. */
export const kWords = Object.keys(kDirections);
const kEnds = {
  left: "left",
  right: "right",
  posterior: "back",
  anterior: "front",
  superior: "upper",
  inferior: "lower",
};

/** What a person calls a constraint, by its kind. */
export const kKinds = {fixed: "Clamp", displaced: "Pull", support: "Support", traction: "Force on the skin"};

/** A direction for a choice: "Back (posterior)". */
export function directionText(word) {
  return `${spoken(kEnds[word])} (${word})`;
}

/** Constraints as a case file has them, from the normal form in which the server returns them. */
export function written(list) {
  return list.map(asWritten);
}

/** A constraint in a sentence: "The back end (15 mm) is clamped: it stays where it is." */
export function inWords(constraint) {
  const {kind, where, displacement_mm: way, plane} = asWritten(constraint);
  const place = where ? placeInWords(where) : "";
  if (kind === "fixed") return `${place} is clamped: it stays where it is.`;
  if (kind === "displaced") return `${place} is pulled ${wayInWords(way)}, and held there.`;
  if (kind === "support")
    return plane
      ? "The tissue rests on a plane, which pushes on it and never pulls it."
      : "The tissue rests on a surface, which pushes on it and never pulls it.";
  return `${place} is pushed by a force.`;
}

function placeInWords(where) {
  const {end} = where;
  if (end && kEnds[end.direction]) return `The ${kEnds[end.direction]} end (${plain(end.within_mm)} mm)`;
  const kind = Object.keys(where)[0];
  return kPlaces[kind] || "A part of it";
}

const kPlaces = {box_mm: "What lies in a box", sphere: "What lies in a sphere", patch: "A painted patch"};

const kWays = {
  left: "to the left",
  right: "to the right",
  posterior: "backwards",
  anterior: "forwards",
  superior: "upwards",
  inferior: "downwards",
};

function wayInWords(way) {
  const along = kWords.filter((word) => kDirections[word].reduce((sum, value, k) => sum + value * way[k], 0) > 0);
  if (along.length !== 1) return `${plain(length(way))} mm`;
  return `${plain(length(way))} mm ${kWays[along[0]]}`;
}

// The server returns a constraint in its normal form, with the kind of each part; a case file takes it without these,
// and a person reads a direction better than its numbers.
function asWritten({kind, where, ...rest}) {
  const one = {kind: kind === "plane" || kind === "surface" ? "support" : kind};
  if (where) one.where = regionAsWritten(where);
  if (rest.plane) rest.plane = withWords(rest.plane);
  return {...one, ...rest};
}

function regionAsWritten(where) {
  const kind = where.kind || Object.keys(where)[0],
    value = where[kind];
  return {[kind]: value && typeof value === "object" && !Array.isArray(value) ? withWords(value) : value};
}

function withWords(group) {
  const given = Object.entries(group).filter(([, value]) => value !== null);
  return Object.fromEntries(
    given.map(([key, value]) => [key, key === "direction" || key === "normal" ? wordOf(value) : value]),
  );
}

function wordOf(direction) {
  const isSame = (word) => kDirections[word].every((value, k) => value === direction[k]);
  return Array.isArray(direction) ? kWords.find(isSame) || direction : direction;
}

/** The constraints, or null where the case has none and the default holds the body. */
export function constraints() {
  const list = setting(kConstraints);
  return list && written(list);
}

/** Stores the constraints. Without any the case is as before the first: held by the default. */
export function putConstraints(list) {
  change({[kConstraints]: list.length ? list : null});
}
