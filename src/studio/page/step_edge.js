// Step 3: draw the tumour's edge on the skin.

import {h} from "preact";
import {state, update, setting} from "./store.js";
import {change, refresh, saveEdge} from "./actions.js";
import {approach, dropEllipse, shownEdge, shownSkin, skinQuery, views} from "./views.js";
import {currentRoom, hasRoom} from "./room.js";
import {
  Button,
  Choice,
  Explained,
  NumberInput,
  Numbers,
  VectorInput,
  Problems,
  Section,
  StepLinks,
  Working,
  rowOf,
  softText,
} from "./widgets.js";
import {pointsOf, length, meanOf, minus} from "./geometry.js";
import {ballAbout} from "./things.js";
import {mm, place, plain} from "./words.js";

const kModes = {
  look: "Turning the view. Nothing is drawn.",
  draw: "Click on the skin to add a point. Drag a point to move it, Delete removes it, Enter closes the edge.",
  ellipse: "Click the place on the skin that the ellipse is to surround.",
};

const kWhere = {rest: "the tissue as scanned", stretched: "the stretched tissue"};

const kDoing = [
  ["tissue", "Finding the tissue"],
  ["body", "Meshing the body"],
  ["stretch", "Stretching"],
];

/** The panel. */
export function StepEdge() {
  const {edge} = state;
  return h(
    "div",
    null,
    h(Where),
    h(Draw),
    h(Ellipse),
    edge.points.length ? h(Points) : null,
    h(Keep),
    h(Margin),
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
    {title: "Drawn on", id: "where", doing: kDoing},
    h(Choice, {
      label: "Configuration",
      value: edge.where,
      onChange: choose,
      options: Object.entries(kWhere),
    }),
    h(Stored),
    h(Problems, {calls: state.body ? ["body"] : ["tissue", "body"]}),
    edge.where === "stretched" ? h(Problems, {calls: ["stretch"]}) : null,
  );
}

function Stored() {
  const name = state.case.inputs && (state.case.inputs["tumor.contour"] || state.case.inputs.contour);
  const stored = pointsOf(state.case.edge);
  if (!name) return softText("The case has no tumour edge yet.");
  return softText(
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
    rowOf(
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
    h(VectorInput, {
      label: "Middle",
      value: centre ? centre.map((value) => Number(value.toFixed(1))) : null,
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
  return points.length ? meanOf(points) : null;
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
      ? h(VectorInput, {
          label: `Point ${edge.selected + 1}`,
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
      : softText(edge.points.length ? "An edge has to be closed before it can be stored." : "Nothing is drawn."),
    rowOf(
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
    ),
    h(Problems, {calls: ["change", "edge"]}),
    state.notice ? h("p", {role: "status", class: "notice"}, state.notice) : null,
    h(Surface),
  );
}

/** How much margin fits round the edge, before the stretch. */
function Margin() {
  const edge = shownEdge(),
    room = hasRoom(edge) ? currentRoom(edge) : null;
  return h(
    Section,
    {title: "Margin", id: "room", doing: [["room", "Looking what fits"]]},
    h("div", {role: "status", class: "lines-3"}, room ? h(Room, {room}) : softText(withoutRoom(edge))),
    h(Problems, {calls: ["room"]}),
  );
}

function withoutRoom(edge) {
  if (hasRoom(edge)) return "How much margin fits on this skin is being found.";
  if (edge.isClosed && state.edge.where === "rest" && edge.isRest) return "The case has a line to cut along.";
  if (edge.isClosed && edge.points.length) return "Step Plan says how much margin fits on the stretched tissue.";
  return "Once the edge is closed, this says how much margin fits on the skin round it.";
}

function Room({room}) {
  const count = room.edge_on_cut_face,
    isFitting = room.fits;
  return [
    h(
      "p",
      {key: "fits", class: isFitting ? null : "warning", "data-fits": isFitting ? "yes" : "no"},
      isFitting ? fittingText(room) : tooLargeText(room),
      isFitting ? null : h(StepLinks, {steps: ["see", "plan"]}),
    ),
    count
      ? h(
          "p",
          {key: "cut", class: "warning", "data-edge-on-cut": count},
          count === 1 ? "1 point of the edge lies" : `${count} points of the edge lie`,
          " where the region box or the end of the scan cuts the tissue.",
        )
      : h(Why, {key: "why", room}),
    room.painted
      ? h(
          "p",
          {key: "painted", class: "warning", "data-painted": room.painted},
          `${room.painted} of the ring's ${room.ring.length} points lie on skin that the brush made: ` +
            "compare it with the scan.",
        )
      : null,
  ];
}

// Why not even the least margin fits, in the library's words.
function Why({room: {problem, greatest_margin_mm: greatest}}) {
  if (!problem || greatest !== null) return null;
  return softText("incise reports: ", h(Explained, {text: problem}), ".");
}

function fittingText({margin, margin_note: note}) {
  return `The margin of ${plain(margin)} mm fits on this skin. ${note}`;
}

function tooLargeText({margin, margin_note: note, greatest_margin_mm: greatest}) {
  const box = setting("ct.roi_box_mm") ? ", or make the region box larger" : "",
    less = greatest === null ? "" : ", or set a smaller margin in Plan";
  return `The margin of ${plain(margin)} mm does not fit on this skin. ${note} Draw the edge elsewhere${box}${less}.`;
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
