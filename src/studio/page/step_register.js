// Step 9: where the simulated tissue lies under the camera, and the run's path laid on it.

import {h} from "preact";
import {useState} from "preact/hooks";
import {state, update, isFresh} from "./store.js";
import {chooseCloud, goTo, lay, layAccepting, makeCloud, refuseRegistration, register} from "./actions.js";
import {Button, Choice, NumberInput, Numbers, Problems, Reasons, Section, Status, Working} from "./widgets.js";
import {FilePicker} from "./file_list.js";
import {Gate} from "./gate.js";
import {Commands} from "./commands.js";
import {registeredView} from "./registered.js";
import {kUnseen, scaleColour} from "./colours.js";
import {fixed, isNumber, mm, spoken} from "./words.js";

const kEndings = [".ply", ".vtp", ".stl", ".obj"];
const kScales = [
  ["fixed", "fixed: the cloud has its true size"],
  ["free", "free"],
  ["range", "within a range"],
];
const kFrames = [
  ["robot", "in the robot's frame"],
  ["camera", "in a camera's frame"],
];

/** The panel. */
export function StepRegister() {
  const {cloud, register: found} = state;
  return h(
    "div",
    {"data-register": found ? found.registration.outcome : "none"},
    h(Problems, {calls: ["body", "stretch"]}),
    h(Working, {call: "stretch", text: "Stretching"}),
    h(Cloud),
    cloud.file ? h(Settings) : null,
    found ? h(Result, {found}) : null,
    found ? h(Decision) : null,
    state.lay ? h(Laid) : null,
    h("p", {role: "status", class: state.notice ? "notice" : undefined}, state.notice),
  );
}

/** Says of a cloud that nobody measured it. */
function MadeUp() {
  return h("span", {class: "badge", "data-virtual": "yes"}, "virtual cloud, made up");
}

function isMadeUp() {
  return state.register ? state.register.is_virtual : state.cloud.isVirtual;
}

function Cloud() {
  const {cloud} = state,
    [seed, setSeed] = useState(1);
  return h(
    Section,
    {title: "Cloud", id: "cloud"},
    h("p", {class: "soft"}, "The tissue as the camera sees it: a cloud of points or a surface, mm."),
    cloud.file ? h("p", {class: "path"}, cloud.file.name, " ", isMadeUp() ? h(MadeUp) : null) : null,
    h(FilePicker, {
      label: "cloud",
      endings: kEndings,
      chosen: cloud.file,
      onChoose: (file) => chooseCloud(file),
      id: "cloud",
    }),
    h(
      "details",
      null,
      h("summary", null, "Make a virtual cloud for practice"),
      h("p", {class: "soft"}, "A cloud as a depth camera might give it of this case's stretched specimen, made up."),
      h(NumberInput, {label: "Seed", value: seed, step: 1, min: 0, onChange: setSeed}),
      h(
        Button,
        {disabled: Boolean(state.busy.virtual_cloud), onClick: () => makeCloud(seed), "data-do": "virtual-cloud"},
        "Make a virtual cloud",
      ),
    ),
    h(Working, {call: "virtual_cloud", text: "Making the cloud"}),
    h(Problems, {calls: ["virtual_cloud"]}),
  );
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
    h(
      Button,
      {isMain: true, disabled: Boolean(state.busy.register), onClick: register, "data-do": "register"},
      state.register ? "Register again" : "Register",
    ),
    h(Working, {call: "register", text: "Registering"}),
    h(Problems, {calls: ["register"]}),
  );
}

// --- What was found. ---

function Result({found}) {
  const {registration} = found,
    reasons = registration.reasons || [];
  return h(
    Section,
    {title: "Result", id: "registration-result"},
    isFresh("register") ? null : h("p", {class: "warning"}, "The settings have changed since this registration."),
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
    found.sample ? null : h("p", {class: "soft"}, "There is no pose, so the cloud is not shown."),
    h(Fit, {registration}),
    registration.certificate ? h(Observability, {certificate: registration.certificate}) : null,
    h(Commands, {lines: [found.command], files: found.files}),
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
  return h(
    "dl",
    {class: "facts"},
    rows.map(([key, name, value]) => [h("dt", {key}, name), h("dd", {key: `${key}-value`, "data-fit": key}, value)]),
  );
}

/** How well the surfaces determine the pose. */
function Observability({certificate: c}) {
  const rows = [
    ["Position", mm(c.translation_sd_mm)],
    ["Rotation", isNumber(c.rotation_sd_deg) ? `${fixed(c.rotation_sd_deg, 2)}°` : "–"],
    ["Scale", percentFine(c.scale_sd)],
    ["Weakest motion", mm(c.weakest_sd_mm)],
  ];
  return h(
    "div",
    {"data-observability": "there"},
    h("h3", null, "Pose observability"),
    h("p", {class: "about"}, "Standard deviation of what the surfaces determine:"),
    h(
      "dl",
      {class: "facts"},
      rows.map(([name, value]) => [h("dt", {key: name}, name), h("dd", {key: `${name} value`}, value)]),
    ),
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

function Decision() {
  const {cloud, run} = state;
  const isReady = Boolean(run) && (cloud.frame === "robot" || cloud.camera);
  return h(
    Section,
    {title: "Decision", id: "decision"},
    h(Choice, {
      label: "The cloud is",
      value: cloud.frame,
      options: kFrames,
      onChange: (frame) => setCloud({frame}),
    }),
    cloud.frame === "camera" ? h(Camera) : null,
    h(
      "div",
      {class: "row"},
      h(
        Button,
        {isMain: true, disabled: !isReady || Boolean(state.busy.lay), onClick: lay, "data-do": "lay"},
        "Lay the path on this tissue",
      ),
      h(Button, {onClick: refuseRegistration, "data-do": "refuse"}, "Refuse"),
    ),
    run
      ? null
      : h(
          "p",
          {class: "soft"},
          "There is no path to lay: the case has not been run in this session. ",
          h(Button, {onClick: () => goTo("run")}, "Go to the run"),
        ),
    h(Working, {call: "lay", text: "Laying the path"}),
    state.lay ? null : h(Problems, {calls: ["lay"]}),
  );
}

function Camera() {
  const {camera} = state.cloud;
  return [
    h("p", {class: "path", key: "name"}, camera ? camera.name : "A camera's file with T_robot_camera."),
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

function Laid() {
  const {lay: laid} = state;
  return h(
    "div",
    {"data-laid": laid.program ? "program" : "none"},
    isMadeUp() ? h("p", {class: "warning"}, h(MadeUp), " No real tissue lies where this path leads.") : null,
    isFresh("lay") ? null : h("p", {class: "warning"}, "The settings have changed since the path was laid."),
    h(
      Section,
      {title: "Verdict", id: "laid-verdict"},
      h(
        "p",
        {class: "verdict"},
        h(Status, {status: laid.verdict.status}),
        ` The ${laid.follows} path is laid on the tissue, in the robot's frame.`,
      ),
      h(Reasons, {verdict: laid.verdict}),
    ),
    h(Gate, {
      result: laid,
      accepted: state.acceptLaid,
      onAccept: (acceptLaid) => update({acceptLaid}),
      onAgain: layAccepting,
      fileName: "incise_on_tissue.script",
      again: "Lay it again with these accepted",
      call: "lay",
      isBusy: Boolean(state.busy.lay),
    }),
    h(Commands, {lines: laid.commands, files: laid.files}),
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
