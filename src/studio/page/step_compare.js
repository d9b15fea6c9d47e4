// Step 7: the cut as planned and the corrected one, side by side.

import {h} from "preact";
import {state, isFresh} from "./store.js";
import {goTo} from "./actions.js";
import {approach, showPlace} from "./views.js";
import {NotRun} from "./step_run.js";
import {Withdrawn, isCurrent} from "./programs.js";
import {contourOf, correctedOf, laidOver, lookOf, shownCut, titleOf} from "./kept.js";
import {KeptTable, WhatIf} from "./what_if.js";
import {AsOf, Button, DataTable, Reasons, Section, Status, softText} from "./widgets.js";
import {ContourView, boundsOf} from "./contour_view.js";
import {Plot} from "./plots.js";
import {isRing, lookOfPlan} from "./planned_path.js";
import {ink, intended, isDark} from "./colours.js";
import {countText, mm, spoken} from "./words.js";

const kNumbers = [
  ["nearest_to_tumor_mm", "Closest approach to the tumour"],
  ["least_depth_mm", "Least depth"],
  ["greatest_error_mm", "Greatest error"],
  ["mean_error_mm", "Mean error"],
];

/** The panel. */
export function StepCompare() {
  const result = state.run;
  if (!result) return h("div", null, h(NotRun));
  return h(
    "div",
    {"data-run": result.outcome},
    h(AsOf, {isNow: isFresh("run"), past: "The settings have changed since this run."}),
    h(
      Section,
      {title: "Verdict", id: "verdict"},
      h("p", {class: "verdict"}, h(Status, {status: result.verdict.status}), ` ${countText(result.verdict)}`),
      h(Reasons, {verdict: result.verdict, onPlace: showPlace}),
      h("p", {"data-ended": result.outcome}, result.ended),
      result.corrected ? h("p", {"data-correction": String(result.accepted)}, correctionText(result)) : null,
    ),
    h(
      Section,
      {title: "Numbers", id: "numbers"},
      laidOver().length ? h(KeptTable, {rows: kNumbers}) : h(Table, {result}),
    ),
    h(WhatIf),
    h(Unjudged, {result}),
    h(
      Section,
      {title: "Robot program", id: "to-program"},
      isCurrent("run")
        ? h("p", null, programText(result))
        : h(Withdrawn, {of: "run"}),
      h(Button, {onClick: () => goTo("program"), "data-do": "to-program"}, "Go to the program"),
    ),
  );
}

const kFollowed =
  "No program follows this path: the correction is accepted, and the verdict above is that of the corrected cut.";

// What is known against the cut that the run's verdict does not judge: as planned once the correction is accepted, else
// the corrected one.
function Unjudged({result}) {
  const cut = result.accepted ? result.as_planned : correctedOf(result);
  if (!cut || cut.verdict.status === "ok") return null;
  return h(
    Section,
    {title: result.accepted ? "Against the cut as planned" : "Against the corrected cut", id: "against-other"},
    result.accepted ? h("p", {"data-followed": "corrected"}, kFollowed) : null,
    h("p", {class: "verdict"}, h(Status, {status: cut.verdict.status})),
    h(Reasons, {verdict: cut.verdict, onPlace: showPlace}),
  );
}

function programText({program, gate, why_without_program: why}) {
  const {missing = [], refused = []} = gate || {};
  if (program) return "The verdict allows a program.";
  if (missing.length && !refused.length)
    return "There is no program yet: step Program lists the cautions that a person has to accept.";
  return why || "There is no program.";
}

const kSamePath = "The corrected path is the planned one, so there is no second cut to compare.";

function correctionText(result) {
  const {accepted, correction_note: note} = result;
  const outcome = accepted ? "The correction is accepted." : `The correction is not accepted${note ? `: ${note}` : ""}.`;
  return correctedOf(result) ? outcome : `${outcome} ${kSamePath}`;
}

function Table({result}) {
  const of = (cut, key) => mm(cut && cut.numbers ? cut.numbers[key] : null),
    hasOther = Boolean(correctedOf(result)) || !result.corrected;
  return h(DataTable, {
    head: ["Simulated", "As planned", ...(hasOther ? ["Corrected"] : [])],
    rows: kNumbers.map(([key, name]) => [key, name, of(result.as_planned, key), of(result.corrected, key)]),
    keyName: "data-number",
  });
}

// --- The pictures. ---

let memo = {parts: []};

/** Curves and plots of a result; the same objects for as long as what is shown and the colours are the same. */
function picturesOf(run, plan) {
  const parts = [run, plan, isDark(), state.kept, state.keptCut, state.case];
  if (parts.some((part, k) => part !== memo.parts[k])) memo = {parts, ...makePictures(run, plan)};
  return memo;
}

function makePictures(run, plan) {
  const isClosed = isRing(plan),
    others = laidOver();
  const over = (which) => others.map((one) => contourOf(one, which, isClosed)).filter(Boolean);
  const withOthers = (cut, colour, over) => (cut || over.length ? [...contoursOf(cut, colour, plan), ...over] : []);
  const before = withOthers(run.as_planned, ink.kerf, over("as_planned")),
    after = withOthers(correctedOf(run), afterColour(), over("corrected"));
  return {
    before,
    after,
    bounds: boundsOf([...before, ...after], approach()),
    errors: errorsOf(run, others),
    depths: depthsOf(run, others),
  };
}

/** The colour of what is corrected. */
export function afterColour() {
  return isDark() ? "#5db4e8" : ink.corrected;
}

function contoursOf(cut, colour, plan) {
  const isClosed = isRing(plan),
    {path, centerline, inner_edge: innerEdge} = cut || {},
    {label, colour: planColour, dash} = lookOfPlan();
  return [
    {label, colour: planColour, dash, width: 1.5, points: plan && plan.path, isClosed},
    {
      label: "path of the tool",
      colour: isDark() ? "#9aa3ab" : "#6b6b6b",
      width: 1.3,
      dash: [4, 3],
      points: path,
      isClosed,
    },
    {label: "mid-line of the cut", colour, width: 2.4, points: centerline, isClosed},
    {label: "inner edge", colour, width: 1.2, dash: [1, 2], points: innerEdge, isClosed},
    {
      label: "tumour's edge",
      colour: isDark() ? "#2fd6a3" : ink.tumour,
      width: 2,
      points: plan && plan.edge,
      isClosed: true,
    },
  ];
}

function errorsOf(run, others) {
  const curve = (cut, look) => cut && cut.errors && {...look, x: cut.errors.arclength_mm, y: cut.errors.signed_mm};
  return [
    curve(run.as_planned, kBeforeLook),
    curve(correctedOf(run), afterLook()),
    ...others.map((one) => curve(shownCut(one), lookOver(one))),
  ].filter(Boolean);
}

function depthsOf(run, others) {
  const before = run.as_planned,
    after = correctedOf(run);
  const reached = (cut, look) => cut && cut.depth && {...look, x: cut.depth.arclength_mm, y: cut.depth.reached_mm};
  const first = (before && before.depth) || (after && after.depth);
  const planned = first && {
    label: "planned",
    colour: intended(),
    dash: [5, 3],
    x: first.arclength_mm,
    y: first.planned_mm,
  };
  return [
    planned,
    reached(before, kBeforeLook),
    reached(after, afterLook()),
    ...others.map((one) => reached(shownCut(one), lookOver(one))),
  ].filter(Boolean);
}

const kBeforeLook = {label: "as planned", colour: ink.kerf};
const afterLook = () => ({label: "corrected", colour: afterColour()});
const lookOver = (one) => ({label: titleOf(one), ...lookOf(one)});

/** Contours and plots for the large part of the page. */
export function ComparePictures() {
  const {run, plan, focus} = state;
  if (!run) return null;
  const {before, after, bounds, errors, depths} = picturesOf(run, plan),
    corrected = correctedOf(run);
  const view = (id, title, curves, cut) =>
    h(ContourView, {
      key: id,
      id,
      direction: approach(),
      bounds,
      mark: focus,
      curves,
      title: [title, cut && cut.verdict ? `: ${spoken(cut.verdict.status)}` : ""].join(""),
    });
  return [
    before.length ? view("before", "As planned", before, run.as_planned) : null,
    after.length
      ? view("after", corrected ? "Corrected" : "Corrected: only of kept results", after, corrected)
      : h(
          "figure",
          {class: "contours", key: "after"},
          h("figcaption", null, "Corrected"),
          softText(run.corrected ? kSamePath : "There is no corrected cut."),
        ),
    errors.length
      ? h(Plot, {
          key: "errors",
          id: "errors",
          title: "Error of the mid-line; above 0: farther from the tumour",
          unit: "error, mm",
          curves: errors,
        })
      : null,
    depths.length
      ? h(Plot, {key: "depths", id: "depths", title: "Depth reached", unit: "depth, mm", curves: depths})
      : null,
  ];
}
