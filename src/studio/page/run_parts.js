// The parts of the run under way, as its progress events name them: what they do not say is not shown.

import {state, when} from "./store.js";
import {isNumber, spoken} from "./words.js";

const [kPreparation, kPlanned, kMesh, kPasses, kCorrected, kEnd] = [0, 1, 2, 3, 4, 5];
const kPass = /^pass (\d+) of at most (\d+)$/;
const kWords = {[kPlanned]: "cut", [kMesh]: "check", [kPasses]: "pass", [kCorrected]: "cut"};

/** Where the run is. `pass`, `most`: the last pass of the correction and their greatest number, 0 before the first;
 *  `share`: of the stage or cut under way, which never runs back; `of`: which that is. */
let at = start();

function start() {
  return {rank: kPreparation, pass: 0, most: 0, hasCheck: false, share: undefined, of: ""};
}

function take(event) {
  if (!event) at = start();
  else at = withShare({...at, ...placeOf(event)}, event);
}

function placeOf({stage, part}) {
  if (stage === "checking the mesh") return {rank: kMesh, hasCheck: true};
  if (stage === "reading frames") return {rank: kEnd};
  return stage === "cutting" ? placeOfCut(part) : {...start()};
}

// The first event of a cut may have no part yet.
function placeOfCut(part) {
  const [, pass, most] = kPass.exec(part) || [];
  if (pass) return {rank: kPasses, pass: Number(pass), most: Number(most)};
  if (part === "as planned") return {rank: kPlanned, pass: 0, most: 0};
  return part ? {rank: kCorrected} : {};
}

// A stage may go through several files, one after the other.
function withShare(next, {stage, part, fraction}) {
  const of = `${stage} ${part}`;
  return {...next, of, share: of === at.of ? Math.max(at.share || 0, fraction) : fraction};
}

when(
  () => [state.progress.run],
  () => take(state.progress.run),
);

/** What an estimate of the time left is about. */
export function wordForPart() {
  return kWords[at.rank] || "stage";
}

/** The share of the part under way, 0..1; undefined where it is not known. */
export function shareOfPart() {
  const event = state.progress.run || state.running.find((job) => job.call === "run") || {};
  const share = state.progress.run ? at.share : event.fraction;
  return isNumber(share) ? share : undefined;
}

/** The parts in their order: [{name, is}], `is` one of "done", "now", "ahead" and "left out". */
export function partsOfRun() {
  const is = (rank) => (at.rank > rank ? "done" : at.rank === rank ? "now" : "ahead");
  const corrected = at.rank === kCorrected ? [{name: "Corrected", is: "now"}] : [];
  return [
    {name: "Preparation", is: is(kPreparation)},
    {name: "As planned", is: is(kPlanned)},
    {name: "Check of the mesh", is: at.rank > kMesh && !at.hasCheck ? "left out" : is(kMesh)},
    ...passes(),
    ...corrected,
    {name: "Program and report", is: is(kEnd)},
  ];
}

/** Where the run is in a few words: "Pass 2, cutting". */
export function whereRunIs() {
  const {stage} = state.progress.run || state.running.find((job) => job.call === "run") || {};
  const now = partsOfRun().find(({is}) => is === "now");
  return [now && now.name, stage && spoken(stage).toLowerCase()].filter(Boolean).join(", ");
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
