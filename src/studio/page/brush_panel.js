// The panel of the brush in step See: what it does, its radius, and the strokes that the case keeps.

import {h} from "preact";
import {useEffect, useRef} from "preact/hooks";
import {state, setting, update, when} from "./store.js";
import {
  addStroke,
  brush,
  kMostPoints,
  lengthOf,
  removeStroke,
  removeStrokes,
  setRadius,
  setThrough,
  strokes,
  takeKey,
} from "./brush.js";
import {crosshair, showPlace} from "./views.js";
import {UndoButtons} from "./undo_buttons.js";
import {Button, NumberInput, Section, complaint, problemAt, rowOf, softText} from "./widgets.js";
import {plain, whole} from "./words.js";

const kModes = {"brush-add": "Add tissue", "brush-take": "Take tissue away"};

let last = ""; // step

// Whoever comes back to step See finds the brush as it was left there.
when(
  () => [state.step, state.placing],
  ([step, placing]) => {
    const isBack = step === "see" && last !== "see";
    last = step;
    if (isBack) update({placing: state.brush.mode});
    else if (step === "see") update({brush: {...state.brush, mode: placing in kModes ? placing : null}});
  },
);

/** The section. */
export function Brush() {
  useEffect(() => {
    const press = (event) => takeKey(event) && event.preventDefault();
    window.addEventListener("keydown", press);
    return () => window.removeEventListener("keydown", press);
  }, []);
  return h(
    Section,
    {title: "Brush", id: "brush"},
    softText(
      "For places that are found wrongly: a bridge to be cut, a gap to be filled. The strokes are kept in the case.",
    ),
    h(Modes),
    h(Size),
    h(Through),
    h(Ball),
    h(Strokes),
    h(Refused),
    h(Idle),
  );
}

function Modes() {
  const choose = (mode) => update({placing: state.placing === mode ? null : mode});
  return rowOf(
    Object.entries(kModes).map(([mode, text]) =>
      h(Button, {key: mode, isPressed: state.placing === mode, onClick: () => choose(mode), "data-do": mode}, text),
    ),
  );
}

function Size() {
  return h(NumberInput, {
    label: "Radius of the brush",
    unit: "mm",
    value: state.brush.radius_mm,
    step: 0.5,
    min: 0.1,
    max: 50,
    onChange: setRadius,
    hint: brush()
      ? "Drag in a slice to paint. [ and ] change the radius; Esc in a slice puts the brush away."
      : "Choose what the brush does, then drag in a slice.",
  });
}

function Through() {
  return h(NumberInput, {
    label: "Through",
    unit: "mm",
    value: state.brush.through_mm,
    step: 1,
    min: 0,
    onChange: setThrough,
    hint:
      "How far a stroke goes through the slices, half to each side. To part two bodies that touch, draw along the gap " +
      "between them.",
  });
}

// The way to paint without a mouse; without a brush it adds.
function Ball() {
  const one = brush() || {tissue: true, radius_mm: state.brush.radius_mm},
    at = crosshair();
  return rowOf(
    h(
      Button,
      {disabled: !at, onClick: () => addStroke(one, [at]), "data-do": "ball"},
      one.tissue ? "Add a ball at the crosshair" : "Take a ball away at the crosshair",
    ),
  );
}

function Refused() {
  const {refused} = state.brush,
    problem = problemAt("ct.edits");
  if (refused)
    return h(
      "p",
      {class: "problem", role: "alert", "data-refused": refused},
      `This stroke was not added: with it the strokes would have ${whole(refused)} points, and ${whole(kMostPoints)} ` +
        "is the most. Remove strokes that are not needed, or paint with a larger radius, or less far through.",
    );
  return problem ? h("p", {class: "problem", role: "alert"}, complaint(problem)) : null;
}

// What the library does with a stroke: segmentation.hpp.
const kIdle = {
  add: (region, opening) =>
    `The last stroke adds nothing: only what lies in ${region} and is joined to the tissue is kept, so paint outwards ` +
    `from the tissue${opening ? `, with a radius above the opening's ${plain(opening)} mm` : ""}.`,
  take: (region) =>
    `The last stroke takes nothing away: only what lies in ${region} is changed, and a hole in the tissue is filled ` +
    "again, so paint through the tissue's surface.",
};

// The room for the sentence is always there: a screen reader tells what comes into it.
function Idle() {
  const {idle} = state.brush,
    region = setting("ct.roi_box_mm") ? "the region box" : "the scan";
  return h(
    "p",
    {role: "status", class: idle ? "warning" : undefined, "data-idle": idle || undefined},
    idle ? kIdle[idle](region, setting("ct.opening_radius_mm")) : "",
  );
}

function Strokes() {
  const list = strokes(),
    row = useRef(null);
  // The rows move up, so that the last one loses its button, and with it the focus.
  const remove = (k) => {
    if (k === 0) row.current.firstChild.focus();
    removeStroke(k);
  };
  return h(
    "div",
    null,
    h(
      "div",
      {class: "row", ref: row},
      h(UndoButtons),
      h(Button, {disabled: !list.length, onClick: removeStrokes, "data-do": "remove-strokes"}, "Remove all strokes"),
    ),
    list.length
      ? h(
          "ol",
          {class: "strokes", "aria-label": "Strokes, the last one first", "data-strokes": list.length},
          list.map((_, k) => h(Stroke, {key: k, k: list.length - 1 - k, list, onRemove: remove})),
        )
      : softText("There are no strokes."),
  );
}

function Stroke({list, k, onRemove}) {
  const {tissue, radius_mm: radius, path_mm: path} = list[k];
  const mm = `radius ${plain(radius)} mm`,
    size = path.length > 1 ? `${mm}, ${lengthOf(path).toFixed(1)} mm long` : `a ball, ${mm}`;
  return h(
    "li",
    {"data-stroke": tissue ? "add" : "take"},
    h(
      "button",
      {type: "button", class: "stroke", title: "Show the place", onClick: () => showPlace(path[0])},
      h("span", {class: tissue ? "sign add" : "sign take", "aria-hidden": "true"}, tissue ? "+" : "−"),
      h(
        "span",
        {class: "name"},
        `${k + 1}. ${tissue ? "Added" : "Taken away"}`,
        h("br"),
        h("span", {class: "soft"}, size),
      ),
    ),
    h(Button, {onClick: () => onRemove(k), "aria-label": `Remove stroke ${k + 1}`}, "Remove"),
  );
}
