// The panel of the brush in step See: what it does, its radius, and the strokes that the case keeps.

import {h} from "preact";
import {useEffect, useRef} from "preact/hooks";
import {state, update} from "./store.js";
import {
  addStroke,
  brush,
  canUndo,
  kMostPoints,
  lengthOf,
  redo,
  removeStroke,
  removeStrokes,
  setRadius,
  strokes,
  takeKey,
  undo,
} from "./brush.js";
import {crosshair, showPlace} from "./views.js";
import {Button, NumberInput, Section, complaint, problemAt} from "./widgets.js";
import {plain, whole} from "./words.js";

const kModes = {"brush-add": "Add tissue", "brush-take": "Take tissue away"};

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
    h(
      "p",
      {class: "soft"},
      "For places that are found wrongly: a bridge to be cut, a gap to be filled. The strokes are kept in the case.",
    ),
    h(Modes),
    h(Size),
    h(Ball),
    h(Refused),
    h(Strokes),
  );
}

function Modes() {
  const choose = (mode) => update({placing: state.placing === mode ? null : mode});
  return h(
    "div",
    {class: "row"},
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

// The way to paint without a mouse; without a brush it adds.
function Ball() {
  const one = brush() || {tissue: true, radius_mm: state.brush.radius_mm},
    at = crosshair();
  return h(
    "div",
    {class: "row"},
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
        "is the most. Remove strokes that are not needed, or paint with a larger radius.",
    );
  return problem ? h("p", {class: "problem", role: "alert"}, complaint(problem)) : null;
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
      h(Button, {disabled: !canUndo(), onClick: undo, title: "Ctrl+Z", "data-do": "undo"}, "Undo"),
      h(Button, {disabled: !state.brush.future.length, onClick: redo, title: "Ctrl+Y", "data-do": "redo"}, "Redo"),
      h(Button, {disabled: !list.length, onClick: removeStrokes, "data-do": "remove-strokes"}, "Remove all strokes"),
    ),
    list.length
      ? h(
          "ol",
          {class: "strokes", "aria-label": "Strokes, the last one first", "data-strokes": list.length},
          list.map((_, k) => h(Stroke, {key: k, k: list.length - 1 - k, list, onRemove: remove})),
        )
      : h("p", {class: "soft"}, "There are no strokes."),
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
