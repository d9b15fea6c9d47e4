// Step 5: the intended path, and the settings of the cut.

import {h} from "preact";
import {state, setting, isFresh, unitOf, valueAt} from "./store.js";
import {change} from "./actions.js";
import {showPlace} from "./views.js";
import {Button, Problems, Reasons, Section, Setting, Status, Working, complaint, problemAt} from "./widgets.js";
import {pointsOf, length, minus} from "./geometry.js";
import {hasUnitInName, mm, isNumber, plain} from "./words.js";

const kPlan = [
  "plan.lateral_margin_mm",
  "plan.depth_mm",
  "plan.speed_mm_s",
  "plan.power_w",
  "plan.approach",
  "plan.start_direction",
  "plan.close_margin_mm",
];
const kCut = ["cut.speed_mm_s", "cut.dullness", "cut.overlap_mm"];

/** The panel. */
export function StepPlan() {
  const shown = [...rowsOf("plan"), ...rowsOf("cut")];
  return h(
    "div",
    null,
    h(Problems, {calls: ["change", "body", "stretch", "plan"], shown}),
    h(Working, {call: "body", text: "Meshing the body"}),
    h(Working, {call: "stretch", text: "Stretching"}),
    h(Working, {call: "plan", text: "Planning the path"}),
    h(Result),
    h(Section, {title: "Path", id: "plan"}, h(Rows, {keys: present(kPlan)}), h(More, {group: "plan", known: kPlan})),
    h(
      Section,
      {title: "Simulated cut", id: "cut"},
      h(Rows, {keys: present(kCut)}),
      h(More, {group: "cut", known: kCut}),
    ),
    h(Place),
  );
}

/** Every setting of a group of the case that one input can hold. */
function rowsOf(group) {
  const fields = valueAt(state.case.settings, group) || {};
  return Object.keys(fields).map((key) => `${group}.${key}`);
}

function present(keys) {
  const all = new Set([...rowsOf("plan"), ...rowsOf("cut")]);
  return keys.filter((key) => all.has(key));
}

function Rows({keys}) {
  return h(
    "div",
    {class: "grid"},
    keys.map((path) => h(Setting, {key: path, path})),
  );
}

function More({group, known}) {
  const rest = rowsOf(group).filter((key) => !known.includes(key) && isShown(key) && isSimple(setting(key)));
  if (!rest.length) return null;
  return h("details", null, h("summary", null, "More settings"), h(Rows, {keys: rest}));
}

// Files are no settings of this kind; a length or power for which the server names no unit is no setting of the case.
function isShown(key) {
  return !(key in (state.case.inputs || {})) && (Boolean(unitOf(key)) || !hasUnitInName(key));
}

function isSimple(value) {
  return (
    value === null || typeof value !== "object" || (Array.isArray(value) && value.every(isNumber) && value.length < 5)
  );
}

function Result() {
  const {plan} = state;
  if (!plan) return null;
  const points = pointsOf(plan.path);
  const along = points.reduce((sum, point, k) => sum + (k ? length(minus(point, points[k - 1])) : 0), 0);
  return h(
    Section,
    {title: "Planned path", id: "planned"},
    h(
      "div",
      {class: isFresh("plan") ? null : "stale"},
      h(
        "p",
        null,
        plan.verdict ? h(Status, {status: plan.verdict.status}) : null,
        ` ${points.length} waypoints, ${mm(along)} long, ${plan.path.closed ? "a ring" : "open"}.`,
      ),
      h(Reasons, {verdict: plan.verdict, onPlace: showPlace}),
    ),
  );
}

const kIdentity = [
  [1, 0, 0, 0],
  [0, 1, 0, 0],
  [0, 0, 1, 0],
  [0, 0, 0, 1],
];

/** Where the specimen lies under the robot: a transform by rows. */
function Place() {
  const path = "robot.T_robot_sim",
    rows = setting(path),
    problem = problemAt(path);
  return h(
    Section,
    {title: "Place under the robot", id: "robot"},
    h(
      "p",
      {class: "soft"},
      "From simulation to robot coordinates, by rows; the last column is in mm. Without it no program is written.",
    ),
    rows
      ? h(
          "table",
          {class: "matrix"},
          h(
            "tbody",
            null,
            rows.map((row, r) =>
              h(
                "tr",
                {key: r},
                row.map((value, c) =>
                  h(
                    "td",
                    {key: c},
                    h("input", {
                      type: "number",
                      step: "any",
                      value: plain(value),
                      "aria-label": `Row ${r + 1}, column ${c + 1}`,
                      "aria-invalid": problem ? "true" : undefined,
                      onChange: (event) => change({[path]: rows.with(r, row.with(c, Number(event.target.value)))}),
                    }),
                  ),
                ),
              ),
            ),
          ),
        )
      : null,
    problem ? h("p", {class: "problem", role: "alert"}, complaint(problem)) : null,
    h(
      "div",
      {class: "row"},
      rows
        ? h(Button, {onClick: () => change({[path]: null})}, "Remove")
        : h(Button, {onClick: () => change({[path]: kIdentity})}, "State the place"),
    ),
  );
}
