// What if: the settings that change a cut, results that are kept, and the numbers of all of them.

import {h} from "preact";
import {state, setting, update, isFresh} from "./store.js";
import {dropKept, keepAndRun, putBack, run, stop} from "./actions.js";
import {Button, Choice, Problems, Section, Settings, Status, softText} from "./widgets.js";
import {Swatch} from "./contour_view.js";
import {shareOfPart, whereRunIs} from "./run_parts.js";
import {isRunning} from "./step_run.js";
import {isAlike, isKept, kMostKept, labelOf, laidOver, lookOf, titleOf} from "./kept.js";
import {fixed, isNumber} from "./words.js";

// Each with what it acts on.
const kSettings = {
  "plan.speed_mm_s": "Of the robot. A faster cut gets less energy per area: the simulated tool drags tissue farther.",
  "cut.speed_mm_s": "Of the simulated tool. With dullness: how far it drags tissue along.",
  "cut.dullness": "How long the tool touches tissue before it is cut. Less: a sharper tool.",
  "plan.power_w": "More power cuts faster, and heats more tissue beside the cut.",
  "specimen.material.youngs_modulus_kpa": "The tissue's stiffness.",
  "specimen.material.poissons_ratio": "Near 0.5 tissue keeps its volume; 0: it gives way.",
};
const kCuts = [
  ["corrected", "the corrected cuts"],
  ["as_planned", "the cuts as planned"],
];

/** The section. */
export function WhatIf() {
  const {kept} = state;
  return h(
    Section,
    {title: "What if", id: "what-if"},
    softText(
      "Change a value, keep the result, and run again: both are laid over each other. ",
      "What a change does not touch is not computed again.",
    ),
    h(Settings, {keys: Object.keys(kSettings), hints: kSettings}),
    setting("specimen.material.from_mesh")
      ? softText("Where the mesh brings Young's modulus or Poisson's ratio, those hold.")
      : null,
    h(Problems, {calls: ["change"], shown: Object.keys(kSettings)}),
    h(Buttons),
    h(
      "p",
      {role: "status", class: state.keptDropped ? "warning" : undefined},
      state.keptDropped ? droppedText(state.keptDropped) : "",
    ),
    kept.length ? h(Kept) : null,
  );
}

function droppedText(count) {
  const what = count === 1 ? "A kept result was" : `${count} kept results were`;
  return `${what} of another case, tissue, mesh or tumour's edge, and cannot be laid over this one: dropped.`;
}

function Buttons() {
  const isOn = isRunning(),
    why = whyNotKept();
  return [
    h(
      "div",
      {class: "row", key: "row"},
      h(
        Button,
        {isMain: true, disabled: isOn || Boolean(why), onClick: keepAndRun, "data-do": "keep-and-run"},
        "Keep this result and run again",
      ),
      h(Button, {disabled: isOn, onClick: run, "data-do": "run"}, "Run again"),
      isOn ? h(Button, {onClick: () => stop("run"), "data-do": "stop"}, "Stop") : null,
    ),
    h(
      "div",
      {key: "now", class: "lines-3"},
      why && !isOn ? h("p", {class: "soft", "data-why": "yes"}, why) : null,
      isOn ? h(RunNow) : null,
    ),
    h(Problems, {key: "problems", calls: ["run"]}),
  ];
}

// Why a result is not kept now; empty where it can be.
function whyNotKept() {
  if (isFresh("run") && !Object.keys(state.drafts).length) return "Change a value first.";
  if (isKept(state.run)) return "This result is kept already.";
  if (state.kept.length >= kMostKept)
    return `${kMostKept} results are kept, the most at a time. Drop one to keep another.`;
  return "";
}

function RunNow() {
  return h(
    "div",
    {"data-running": "yes"},
    h("p", {class: "soft", role: "status"}, whereRunIs() || "Starting"),
    h("progress", {max: 1, value: shareOfPart(), "aria-label": "Progress of this part"}),
  );
}

// --- What is kept. ---

function Kept() {
  const {kept} = state;
  return [
    h("h4", {key: "title"}, `Kept on this page, at most ${kMostKept}`),
    h(
      "ul",
      {class: "kept", key: "list"},
      kept.map((one) => h("li", {key: one.letter, "data-kept": one.letter}, h(KeptOne, {one}))),
    ),
    h(Choice, {
      key: "cut",
      label: "In the plots and in 3D",
      value: state.keptCut,
      options: kCuts,
      onChange: (keptCut) => update({keptCut}),
    }),
  ];
}

function KeptOne({one}) {
  const isShown = state.run && isAlike(one, state.run);
  return [
    h(
      "div",
      {key: "name", class: "kept-name"},
      h(KeptSwatch, {one}),
      h("span", null, h("strong", null, titleOf(one)), isShown ? " (the result that is shown)" : ""),
      h(Status, {status: one.verdict.status}),
    ),
    h(
      "div",
      {key: "row", class: "row tight"},
      h(
        Button,
        {
          disabled: isAlike(one, {...one, settings: state.case.settings}),
          onClick: () => putBack(one),
          "data-do": "put-back",
          "aria-label": `Put these settings back: ${one.letter}`,
        },
        "Put these settings back",
      ),
      h(
        Button,
        {onClick: () => dropKept(one.letter), "data-do": "drop-kept", "aria-label": `Drop ${one.letter}`},
        "Drop",
      ),
    ),
  ];
}

function KeptSwatch({one}) {
  return h(Swatch, {curve: {...lookOf(one), width: 2.5}});
}

// --- Numbers. ---

const kCutNames = [
  ["as_planned", "As planned"],
  ["corrected", "Corrected"],
];
const number = (cut, key) => {
  const value = cut && cut.numbers ? cut.numbers[key] : null;
  return isNumber(value) ? fixed(value, 2) : "–";
};

/** The numbers of the result that is shown and of those laid over it, a column each.
 *  @param rows  [[key, name]] of the numbers, mm */
export function KeptTable({rows}) {
  const all = [state.run, ...laidOver()];
  return h(
    "div",
    {class: "wide-table", tabIndex: 0, role: "region", "aria-label": "Numbers of the results, mm"},
    h(
      "table",
      {class: "numbers-table", "data-columns": all.length},
      h(
        "thead",
        null,
        h(
          "tr",
          null,
          h("th", {scope: "col"}, "Simulated, mm"),
          all.map((one) =>
            h(
              "th",
              {key: one.letter || "shown", scope: "col", class: "number", "data-column": one.letter || "shown"},
              one.letter ? h(KeptSwatch, {one}) : null,
              h("strong", null, one.letter || "Shown"),
              h("span", null, labelOf(one)),
            ),
          ),
        ),
      ),
      kCutNames.map(([which, name]) =>
        h(
          "tbody",
          {key: which},
          h("tr", null, h("th", {scope: "rowgroup", colSpan: 1 + all.length, class: "group"}, name)),
          rows.map(([key, text]) =>
            h(
              "tr",
              {key, "data-number": key, "data-of": which},
              h("th", {scope: "row"}, text),
              all.map((one) => h("td", {key: one.letter || "shown", class: "number"}, number(one[which], key))),
            ),
          ),
        ),
      ),
    ),
  );
}
