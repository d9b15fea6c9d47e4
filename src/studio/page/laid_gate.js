// The gate of a program that was laid on the measured tissue: of the incision, or of the mark along the tumour's edge.

import {h} from "preact";
import {state, update} from "./store.js";
import {kLaid, layAccepting} from "./actions.js";
import {Gate} from "./gate.js";

const kFileNames = {incise: "incise_on_tissue.script", mark: "program_mark.script"};

/** {of, result, accepted}: the state's name for what was laid, what it is or null, and what was accepted of it. */
export function laidOf(kind) {
  const {as: of, accepted} = kLaid[kind];
  return {of, result: state[of], accepted: state[accepted]};
}

/** The gate of what was laid. @param kind  "incise" or "mark"   @param title  of the section */
export function LaidGate({kind, title}) {
  const {result, accepted} = laidOf(kind);
  return h(Gate, {
    result,
    accepted,
    onAccept: (ids) => update({[kLaid[kind].accepted]: ids}),
    onAgain: () => layAccepting(kind),
    title,
    fileName: kFileNames[kind],
    again: kind === "mark" ? "Lay the mark again" : "Lay it again",
    call: state.layKind === kind ? "lay" : "", // the other one's problem is not this one's
    isBusy: Boolean(state.busy.lay),
  });
}
