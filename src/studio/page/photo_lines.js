// The lines of a photograph that a person draws or corrects by hand, and the points of its scale.

import {h} from "preact";
import {state, update} from "./store.js";
import {Button, Check, Numbers, Section, rowOf, softText} from "./widgets.js";
import {
  emptyLine,
  placeForHandle,
  scalePointCount,
  tenths,
  withAdded,
  withHandles,
  withMoved,
  withRemoved,
} from "./photo_settings.js";

const kMove = "Drag a point to move it, Delete removes it.";
const kHints = {
  closed: `Click on the photograph to add a point to the nearest side. ${kMove}`,
  incision: `Click along the line; Enter or a click on point 1 closes it. An open cut stays open. ${kMove}`,
  tumor_edge: `Click round the tumour; Enter or a click on point 1 closes the edge. ${kMove}`,
};
const kLines = [
  ["incision", "Incision"],
  ["tumor_edge", "Tumour's edge"],
];

/** Changes the photograph's settings. */
export function setPhoto(patch) {
  update({photo: {...state.photo, ...patch}});
}

// --- Handles: of the line that is being drawn, or of the scale. ---

/** The points that can be dragged now. */
export function handlesOf({mode, scale, hand}) {
  if (mode === "scale") return scale.points;
  return (hand[mode] && hand[mode].points) || [];
}

function putScale(points, selected) {
  setPhoto({scale: {...state.photo.scale, points}, selected});
}

function putLine(line, selected) {
  const {hand, mode} = state.photo;
  setPhoto({hand: {...hand, [mode]: line}, selected});
}

/** Adds a point; of a scale that has all its points, the chosen one goes there instead. */
export function addHandle(point) {
  const {photo} = state,
    points = handlesOf(photo),
    line = photo.hand[photo.mode];
  if (line) {
    const at = placeForHandle(line, point);
    putLine(withAdded(line, at, point), at);
  } else if (points.length < scalePointCount(photo)) {
    putScale([...points, point], points.length);
  } else if (photo.selected >= 0) {
    moveHandle(photo.selected, point);
  }
}

/** Moves point k. */
export function moveHandle(k, point) {
  const line = state.photo.hand[state.photo.mode];
  if (line) putLine(withMoved(line, k, point), k);
  else putScale(state.photo.scale.points.with(k, point), k);
}

/** Removes point k. */
export function removeHandle(k) {
  const points = handlesOf(state.photo),
    line = state.photo.hand[state.photo.mode],
    next = Math.min(k, points.length - 2);
  if (!points[k]) return;
  if (line) putLine(withRemoved(line, k), next);
  else putScale(points.toSpliced(k, 1), next);
}

/** Closes the line that is being drawn. */
export function closeLine() {
  const {photo} = state,
    line = photo.hand[photo.mode];
  if (line && line.points.length > 2) setPhoto({hand: {...photo.hand, [photo.mode]: {...line, isClosed: true}}});
}

/** Chooses point k. */
export function chooseHandle(k) {
  setPhoto({selected: k});
}

// --- The panel. ---

/** The section in which both lines are corrected. */
export function HandLines() {
  return h(
    Section,
    {title: "By hand", id: "by-hand"},
    softText("Correct a line where it was not found well. The result says that it was drawn by hand."),
    kLines.map(([name, title]) => h(Line, {key: name, name, title})),
  );
}

function Line({name, title}) {
  const {photo} = state,
    own = photo.hand[name],
    found = foundLine(name);
  const put = (line, mode) => setPhoto({hand: {...photo.hand, [name]: line}, mode, selected: -1});
  const isOn = photo.mode === name;
  return h(
    "fieldset",
    {class: "hold", "data-line": name},
    h("legend", null, title, own ? h("span", {class: "soft"}, ` ${own.points.length} points`) : null),
    rowOf(
      own
        ? h(
            Button,
            {isPressed: isOn, onClick: () => setPhoto({mode: isOn ? "look" : name, selected: -1}), "data-do": "edit"},
            "Edit",
          )
        : h(
            Button,
            {
              disabled: !found,
              onClick: () => put(withHandles(found.points, found.isClosed), name),
              "data-do": "correct",
            },
            "Correct what was found",
          ),
      h(Button, {onClick: () => put(emptyLine(), name), "data-do": "redraw"}, "Draw anew"),
      own ? h(Button, {onClick: () => put(null, "look"), "data-do": "drop-line"}, "Drop the drawing") : null,
    ),
    own && isOn ? h(Handles, {line: own, name}) : null,
  );
}

// The line that the last call gave, found or drawn.
function foundLine(name) {
  const {photograph} = state;
  const points = photograph && photograph[`${name}_px`];
  if (!points || points.length < 3) return null;
  return {points, isClosed: name === "incision" ? photograph.incision_closed : true};
}

function Handles({line, name}) {
  const {photo} = state,
    chosen = line.points[photo.selected];
  const close = (isClosed) => setPhoto({hand: {...photo.hand, [name]: {...line, isClosed}}});
  return h(
    "div",
    null,
    softText(kHints[line.isClosed ? "closed" : name]),
    h(Check, {label: "Closed", isOn: line.isClosed, onChange: close}),
    h(
      "ol",
      {class: "points", "aria-label": "Points of the line"},
      line.points.map((_, k) =>
        h("li", {key: k}, h(Button, {isPressed: k === photo.selected, onClick: () => chooseHandle(k)}, `${k + 1}`)),
      ),
    ),
    chosen
      ? h(Numbers, {
          label: `Point ${photo.selected + 1}`,
          unit: "px",
          names: ["u", "v"],
          value: chosen,
          step: 1,
          onChange: (point) => moveHandle(photo.selected, point),
        })
      : null,
    rowOf(
      h(
        Button,
        {onClick: () => addHandle(newPlace(line.points, photo.selected)), "data-do": "add-point"},
        "Add a point",
      ),
      h(
        Button,
        {disabled: !chosen, onClick: () => removeHandle(photo.selected), "data-do": "remove-point"},
        "Remove this point",
      ),
    ),
  );
}

// Half-way to the next point; in the middle of the photograph where there are not two.
function newPlace(points, selected) {
  const {width, height} = state.picture;
  if (points.length < 2) return [Math.round(width / 2) + 40 * points.length, Math.round(height / 2)];
  const from = points[Math.max(0, selected)],
    to = points[(Math.max(0, selected) + 1) % points.length];
  return tenths([0, 1].map((k) => 0.5 * (from[k] + to[k])));
}
