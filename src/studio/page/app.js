// The page: its head, the list of steps, the panel of the step, and the views.

import {h, render} from "preact";
import {useEffect, useReducer, useRef} from "preact/hooks";
import {call, listen} from "./api.js";
import {state, subscribe, update, isFresh} from "./store.js";
import {goTo, sendAtOnce, takeEvent, takeState} from "./actions.js";
import {connectViews, frameOn, makeView, views} from "./views.js";
import {kViewNames} from "./scene.js";
import {Button, Check, Status, softText} from "./widgets.js";
import {StepOpen} from "./step_open.js";
import {StepSee} from "./step_see.js";
import {StepEdge} from "./step_edge.js";
import {StepHold} from "./step_hold.js";
import {StepPlan} from "./step_plan.js";
import {StepRun, isRunning} from "./step_run.js";
import {ComparePictures, StepCompare} from "./step_compare.js";
import {PhotographPictures, StepPhotograph} from "./step_photograph.js";
import {ResidualScale, StepRegister} from "./step_register.js";
import {StepProgram} from "./step_program.js";
import {Player} from "./arm_player.js";
import {kPlanes} from "./geometry.js";
import {whereRunIs} from "./run_parts.js";
import {kStepTitles} from "./words.js";

const kPanels = {
  open: StepOpen,
  see: StepSee,
  edge: StepEdge,
  hold: StepHold,
  plan: StepPlan,
  run: StepRun,
  compare: StepCompare,
  photograph: StepPhotograph,
  register: StepRegister,
  program: StepProgram,
};

/** The steps in their order: name, title and panel. */
const kSteps = Object.entries(kStepTitles).map(([name, title]) => [name, title, kPanels[name]]);

const kLinks = {starting: "Connecting", open: "Connected", lost: "No server", denied: "Not allowed"};

function App() {
  const [, redraw] = useReducer((count) => count + 1, 0);
  useEffect(() => subscribe(redraw), []);
  return h(
    "div",
    {class: "page", "data-step": state.step, "data-link": state.link, "data-call-state": callState()},
    h(Head),
    h(Broken),
    h(Steps),
    h("aside", {class: "panel", "aria-label": "Settings of this step"}, h(Panel)),
    h("main", {class: "stage"}, h(ViewTabs), h(Views)),
  );
}

function callState() {
  return Object.values(state.busy).some(Boolean) || Object.keys(state.drafts).length ? "busy" : "idle";
}

function Head() {
  const open = state.case;
  return h(
    "header",
    {class: "head"},
    h("h1", null, "incise studio"),
    open ? h("span", {class: "title"}, open.title) : null,
    open && open.is_virtual ? h("span", {class: "badge"}, "virtual specimen") : null,
    state.run && isFresh("run")
      ? h("span", {class: "head-verdict"}, h(Status, {status: state.run.verdict.status}))
      : null,
    h("span", {class: "space"}),
    h(Job),
    h(
      "span",
      {class: `link ${state.link}`, role: "status", "data-link-state": state.link},
      h("span", {class: "lamp", "aria-hidden": "true"}),
      kLinks[state.link],
    ),
  );
}

function Job() {
  if (!isRunning() || state.step === "run") return null;
  const where = whereRunIs();
  return h(
    "button",
    {type: "button", class: "job", onClick: () => goTo("run")},
    h("span", {class: "spinner", "aria-hidden": "true"}),
    where ? `Running: ${where}` : "Running",
  );
}

const kBroken = {
  lost:
    "The studio's server does not answer. The case is safe on disk. Start incise studio again, then open the address " +
    "that it prints. This page tries again by itself.",
  denied:
    "The server does not accept this page's token. Open the address that incise studio printed, with all that " +
    "follows the #.",
};

function Broken() {
  const text = kBroken[state.link];
  return text ? h("div", {class: "broken", role: "alert"}, text) : null;
}

function Steps() {
  return h(
    "nav",
    {class: "steps", "aria-label": "Steps"},
    h(
      "ol",
      null,
      kSteps.map(([name, title], k) =>
        h(
          "li",
          {key: name},
          h(
            "button",
            {
              type: "button",
              "aria-current": state.step === name ? "step" : undefined,
              disabled: name !== "open" && !state.case,
              "data-go": name,
              onClick: () => goTo(name),
            },
            h("span", {class: "number-sign"}, k + 1),
            title,
          ),
        ),
      ),
    ),
  );
}

function Panel() {
  const at = kSteps.findIndex(([name]) => name === state.step),
    [name, title, Step] = kSteps[at];
  const key = `${name} ${state.case ? state.case.file : ""}`; // what is half typed belongs to this case
  const heading = useRef(null),
    last = useRef(key);
  useEffect(() => {
    if (last.current !== key) {
      heading.current.closest(".panel").scrollTop = 0;
      heading.current.focus({preventScroll: true});
      document.querySelector("[aria-current=step]").scrollIntoView({block: "nearest", inline: "nearest"});
    }
    last.current = key;
  }, [key]);
  const next = kSteps[at + 1];
  return h(
    "div",
    {class: "panel-inside"},
    h("h2", {tabIndex: -1, ref: heading}, title),
    h(Step, {key}),
    next && state.case
      ? h("p", {class: "next"}, h(Button, {onClick: () => goTo(next[0]), "data-do": "next"}, `Next: ${next[1]} →`))
      : null,
  );
}

// --- The views. ---

const kNames = {axial: "Axial", coronal: "Coronal", sagittal: "Sagittal", scene: "3D"};

function shownWhenNarrow() {
  if (!window.matchMedia("(max-width: 820px)").matches) return "";
  return state.step === "see" || state.step === "open" ? "axial" : "scene";
}

// On a narrow page one view is shown at a time; on a wide one the buttons make one of them large.
function ViewTabs() {
  const large = state.large || shownWhenNarrow();
  return h(
    "div",
    {class: "view-tabs", role: "group", "aria-label": "Views"},
    h(Button, {isPressed: !large, onClick: () => update({large: ""})}, "All"),
    Object.entries(kNames).map(([name, title]) =>
      h(
        Button,
        {key: name, isPressed: large === name, "data-large": name, onClick: () => update({large: name})},
        title,
      ),
    ),
  );
}

function Views() {
  const isEmpty = !state.case;
  return h(
    "div",
    {class: "views", "data-large": state.large || "", "data-empty": isEmpty ? "yes" : undefined},
    isEmpty
      ? h(
          "div",
          {class: "empty"},
          h("p", null, "No case is open."),
          softText("Choose a scan or a case on the left, or make the demo specimen."),
        )
      : null,
    [...kPlanes, "scene"].map((name) => h(View, {key: name, name})),
    state.step === "compare" ? h(ComparePictures) : null,
    state.step === "photograph" ? h(PhotographPictures) : null,
    state.step === "program" ? h(Player) : null,
  );
}

function View({name}) {
  const host = useRef(null);
  useEffect(() => makeView(host.current, name), []);
  return h(
    "section",
    {class: `view ${name}`, "aria-label": `${kNames[name]} view`, "data-view": name},
    h(
      "div",
      {class: "view-head"},
      h("span", {class: "view-name"}, kNames[name]),
      name === "scene" ? h(SceneButtons) : null,
    ),
    h("div", {class: "view-host", ref: host}),
    name === "scene" ? h(Legend) : h(NoPicture),
    name === "scene" && state.step === "register" ? h(ResidualScale) : null,
  );
}

function SceneButtons() {
  if (!views.scene) return null;
  return h(
    "span",
    {class: "row tight"},
    kViewNames.map((name) => h(Button, {key: name, onClick: () => views.scene.look(name)}, name)),
    state.step === "program" && state.arm
      ? [
          h(Button, {key: "arm", onClick: () => frameOn("arm"), "data-do": "show-arm"}, "Whole arm"),
          h(Button, {key: "tissue", onClick: () => frameOn("tissue"), "data-do": "show-tissue"}, "Tissue"),
        ]
      : null,
  );
}

function NoPicture() {
  const hasGrid = state.scan || (state.tissue && state.tissue.labels);
  if (hasGrid || !state.case || state.busy.scan) return null;
  return h("p", {class: "no-picture"}, "No scan to show.");
}

function Legend() {
  if (state.noScene) return h("p", {class: "no-picture"}, state.noScene);
  if (!views.scene || !views.scene.layers.size) return null;
  const isFolded = state.step === "compare" || window.innerWidth <= 820;
  return h(
    "details",
    {key: isFolded, class: "legend", open: !isFolded},
    h("summary", null, "Shown"),
    [...views.scene.layers.values()]
      .filter((layer) => layer.name !== "focus")
      .map((layer) =>
        h(
          "div",
          {key: layer.name, class: "legend-row"},
          h(
            "svg",
            {class: "swatch", viewBox: "0 0 14 10", "aria-hidden": "true"},
            layer.isArea
              ? h("rect", {width: 14, height: 10, rx: 2, fill: layer.colour})
              : h("rect", {y: 3.5, width: 14, height: 3, rx: 1.5, fill: layer.colour}),
          ),
          h(Check, {
            label: layer.label,
            isOn: views.scene.isShown(layer.name),
            onChange: (isOn) => views.scene.setShown(layer.name, isOn),
          }),
        ),
      ),
  );
}

// --- Start. ---

window.addEventListener("error", (event) => {
  document.documentElement.dataset.scriptError = event.message;
});
window.addEventListener("unhandledrejection", (event) => {
  document.documentElement.dataset.scriptError = String(event.reason);
});

/** Asks the server how things stand: at the start, and whenever the link is back. */
async function catchUp() {
  try {
    takeState(await call("state"));
  } catch (error) {
    update({link: error.kind === "denied" ? "denied" : state.link});
  }
}

connectViews();
const host = document.getElementById("app");
host.replaceChildren();
render(h(App), host);
listen(takeEvent, (link) => {
  const isBack = link === "open" && state.link !== "open";
  update({link});
  if (isBack) catchUp();
});
window.addEventListener("pagehide", sendAtOnce);
window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => update({}));

/** For tests: what the page knows and its views, to be looked at. */
window.incise = Object.freeze({state, views});
document.documentElement.dataset.pageReady = "yes";
