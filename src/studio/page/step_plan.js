// Step 5: the intended path, and the settings of the cut.

import {h} from "preact";
import {state, isFresh} from "./store.js";
import {isAwaited} from "./actions.js";
import {showPlace} from "./views.js";
import {rowsOf} from "./fields.js";
import {Problems, Reasons, Section, Settings, Status, Steady, problemAt, softText} from "./widgets.js";
import {RobotPlace} from "./robot_place.js";
import {Unstretched} from "./step_hold.js";
import {pointsOf, length, minus} from "./geometry.js";
import {countText, mm} from "./words.js";

const kPlan = [
  "plan.lateral_margin_mm",
  "plan.depth_mm",
  "plan.speed_mm_s",
  "plan.power_w",
  "plan.close_margin_mm",
];
const kCut = ["cut.speed_mm_s", "cut.dullness", "cut.overlap_mm"];

const kStages = [
  ["body", "Meshing the body"],
  ["stretch", "Stretching"],
  ["plan", "Planning the path"],
];

/** The panel. */
export function StepPlan() {
  return h(
    "div",
    null,
    h(
      Section,
      {title: "Path", id: "plan"},
      h(Settings, {keys: present(kPlan)}),
      h(More, {group: "plan", known: kPlan}),
    ),
    h(Planned),
    h(
      Section,
      {title: "Simulated cut", id: "cut"},
      h(Settings, {keys: present(kCut)}),
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

function More({group, known, title = "More settings"}) {
  const rest = rowsOf(group).filter((key) => !known.includes(key));
  if (!rest.length) return null;
  const open = rest.some((key) => problemAt(key)) || undefined;
  return h("details", {"data-group": group, open}, h("summary", null, title), h(Settings, {keys: rest}));
}

/** What the settings give: the path, or why there is none. */
function Planned() {
  const shown = [...["plan", "cut", "tool", "thermal"].flatMap(rowsOf), "robot.T_robot_sim"],
    isUnstretched = isFresh("stretch") && Boolean(state.stretch.note); // the plan's problem says the same again
  return h(
    Section,
    {title: "Planned path", id: "planned", doing: kStages},
    h(
      Steady,
      {isWaiting: isComing()},
      h(Problems, {calls: ["change", "body", "stretch", ...(isUnstretched ? [] : ["plan"])], shown}),
      isUnstretched ? h(Unstretched, {stretch: state.stretch}) : null,
      state.plan ? h(Result) : softText("There is no path yet."),
    ),
  );
}

// Whether one of the stages is still to answer, the last one at most.
function isComing() {
  const next = kStages.map(([name]) => name).find((name) => !isFresh(name));
  return Boolean(state.busy.change) || (next !== undefined && isAwaited(next));
}

function Result() {
  const {plan} = state;
  const points = pointsOf(plan.path);
  const along = points.reduce((sum, point, k) => sum + (k ? length(minus(point, points[k - 1])) : 0), 0);
  return h(
    "div",
    {class: isFresh("plan") ? null : "stale"},
    softText(isFresh("plan") ? "For the current settings:" : "Path of earlier settings:"),
    h("p", null, `${plan.path.closed ? "A ring" : "An open line"} of ${points.length} waypoints, ${mm(along)} long.`),
    plan.margin_note ? h("p", null, plan.margin_note) : null,
    h("p", {class: "verdict"}, h(Status, {status: plan.verdict.status}), ` ${countText(plan.verdict)}`),
    h(Reasons, {verdict: plan.verdict, onPlace: showPlace}),
  );
}
