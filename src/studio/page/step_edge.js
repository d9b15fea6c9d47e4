// Step 3: draw the tumour's edge on the skin.

import {h} from "preact";
import {state, update, setting} from "./store.js";
import {change, refresh, saveEdge} from "./actions.js";
import {approach, dropEllipse, shownSkin, skinQuery, views} from "./views.js";
import {Button, Choice, NumberInput, Numbers, Problems, Section, Working} from "./widgets.js";
import {pointsOf, length, minus} from "./geometry.js";
import {ballAbout} from "./things.js";
import {mm, place} from "./words.js";

const kModes = {
  look: "Turning the view. Nothing is drawn.",
  draw: "Click on the skin to add a point. Drag a point to move it, Delete removes it, Enter closes the edge.",
  ellipse: "Click the place on the skin that the ellipse is to surround.",
};

const kWhere = {rest: "the tissue as scanned", stretched: "the stretched tissue"};

/** The panel. */
export function StepEdge() {
  const {edge} = state;
  return h(
    "div",
    null,
    h(Problems, {calls: state.body ? ["body"] : ["tissue", "body"]}),
    h(Working, {call: "tissue", text: "Finding the tissue"}),
    h(Where),
    h(Draw),
    h(Ellipse),
    edge.points.length ? h(Points) : null,
    h(Keep),
  );
}

function set(patch) {
  update({edge: {...state.edge, ...patch}, notice: ""});
}

function Where() {
  const {edge, stretch} = state;
  const choose = (where) => {
    set({where, points: [], curve: [], isClosed: false, selected: -1, isSaved: true, mode: "look"});
    if (where === "stretched" && !stretch) refresh("stretch");
  };
  return h(
    Section,
    {title: "Drawn on", id: "where"},
    h(Choice, {
      label: "Configuration",
      value: edge.where,
      onChange: choose,
      options: Object.entries(kWhere),
    }),
    h(Working, {call: "stretch", text: "Stretching"}),
    edge.where === "stretched" ? h(Problems, {calls: ["stretch"]}) : null,
    h(Stored),
  );
}

function Stored() {
  const name = state.case.inputs && (state.case.inputs["tumor.contour"] || state.case.inputs.contour);
  const stored = pointsOf(state.case.edge);
  if (!name) return h("p", {class: "soft"}, "The case has no tumour edge yet.");
  return h(
    "p",
    {class: "soft"},
    `The case has an edge: ${name}, drawn on ${kWhere[setting("tumor.configuration")] || kWhere.stretched}.`,
    stored.length ? ` It has ${stored.length} points.` : "",
  );
}

function Draw() {
  const {edge} = state,
    hasSkin = Boolean(skinQuery());
  const mode = (name) => ({isPressed: edge.mode === name, disabled: !hasSkin, onClick: () => set({mode: name})});
  const here = state.cross && hasSkin ? skinQuery().along(state.cross, approach()) : null;
  return h(
    Section,
    {title: "Draw", id: "draw"},
    h(
      "div",
      {class: "row"},
      h(Button, {...mode("draw"), "data-do": "draw"}, "Click points"),
      h(Button, {...mode("ellipse"), "data-do": "ellipse"}, "Drop an ellipse"),
      h(
        Button,
        {disabled: edge.isClosed || edge.points.length < 3, onClick: () => views.edge.close(), "data-do": "close"},
        "Close",
      ),
      h(
        Button,
        {
          disabled: !edge.points.length,
          onClick: () => set({points: [], curve: [], isClosed: false, selected: -1, isSaved: true}),
        },
        "Start again",
      ),
    ),
    h("p", {class: "soft", role: "status"}, kModes[edge.mode]),
    edge.mode === "draw"
      ? h(Button, {disabled: !here, onClick: () => views.edge.add(here)}, "Add a point at the crosshair")
      : null,
  );
}

function Ellipse() {
  const {edge} = state,
    diameters = edge.diameters || [18, 14];
  const centre = edge.centre || middleOfEdge() || state.cross || middleOfSkin();
  const query = skinQuery(),
    start = centre && query ? query.along(centre, approach()) : null;
  return h(
    Section,
    {title: "Ellipse", id: "ellipse"},
    h(Numbers, {
      label: "Diameters",
      unit: "mm",
      names: ["first", "second"],
      value: diameters,
      step: 1,
      onChange: (next) => set({diameters: next}),
    }),
    h(NumberInput, {label: "Turn", unit: "deg", value: edge.turn || 0, step: 5, onChange: (turn) => set({turn})}),
    h(Numbers, {
      label: "Middle",
      unit: "mm",
      names: ["x", "y", "z"],
      value: centre ? centre.map((value) => Number(value.toFixed(1))) : null,
      step: 1,
      onChange: (next) => set({centre: next}),
    }),
    h(Button, {disabled: !start, onClick: () => dropEllipse(start), "data-do": "drop"}, "Lay it on the skin here"),
  );
}

function middleOfSkin() {
  const skin = shownSkin();
  return skin && ballAbout(skin.vertices).centre;
}

function middleOfEdge() {
  const {points} = state.edge;
  if (!points.length) return null;
  return [0, 1, 2].map((k) => points.reduce((sum, point) => sum + point[k], 0) / points.length);
}

function Points() {
  const {edge} = state,
    chosen = edge.points[edge.selected];
  return h(
    Section,
    {title: `Points (${edge.points.length})`, id: "points"},
    h(
      "ol",
      {class: "points", "aria-label": "Points of the edge"},
      edge.points.map((point, k) =>
        h(
          "li",
          {key: k},
          h(Button, {isPressed: k === edge.selected, onClick: () => set({selected: k, mode: "draw"})}, `${k + 1}`),
        ),
      ),
    ),
    chosen
      ? h(Numbers, {
          label: `Point ${edge.selected + 1}`,
          unit: "mm",
          names: ["x", "y", "z"],
          value: chosen.map((value) => Number(value.toFixed(2))),
          step: 0.5,
          onChange: (point) => views.edge.put(edge.selected, point),
          hint: "It is moved to the nearest point of the skin.",
        })
      : null,
    chosen ? h(Button, {onClick: () => views.edge.remove(edge.selected)}, "Remove this point") : null,
  );
}

function around(points) {
  return points.reduce((sum, point, k) => sum + length(minus(points[(k + 1) % points.length], point)), 0);
}

function Keep() {
  const {edge} = state;
  return h(
    Section,
    {title: "Keep", id: "keep"},
    edge.isClosed
      ? h("p", null, `The edge is ${mm(around(edge.curve))} long, about ${middleOfEdge().map(place).join(", ")} mm.`)
      : h(
          "p",
          {class: "soft"},
          edge.points.length ? "An edge has to be closed before it can be stored." : "Nothing is drawn.",
        ),
    h(
      Button,
      {
        isMain: true,
        disabled: !edge.isClosed || edge.isSaved || Boolean(state.busy.edge),
        "data-do": "save-edge",
        onClick: () => saveEdge(edge.curve, edge.where),
      },
      "Store the edge in the case",
    ),
    h(Working, {call: "edge", text: "Storing"}),
    h(Problems, {calls: ["change", "edge"]}),
    state.notice ? h("p", {role: "status", class: "notice"}, state.notice) : null,
    h(Surface),
  );
}

/** What a new edge leaves as it was: the case's surface of the tumour, which may belong to the edge before. */
function Surface() {
  const inputs = state.case.inputs || {},
    name = inputs["tumor.surface"];
  if (!name || !inputs["tumor.contour"] || "tumor.surface" in state.drafts) return null;
  const isNew = state.edge.points.length > 0 && state.edge.isSaved;
  return h(
    "div",
    {class: isNew ? "warning" : "soft", role: "status"},
    h("p", null, `The case also names a tumour surface, ${name}: the verdict compares both.`),
    h(Button, {onClick: () => change({"tumor.surface": null}), "data-do": "remove-surface"}, "Remove it"),
  );
}
