// How the planned path is called and drawn: one of earlier settings is not to be taken for that of the case as it is.

import {isFresh} from "./store.js";
import {intended, isDark} from "./colours.js";

/** Whether the path of a plan is a ring; true without a plan. */
export function isRing(plan) {
  return !(plan && plan.path) || plan.path.closed !== false;
}

/** {isNow, label, colour, dash}; `dash`: px, empty for a whole line. */
export function lookOfPlan() {
  if (isFresh("plan")) return {isNow: true, label: "planned path", colour: intended(), dash: []};
  return {isNow: false, label: "path of earlier settings", colour: isDark() ? "#a7afb6" : "#565d65", dash: [6, 4]};
}
