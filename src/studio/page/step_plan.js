// Step 5: the intended path, and the settings of the cut.

import {h} from "preact";
import {state, isFresh} from "./store.js";
import {showPlace} from "./views.js";
import {rowsOf} from "./fields.js";
import {Problems, Reasons, Section, Setting, Status, Working} from "./widgets.js";
import {RobotPlace} from "./robot_place.js";
import {Unstretched} from "./step_hold.js";
import {pointsOf, length, minus} from "./geometry.js";
import {countText, mm} from "./words.js";

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
  const shown = [...["plan", "cut", "tool", "thermal"].flatMap(rowsOf), "robot.T_robot_sim"];
  const isUnstretched = isFresh("stretch") && Boolean(state.stretch.note); // the plan's problem says the same again
  return h(
    "div",
    null,
    h(Problems, {calls: ["change", "body", "stretch", ...(isUnstretched ? [] : ["plan"])], shown}),
    isUnstretched ? h(Unstretched, {stretch: state.stretch}) : null,
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
      h(More, {group: "tool", known: [], title: "Tool"}),
      h(More, {group: "thermal", known: [], title: "Heat"}),
    ),
    h(RobotPlace),
  );
}

function present(keys) {
  const all = [...rowsOf("plan"), ...rowsOf("cut")];
  return keys.filter((key) => all.includes(key));
}

function Rows({keys}) {
  return h(
    "div",
    {class: "grid"},
    keys.map((path) => h(Setting, {key: path, path})),
  );
}

function More({group, known, title = "More settings"}) {
  const rest = rowsOf(group).filter((key) => !known.includes(key));
  if (!rest.length) return null;
  return h("details", {"data-group": group}, h("summary", null, title), h(Rows, {keys: rest}));
}

function Result() {
  const {plan} = state;
  if (!plan) return null;
  const points = pointsOf(plan.path);
  const along = points.reduce((sum, point, k) => sum + (k ? length(minus(point, points[k - 1])) : 0), 0);
  return h(
    Section,
    {title: "Planned path", id: "planned"},
    isFresh("plan") ? null : h("p", {class: "soft"}, "With earlier settings:"),
    h(
      "div",
      {class: isFresh("plan") ? null : "stale"},
      h("p", null, `${plan.path.closed ? "A ring" : "An open line"} of ${points.length} waypoints, ${mm(along)} long.`),
      h("p", {class: "verdict"}, h(Status, {status: plan.verdict.status}), ` ${countText(plan.verdict)}`),
      h(Reasons, {verdict: plan.verdict, onPlace: showPlace}),
    ),
  );
}
