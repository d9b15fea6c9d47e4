// The parts of the run under way, as its progress events name them: what they do not say is not shown.

import {state, when} from "./store.js";

const [kPreparation, kPlanned, kPasses, kCorrected, kEnd] = [0, 1, 2, 3, 4];
const kPass = /^pass (\d+) of at most (\d+)$/;

/** Where the run is. `pass`, `most`: the last pass of the correction and their greatest number; 0 before the first. */
let at = {rank: kPreparation, pass: 0, most: 0};

function take(event) {
  if (!event) at = {rank: kPreparation, pass: 0, most: 0};
  else if (event.stage === "cutting") takeCut(event.part);
  else if (event.stage === "reading frames") at = {...at, rank: kEnd};
  else at = {rank: kPreparation, pass: 0, most: 0};
}

// The first event of a cut may have no part yet.
function takeCut(part) {
  const [, pass, most] = kPass.exec(part) || [];
  if (pass) at = {rank: kPasses, pass: Number(pass), most: Number(most)};
  else if (part === "as planned") at = {rank: kPlanned, pass: 0, most: 0};
  else if (part) at = {...at, rank: kCorrected};
}

when(
  () => [state.progress.run],
  () => take(state.progress.run),
);

/** What an estimate of the time left is about. */
export function wordForPart() {
  return {[kPlanned]: "cut", [kPasses]: "pass", [kCorrected]: "cut"}[at.rank] || "stage";
}

/** The parts in their order: [{name, is}], `is` one of "done", "now", "ahead" and "left out". */
export function partsOfRun() {
  const is = (rank) => (at.rank > rank ? "done" : at.rank === rank ? "now" : "ahead");
  const corrected = at.rank === kCorrected ? [{name: "Corrected", is: "now"}] : [];
  return [
    {name: "Preparation", is: is(kPreparation)},
    {name: "As planned", is: is(kPlanned)},
    ...passes(),
    ...corrected,
    {name: "Program and report", is: is(kEnd)},
  ];
}

function passes() {
  if (!at.most) return at.rank < kPasses ? [{name: "Passes of the correction", is: "ahead"}] : [];
  return Array.from({length: at.most}, (_, k) => ({name: `Pass ${k + 1}`, is: stateOfPass(k + 1)}));
}

function stateOfPass(number) {
  if (number < at.pass || (number === at.pass && at.rank > kPasses)) return "done";
  if (number === at.pass) return "now";
  return at.rank > kPasses ? "left out" : "ahead";
}
