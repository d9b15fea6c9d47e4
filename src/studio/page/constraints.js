// The case's constraints as a person writes them, and how they are stored.

import {setting} from "./store.js";
import {change} from "./actions.js";
import {kDirections} from "./geometry.js";

/** The key of the constraints. */
export const kConstraints = "specimen.constraints";

/** The words for directions. */
export const kWords = Object.keys(kDirections);

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
  return list && list.map(asWritten);
}

/** Stores the constraints. Without any the case is as before the first: held by the default. */
export function putConstraints(list) {
  change({[kConstraints]: list.length ? list : null});
}
