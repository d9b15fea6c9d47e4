// Programs are of one case and of what a person accepted about it: a change of the case withdraws them.

import {h} from "preact";
import {state, update, isFresh, when} from "./store.js";

const kResults = ["run", "lay", "mark"];

// A change that is taken back does not bring a program back, and the arm plays none of another case.
when(() => [state.case, state.arm, ...kResults.map((name) => state[name])], withdraw);

function withdraw() {
  const past = kResults.filter((name) => state[name] && state[name].program && !isFresh(name));
  for (const name of past) update({[name]: {...state[name], program: null, isWithdrawn: true}});
  if (state.arm && !isFresh("arm")) update({arm: null});
}

/** Whether a result is of the case as it is and as it is about to be. @param of  "run", "lay", "mark" or "register" */
export function isCurrent(of) {
  return isFresh(of) && !state[of].isWithdrawn && !Object.keys(state.drafts).length;
}

const kWithdrawn = {
  run: "The case was changed after this run. Run again for a program of the case as it is now.",
  lay: "The case was changed after the incision was laid. Run again, then lay it again.",
  mark: "The case was changed after the mark was laid. Run again, then lay it again.",
};

/** In place of the program of a result that is not current. @param of  as of isCurrent */
export function Withdrawn({of}) {
  return h("p", {class: "warning", "data-withdrawn": of}, kWithdrawn[of]);
}
