// Where the specimen lies under the robot, in step Plan: a place and a turn, or the matrix that they make.

import {h} from "preact";
import {state, setting, isFresh} from "./store.js";
import {change} from "./actions.js";
import {
  kSelected,
  Button,
  Explained,
  NumberInput,
  VectorInput,
  Section,
  complaint,
  problemAt,
  rowOf,
  softText,
} from "./widgets.js";
import {ballAbout} from "./things.js";
import {moved} from "./registered.js";
import {meanOf, pointsOf} from "./geometry.js";
import {fixed, mm, plain} from "./words.js";

const kPath = "robot.T_robot_sim";
const kInFront = [600, 0]; // mm: a first place, which the arm can reach
const kOnTable = 0.5; // mm: nearer to the table than this is on it

/** The section. */
export function RobotPlace() {
  const pose = setting(kPath),
    problem = problemAt(kPath);
  return h(
    Section,
    {title: "Place under the robot", id: "robot"},
    softText(
      "Where the specimen lies, in the robot's coordinates: z is up, z = 0 the table, x and y from the middle of the " +
        "robot's base. Without it no program is written. Step Register finds it with a camera.",
    ),
    pose ? h(Numbered, {pose}) : null,
    problem ? h("p", {class: "problem", role: "alert"}, h(Explained, {text: complaint(problem)})) : null,
    pose ? h(Height, {pose}) : null,
    pose ? h(Matrix, {pose, problem}) : null,
    rowOf(
      pose
        ? h(Button, {onClick: () => change({[kPath]: null})}, "Remove")
        : h(
            Button,
            {disabled: isComing(), onClick: () => put(firstPose()), "data-do": "place-robot"},
            "State the place",
          ),
    ),
  );
}

function put(pose) {
  change({[kPath]: pose});
}

// The tissue that is to lie on the table is on its way.
function isComing() {
  return Boolean(state.busy.body || state.busy.stretch);
}

// --- A turn about the vertical, and where a point of the specimen lies. ---

/** The pose that turns by degrees about the vertical and brings a point to a place. */
function poseOf(degrees, point, place) {
  const angle = (degrees * Math.PI) / 180,
    exact = (value) => Number(value.toFixed(12)) + 0; // of a quarter turn; no -0
  const [c, s] = [exact(Math.cos(angle)), exact(Math.sin(angle))];
  const turned = [c * point[0] - s * point[1], s * point[0] + c * point[1], point[2]];
  const [x, y, z] = place.map((value, k) => Number((value - turned[k]).toFixed(4)) + 0);
  return [
    [c, -s + 0, 0, x],
    [s, c, 0, y],
    [0, 0, 1, z],
    [0, 0, 0, 1],
  ];
}

/** The turn about the vertical in degrees; null where the pose tilts the specimen as well. */
function turnOf([[a, b, e], [c, d, f], [g, i, up], [j, k, l, one]]) {
  const isNear = (value, wanted) => Math.abs(value - wanted) < 1e-6;
  const isUpright = [e, f, g, i, j, k, l].every((value) => isNear(value, 0)) && isNear(up, 1) && isNear(one, 1);
  const isTurn = isNear(a, d) && isNear(b, -c) && isNear(a * a + c * c, 1);
  return isUpright && isTurn ? (Math.atan2(c, a) * 180) / Math.PI : null;
}

/** The point of the specimen that the numbers are about: {name, point}. */
function reference() {
  const {plan, stretch, body} = state,
    edge = plan ? pointsOf(plan.edge) : [];
  if (edge.length) return {name: "Middle of the tumour's edge", point: meanOf(edge)};
  if (stretch) return {name: "Middle of the stretched tissue", point: ballAbout(stretch.skin.vertices).centre};
  if (body) return {name: "Middle of the tissue", point: ballAbout(body.skin.vertices).centre};
  return {name: "Origin of the scan", point: [0, 0, 0]};
}

// On the table; where the tissue cannot be stretched, as it lies at rest.
function firstPose() {
  const pose = poseOf(0, reference().point, [...kInFront, 0]),
    skin = stretchedSkin() || (state.body && state.body.skin);
  return skin ? raised(pose, -heightOf(skin, pose)) : pose;
}

function Numbered({pose}) {
  const turn = turnOf(pose),
    {name, point} = reference();
  if (turn === null)
    return h(
      "p",
      {class: "soft", "data-place": "tilted"},
      "The specimen is tilted, or the matrix is not a turn about the vertical: only the matrix below says how it lies.",
    );
  const place = moved(point, pose);
  return h(
    "div",
    {"data-place": "upright"},
    h(VectorInput, {
      label: name,
      value: place.map((value) => Number(value.toFixed(2))),
      onChange: (next) => put(poseOf(turn, point, next)),
    }),
    h(NumberInput, {
      label: "Turn about the vertical",
      unit: "deg",
      step: 5,
      value: Number(turn.toFixed(6)),
      hint: turnText(turn),
      onChange: (degrees) => put(poseOf(degrees, point, place)),
    }),
  );
}

const kWays = {0: "x axis", 90: "y axis", 180: "−x axis, towards its base", 270: "−y axis"};

// The front of the specimen is -y of the scan.
function turnText(turn) {
  const angle = (((turn - 90) % 360) + 360) % 360,
    way = kWays[Number(angle.toFixed(3))];
  return way
    ? `The front of the tissue then points along the robot's ${way}.`
    : `The front of the tissue then points ${fixed(angle, 1)}° from the robot's x axis, counter-clockwise from above.`;
}

// --- The table. ---

function tableZ() {
  return state.arm ? state.arm.table_z_mm : 0;
}

// Null before the tissue is stretched.
function stretchedSkin() {
  const {stretch} = state;
  return stretch && !stretch.note ? stretch.skin : null;
}

// How far the lowest point of a skin lies above the table, mm.
function heightOf({vertices}, pose) {
  let lowest = Infinity;
  for (let i = 0; i < vertices.length; i += 3)
    lowest = Math.min(lowest, moved([vertices[i], vertices[i + 1], vertices[i + 2]], pose)[2]);
  return lowest - tableZ();
}

// The same pose, so much higher, mm.
function raised([x, y, [a, b, c, z], last], by) {
  return [x, y, [a, b, c, Number((z + by).toFixed(4))], last];
}

function Height({pose}) {
  const skin = stretchedSkin();
  if (!skin)
    return h("p", {class: "soft height"}, "Once the tissue is stretched, its height above the table is shown here.");
  const height = heightOf(skin, pose),
    table = `the table (robot z = ${plain(tableZ())} mm)`;
  const isOn = Math.abs(height) < kOnTable,
    isBelow = height <= -kOnTable;
  return h(
    "div",
    {class: isFresh("stretch") ? "height" : "height stale", "data-height": height.toFixed(3)},
    h(
      "p",
      {class: isBelow ? "warning" : null},
      isOn
        ? `The tissue's lowest point lies on ${table}.`
        : `The tissue's lowest point lies ${mm(Math.abs(height))} ${isBelow ? "below" : "above"} ${table}. `,
      isOn ? null : isBelow ? "It cannot lie there: raise z." : "Something has to hold it at this height.",
    ),
    isOn ? null : h(Button, {onClick: () => put(raised(pose, -height)), "data-do": "set-down"}, "Put it on the table"),
  );
}

// --- The matrix. ---

function Matrix({pose, problem}) {
  return h(
    "details",
    {"data-matrix": "yes", open: turnOf(pose) === null || undefined},
    h("summary", null, "As a matrix"),
    softText("From the scan's coordinates to the robot's, by rows; the last column is in mm."),
    h(
      "table",
      {class: "matrix"},
      h(
        "tbody",
        null,
        pose.map((row, r) =>
          h(
            "tr",
            {key: r},
            row.map((value, c) => h("td", {key: c}, h(Entry, {pose, r, c, value, problem}))),
          ),
        ),
      ),
    ),
  );
}

function Entry({pose, r, c, value, problem}) {
  return h("input", {
    type: "number",
    step: "any",
    value: plain(value),
    "aria-label": `Row ${r + 1}, column ${c + 1}`,
    "aria-invalid": problem ? "true" : undefined,
    ...kSelected,
    onChange: (event) => put(pose.with(r, pose[r].with(c, Number(event.target.value)))),
  });
}
