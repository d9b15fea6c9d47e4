// Step 9: where the simulated tissue lies under the camera, and the run's path laid on it.

import {h} from "preact";
import {useEffect, useRef, useState} from "preact/hooks";
import {state, update, isFresh} from "./store.js";
import {chooseCloud, goTo, lay, makeCloud, refuseRegistration, register} from "./actions.js";
import {Frame} from "./frame_panel.js";
import {
  AsOf,
  Button,
  Choice,
  FactList,
  NumberInput,
  Numbers,
  Problems,
  Reasons,
  Section,
  Status,
  Working,
  rowOf,
  softText,
} from "./widgets.js";
import {FilePicker} from "./file_list.js";
import {LaidGate, laidOf} from "./laid_gate.js";
import {Commands} from "./commands.js";
import {Withdrawn, isCurrent} from "./programs.js";
import {registeredView} from "./registered.js";
import {kUnseen, scaleColour} from "./colours.js";
import {fixed, isNumber, mm, spoken} from "./words.js";

const kEndings = [".ply", ".vtp", ".stl", ".obj"];
const kScales = [
  ["fixed", "fixed: the cloud has its true size"],
  ["free", "free"],
  ["range", "within a range"],
];
const kSources = [
  ["cloud", "A cloud"],
  ["frame", "A colour and depth picture"],
];
const kFrames = [
  ["robot", "in the robot's frame"],
  ["camera", "in a camera's frame"],
];

const kBody = ["body", "stretch"];

/** The panel. */
export function StepRegister() {
  const {cloud, register: found} = state;
  return h(
    "div",
    {"data-register": found ? found.registration.outcome : "none"},
    h(Cloud),
    cloud.file ? h(Settings) : h(Problems, {calls: kBody}),
    found ? h(Result, {found}) : null,
    found ? h(Decision) : null,
    state.lay ? h(Laid, {kind: "incise"}) : null,
    state.mark ? h(Laid, {kind: "mark"}) : null,
    h("p", {role: "status", class: state.notice ? "notice" : undefined}, state.notice),
  );
}

const kDoing = [
  ["body", "Meshing the body"],
  ["stretch", "Stretching"],
  ["virtual_cloud", "Making the cloud"],
  ["frame", "Looking for the mark"],
];

/** Says of a cloud that nobody measured it. */
function MadeUp() {
  return h("span", {class: "badge", "data-virtual": "yes"}, "virtual cloud, made up");
}

function isMadeUp() {
  return state.register ? state.register.is_virtual : state.cloud.isVirtual;
}

function Cloud() {
  const {cloud} = state;
  return h(
    Section,
    {title: "What the camera sees", id: "cloud", doing: kDoing},
    h(Choice, {label: "Given as", value: cloud.from, options: kSources, onChange: (from) => setCloud({from})}),
    softText("The tissue on the table, stretched as it is simulated."),
    cloud.from === "frame" ? h(Frame) : h(Points),
  );
}

function Points() {
  const {cloud} = state,
    [seed, setSeed] = useState(1);
  return [
    h("p", {class: "soft", key: "about"}, "A cloud of points or a surface, mm."),
    cloud.file ? h("p", {class: "path", key: "name"}, cloud.file.name, " ", isMadeUp() ? h(MadeUp) : null) : null,
    h(FilePicker, {
      key: "picker",
      label: "cloud",
      endings: kEndings,
      chosen: cloud.file,
      onChoose: (file) => chooseCloud(file),
      id: "cloud",
    }),
    h(
      "details",
      {key: "virtual"},
      h("summary", null, "Make a virtual cloud for practice"),
      softText("A cloud as a depth camera might give it of this case's stretched specimen, made up."),
      h(NumberInput, {label: "Seed", value: seed, step: 1, min: 0, onChange: setSeed}),
      h(
        Button,
        {disabled: Boolean(state.busy.virtual_cloud), onClick: () => makeCloud(seed), "data-do": "virtual-cloud"},
        "Make a virtual cloud",
      ),
    ),
    h(Problems, {key: "problems", calls: ["virtual_cloud"]}),
  ];
}

function setCloud(patch) {
  update({cloud: {...state.cloud, ...patch}});
}

function Settings() {
  const {cloud} = state;
  return h(
    Section,
    {title: "Registration", id: "registration"},
    h(Choice, {label: "Scale", value: cloud.scale, options: kScales, onChange: (scale) => setCloud({scale})}),
    cloud.scale === "range"
      ? h(Numbers, {
          label: "Scale of the cloud",
          names: ["least", "greatest"],
          value: cloud.range,
          step: 0.01,
          onChange: (range) => setCloud({range}),
        })
      : null,
    h(NumberInput, {
      label: "Settling",
      unit: "mm",
      value: cloud.settling_mm,
      step: 0.5,
      min: 0,
      hint: "How far the tissue may have settled since it was simulated. 0: the pose alone.",
      onChange: (settling_mm) => setCloud({settling_mm}),
    }),
    rowOf(
      h(
        Button,
        {isMain: true, disabled: Boolean(state.busy.register), onClick: register, "data-do": "register"},
        state.register ? "Register again" : "Register",
      ),
      h(Working, {call: "register", text: "Registering"}),
    ),
    h(Problems, {calls: [...kBody, "register"]}),
  );
}

// --- What was found. ---

function Result({found}) {
  const {registration} = found,
    reasons = registration.reasons || [];
  return h(
    Section,
    {title: "Result", id: "registration-result"},
    h(AsOf, {isNow: isFresh("register"), past: "The settings have changed since this registration."}),
    h(
      "p",
      {class: "verdict"},
      h(Status, {status: registration.converged ? found.verdict.status : "refused"}),
      ` Outcome: ${spoken(registration.outcome).toLowerCase()}. `,
      found.is_virtual ? h(MadeUp) : null,
    ),
    h(
      "ul",
      {class: "reasons"},
      reasons.map((reason, k) => h("li", {key: k}, h("div", {class: "reason"}, reason))),
    ),
    found.sample ? null : softText("There is no pose, so the cloud is not shown."),
    h(Fit, {registration}),
    h(Edges, {edges: found.edges}),
    registration.certificate ? h(Observability, {certificate: registration.certificate}) : null,
    h(Commands, {lines: [found.command], files: found.files}),
  );
}

// How far the edge that is marked on the tissue lies from where the case has it.
function Edges({edges}) {
  if (!edges || !isNumber(edges.mean_mm)) return null;
  return h(
    "p",
    {"data-edges": "yes"},
    "The edge marked on the tissue lies ",
    h("strong", {"data-edge": "mean"}, mm(edges.mean_mm)),
    " from the case's tumour edge on average, and at most ",
    h("strong", {"data-edge": "greatest"}, mm(edges.greatest_mm)),
    ".",
  );
}

const percent = (value) => (isNumber(value) ? `${fixed(100 * value, 0)} %` : "–");

function Fit({registration: r}) {
  const rows = [
    ["rmse_mm", "Root mean square residual", mm(r.rmse_mm)],
    ["inlier_fraction", "Points that fit", percent(r.inlier_fraction)],
    ["noise_mm", "Noise of the cloud", mm(r.noise_mm)],
    ["shape_residual_mm", "Difference in shape", mm(r.shape_residual_mm)],
    ["settled_max_mm", "Greatest settling", mm(r.settled_max_mm)],
    ["scale", "Scale", isNumber(r.scale) ? fixed(r.scale, 4) : "–"],
  ];
  return h(FactList, {rows, keyName: "data-fit"});
}

/** How well the surfaces determine the pose. */
function Observability({certificate: c}) {
  const rows = [
    ["position", "Position", mm(c.translation_sd_mm)],
    ["rotation", "Rotation", isNumber(c.rotation_sd_deg) ? `${fixed(c.rotation_sd_deg, 2)}°` : "–"],
    ["scale", "Scale", percentFine(c.scale_sd)],
    ["weakest", "Weakest motion", mm(c.weakest_sd_mm)],
  ];
  return h(
    "div",
    {"data-observability": "there"},
    h("h3", null, "Pose observability"),
    h("p", {class: "about"}, "Standard deviation of what the surfaces determine:"),
    h(FactList, {rows}),
    c.weakest_motion ? h("p", {class: "about"}, `The weakest motion is ${c.weakest_motion}.`) : null,
    h(Motions, {visible: c.visible || []}),
  );
}

const percentFine = (value) => (isNumber(value) ? (value > 0 ? `${fixed(100 * value, 2)} %` : "fixed") : "–");

function Motions({visible}) {
  if (!visible.length) return null;
  return h(
    "details",
    null,
    h("summary", null, `How much each of the ${visible.length} motions shows`),
    h(
      "p",
      {class: "about"},
      "Share of a motion that changes the distances, weakest first. 0: the surfaces slide freely.",
    ),
    h(
      "ol",
      {class: "motions"},
      visible.map((share, k) =>
        h(
          "li",
          {key: k},
          h("meter", {min: 0, max: 1, value: share, "aria-label": `Motion ${k + 1}`}),
          h("span", null, fixed(share, 3)),
        ),
      ),
    ),
  );
}

// --- The decision. ---

// Kind, button, what it does, and the name for tests.
const kKinds = [
  [
    "incise",
    "Lay the incision",
    "Puts the run's path on the measured tissue, for a program that cuts along it.",
    "lay",
  ],
  [
    "mark",
    "Mark the edge again",
    "Puts the tumour's edge there, for a program that marks it by electrocautery, 1 mm deep at 2 mm/s. The paper does " +
      "so before the cut, so that the edge is seen in the photograph.",
    "lay-mark",
  ],
];

function Decision() {
  const {cloud, run} = state;
  const isReady = Boolean(run) && (cloud.frame === "robot" || cloud.camera);
  return h(
    Section,
    {title: "Decision", id: "decision", doing: [["lay", "Laying the path"]]},
    cloud.isOfFrame
      ? h("p", null, "The frame's cloud is where the camera sees it. To lay a path, say where the camera is.")
      : h(Choice, {
          label: "The cloud is",
          value: cloud.frame,
          options: kFrames,
          onChange: (frame) => setCloud({frame}),
        }),
    cloud.frame === "camera" ? h(Camera) : null,
    kKinds.map(([kind, title, about, name], k) =>
      h(
        "div",
        {key: kind, class: "act"},
        h(
          Button,
          {isMain: k === 0, disabled: !isReady || Boolean(state.busy.lay), onClick: () => lay(kind), "data-do": name},
          title,
        ),
        h("p", {class: "about"}, about),
      ),
    ),
    h(
      "div",
      {class: "act"},
      h(Button, {onClick: refuseRegistration, "data-do": "refuse"}, "Refuse"),
      h("p", {class: "about"}, "Removes this registration and all that was laid by it."),
    ),
    run
      ? null
      : softText(
          "There is no path to lay: the case has not been run in this session. ",
          h(Button, {onClick: () => goTo("run")}, "Go to the run"),
        ),
    laidOf(state.layKind).result ? null : h(Problems, {calls: ["lay"]}),
  );
}

function Camera() {
  const {camera} = state.cloud;
  return [
    h(
      "p",
      {class: "path", key: "name"},
      camera ? camera.name : "A file that says where the camera is under the robot (T_robot_camera).",
    ),
    h(FilePicker, {
      key: "picker",
      label: "camera's file",
      endings: [".json"],
      chosen: camera,
      onChoose: (file) => setCloud({camera: file}),
      id: "camera",
    }),
  ];
}

const kFollows = {
  corrected: "The corrected path is laid on the tissue, in the robot's frame.",
  planned: "The planned path is laid on the tissue, in the robot's frame.",
  edge: "The tumour's edge is laid on the tissue, in the robot's frame, to be marked.",
};

function Laid({kind}) {
  const {of, result} = laidOf(kind),
    verdict = useRef(null);
  useEffect(() => verdict.current.scrollIntoView({block: "center"}), [result]);
  return h(
    "div",
    {[kind === "mark" ? "data-marked" : "data-laid"]: result.program ? "program" : "none"},
    isMadeUp() ? h("p", {class: "warning"}, h(MadeUp), " No real tissue lies where this path leads.") : null,
    h(
      Section,
      {title: kind === "mark" ? "Verdict on the mark" : "Verdict on the incision", id: `${of}-verdict`},
      h(
        "p",
        {class: "verdict", ref: verdict},
        h(Status, {status: result.verdict.status}),
        ` ${kFollows[result.follows]}`,
      ),
      h(Reasons, {verdict: result.verdict}),
    ),
    isCurrent(of)
      ? [h(LaidGate, {key: "gate", kind}), h(Commands, {key: "commands", lines: result.commands, files: result.files})]
      : h(Withdrawn, {of}),
  );
}

// --- The legend of the residuals. ---

const kSteps = 24;

/** The colours of the residuals, with their ends in mm. */
export function ResidualScale() {
  const view = registeredView(state.register);
  if (!view) return null;
  const shares = Array.from({length: kSteps + 1}, (_, k) => (2 * k) / kSteps - 1);
  const stops = shares.map((share) => `rgb(${scaleColour(share).map(Math.round).join()})`);
  return h(
    "figure",
    {class: "residual-scale", "data-top": view.top_mm},
    h("figcaption", null, "Surface above the cloud", isMadeUp() ? h(MadeUp) : null),
    h("div", {class: "ramp", style: {background: `linear-gradient(to right, ${stops.join()})`}}),
    h(
      "div",
      {class: "row between"},
      h("span", null, `≤ −${view.top_mm}`),
      h("span", null, "0"),
      h("span", null, `≥ ${view.top_mm} mm`),
    ),
    view.hasUnseen
      ? h(
          "div",
          {class: "row tight soft"},
          h(
            "svg",
            {class: "swatch", viewBox: "0 0 14 10", "aria-hidden": "true"},
            h("rect", {width: 14, height: 10, rx: 2, fill: kUnseen}),
          ),
          "not seen by the camera",
        )
      : null,
  );
}
