// Step 4: how the specimen is held, and what the pull does to it.

import {h} from "preact";
import {useRef} from "preact/hooks";
import {state, update, isFresh} from "./store.js";
import {isAwaited, refresh} from "./actions.js";
import {rowsOf} from "./fields.js";
import {
  Button,
  Choice,
  Explained,
  NumberInput,
  VectorInput,
  Problems,
  Section,
  Settings,
  Slider,
  Steady,
  StepLinks,
  TextInput,
  Working,
  complaint,
  problemAt,
  rowOf,
  softText,
} from "./widgets.js";
import {
  kConstraints,
  kKinds,
  kWords,
  constraints,
  directionText,
  inWords,
  putConstraints,
  written,
} from "./constraints.js";
import {Patch} from "./patch_panel.js";
import {beginPatch, leavePatch, shownRegion} from "./patch.js";
import {kDirections, length} from "./geometry.js";
import {crosshair} from "./views.js";
import {holds} from "./colours.js";
import {fixed, isNumber, mm, plain, spoken, whole} from "./words.js";

const kMostColoured = 8; // of the constraints: as many as the body's `held` has bits

// What a new one starts with; the numbers are there to be changed.
const kNew = {
  fixed: {kind: "fixed", where: {end: {direction: "posterior", within_mm: 10}}},
  displaced: {kind: "displaced", where: {end: {direction: "anterior", within_mm: 10}}, displacement_mm: [0, -5, 0]},
  support: {kind: "support", plane: {point_mm: [0, 0, 0], normal: "superior"}},
};
const kNewRegions = {
  end: () => ({end: {direction: "posterior", within_mm: 10}}),
  box_mm: (at) => ({box_mm: [at.map((value) => value - 5), at.map((value) => value + 5)]}),
  sphere: (at) => ({sphere: {center_mm: at, radius_mm: 5}}),
  plane: (at) => ({plane: {point_mm: at, normal: "posterior"}}),
};

/** The panel. */
export function StepHold() {
  const list = constraints();
  return h(
    "div",
    null,
    h(
      Section,
      {title: "Held by", id: "constraints", doing: [["body", "Meshing the body"]]},
      list
        ? h(
            "ul",
            {class: "holds"},
            list.map((one, k) => h("li", {key: k}, h(Constraint, {one, k}))),
          )
        : h(ByDefault),
      rowOf(
        Object.keys(kNew).map((kind) =>
          h(
            Button,
            {key: kind, onClick: () => putConstraints([...(list || []), fresh(kind)]), "data-add": kind},
            `Add a ${kKinds[kind].toLowerCase()}`,
          ),
        ),
      ),
      list ? h(Button, {onClick: backToDefault}, "Back to the default") : null,
      list && list.length > kMostColoured
        ? softText(`The 3D view colours what the first ${kMostColoured} of them hold.`)
        : null,
      h(
        Steady,
        {isWaiting: isAwaited("body") || Boolean(state.busy.change)},
        h(Problems, {calls: ["change"], shown: shownKeys(list)}),
        h(Missing),
      ),
    ),
    h(Body),
    h(Tissue),
    h(Stretch),
  );
}

// The problems of these stand beside their inputs.
function shownKeys(list) {
  const holds = (list || []).map((_, k) => `${kConstraints}[${k}]`);
  return [...holds, ...rowsOf("meshing"), ...rowsOf("specimen.material")];
}

function backToDefault() {
  leavePatch();
  putConstraints([]);
}

/** What the constraints lack before they hold a body. One after the other is added, so that this is no failure. */
function Missing() {
  const {body} = state.problems;
  if (!isAboutConstraints(body)) return h(Problems, {calls: ["body"]});
  return h(
    "div",
    {class: "soft", role: "status", "data-missing": body.path},
    body.path === kConstraints
      ? h(
          "p",
          null,
          h(Explained, {text: `Still needed: ${body.expected} (found: ${body.found}). ${body.hint || ""}`}),
        )
      : null,
    state.body ? h("p", null, "Until the constraints hold the body, the 3D view shows it as it was held last.") : null,
  );
}

function isAboutConstraints(problem) {
  return Boolean(problem && problem.kind === "problem" && problem.path && problem.path.startsWith(kConstraints));
}

function place() {
  return (crosshair() || [0, 0, 0]).map((value) => Number(value.toFixed(1)));
}

function fresh(kind) {
  const one = structuredClone(kNew[kind]);
  if (one.plane) one.plane.point_mm = place();
  return one;
}

function ByDefault() {
  const isNow = isFresh("body"),
    last = useRef([]), // what the default was, while it is computed anew
    found = isNow ? state.body.constraints || [] : last.current;
  last.current = found;
  if (!isNow && state.problems.body) return h(DefaultWithoutBody);
  return h(
    "div",
    null,
    softText("The case says nothing about it, so the body is held by the default:"),
    h(
      "ul",
      {class: isNow ? "facts default" : "facts default stale", "data-default": found.length},
      found.map((one, k) =>
        h(
          "li",
          {key: k},
          h(Dot, {k}),
          inWords(one.setting),
          h("span", {class: "soft"}, ` ${countText(one)}`),
          h(Share, {found: one}),
        ),
      ),
      found.length ? null : h("li", {class: "soft"}, "It is computed for the body as it is now."),
    ),
    h(
      Button,
      {
        disabled: !isNow,
        onClick: () => putConstraints(written(found.map((one) => one.setting)).map(rounded)),
        "data-do": "own-constraints",
      },
      "Change these",
    ),
    h("p", {class: "soft below"}, "The first one that you add replaces the default."),
  );
}

// Without a body there is nothing from which to write it into the case.
function DefaultWithoutBody() {
  const said = ` ${state.case.default_hold}.`;
  return h(
    "div",
    {"data-default": "words"},
    softText(`The case says nothing about it, so the body would be held by the default.${isDefaultSaid() ? "" : said}`),
    softText(
      isAboutConstraints(state.problems.body)
        ? "No body could be made with it. Add a clamp, a pull or a support of your own below: the first one replaces " +
            "the default, and each has its own lengths to change, a pull also its displacement."
        : "Whether the tissue can follow it shows once the body is made. Something else is in the way of that.",
    ),
  );
}

// By the problem, which stands below.
function isDefaultSaid() {
  const {path, message, hint} = state.problems.body,
    isWhole = path === kConstraints || !isAboutConstraints(state.problems.body);
  return isWhole && `${message} ${hint}`.includes(state.case.default_hold);
}

// A plane found under the body has more decimals than a person would type.
function rounded(one) {
  if (!one.plane) return one;
  return {...one, plane: {...one.plane, point_mm: one.plane.point_mm.map((value) => Number(value.toFixed(2)))}};
}

// A support holds what comes to rest on it, which is not known before.
function countText({kind, vertices}) {
  return kind === "support" ? "" : `${whole(vertices)} vertices of the mesh.`;
}

/** How long a pull is beside the body; nothing for what pulls at nothing. */
function Share({found, isStale = false}) {
  const {share_of_length: share, note, setting: one} = found;
  if (!isNumber(share)) return null;
  const pull = length(one.displacement_mm);
  return h(
    "div",
    {class: isStale ? "share stale" : "share", "data-share": share.toFixed(3)},
    softText(
      `A pull of ${plain(Number(pull.toFixed(1)))} mm: ${fixed(100 * share, 0)} % of the body's length that way.`,
    ),
    note ? h("p", {class: "warning"}, note) : null,
  );
}

function Dot({k}) {
  return h(
    "svg",
    {class: "dot", viewBox: "0 0 10 10", "aria-hidden": "true"},
    h("circle", {cx: 5, cy: 5, r: 5, fill: holds[k % holds.length]}),
  );
}

function Constraint({one, k}) {
  const set = (patch) => putConstraints(constraints().with(k, {...one, ...patch}));
  const found = state.body && state.body.constraints && state.body.constraints[k];
  const problem = problemAt(`${kConstraints}[${k}]`),
    isRefused = problem && problem === state.problems.change;
  const remove = () => {
    leavePatch();
    putConstraints(constraints().toSpliced(k, 1));
  };
  return h(
    "fieldset",
    {class: "hold"},
    h(
      "legend",
      null,
      h(Dot, {k}),
      kKinds[one.kind] || spoken(one.kind),
      found && found.kind !== "support" ? h(Count, {vertices: found.vertices}) : null,
    ),
    one.where ? h(Region, {k, where: shownRegion(one, k), onChange: (where) => set({where})}) : null,
    h(Own, {one, set}),
    found && one.kind === "displaced" ? h(Share, {found, isStale: !isFresh("body")}) : null,
    problem
      ? h(
          "p",
          isRefused ? {class: "problem", role: "alert"} : {class: "soft"},
          h(Explained, {text: complaint(problem)}),
        )
      : null,
    h(Button, {onClick: remove, "aria-label": `Remove constraint ${k + 1}, ${one.kind}`}, "Remove"),
  );
}

// Before the body is there anew, the count is that of the settings before.
function Count({vertices}) {
  const text = ` ${whole(vertices)} vertices`;
  return isFresh("body")
    ? h("span", {class: "soft"}, text)
    : h("span", {class: "soft", "data-stale": vertices}, `${text} with earlier settings`);
}

function Own({one, set}) {
  if (one.kind === "displaced") {
    return h(VectorInput, {
      label: "Displacement",
      value: one.displacement_mm,
      hint: "x to the patient's left, y to the back, z to the head: y −8 pulls 8 mm forwards.",
      onChange: (displacement_mm) => set({displacement_mm}),
    });
  }
  if (one.kind === "traction") {
    return h(VectorInput, {
      label: "Traction",
      unit: "kPa",
      value: one.traction_kpa,
      step: 0.1,
      onChange: (traction_kpa) => set({traction_kpa}),
    });
  }
  if (one.plane) return h(PlaneInputs, {plane: one.plane, onChange: (plane) => set({plane})});
  if (one.surface)
    return softText(`Surface: ${typeof one.surface === "string" ? one.surface : one.surface.name}`);
  return null;
}

function PlaneInputs({plane, onChange}) {
  return h(
    "div",
    null,
    h(VectorInput, {
      label: "Point",
      value: plane.point_mm,
      onChange: (point_mm) => onChange({...plane, point_mm}),
    }),
    h(Direction, {label: "Normal", value: plane.normal, onChange: (normal) => onChange({...plane, normal})}),
  );
}

function Direction({label, value, onChange}) {
  const isOther = Array.isArray(value);
  const choose = (word) => onChange(word === "other" ? kDirections[value] || [0, 0, 1] : word);
  return h(
    "div",
    null,
    h(Choice, {
      label,
      value: isOther ? "other" : value,
      onChange: choose,
      options: [...kWords.map((word) => [word, directionText(word)]), ["other", "Three numbers"]],
    }),
    isOther ? h(VectorInput, {label: `${label}, x y z`, unit: "", value, step: 0.1, onChange}) : null,
  );
}

function Region({k, where, onChange}) {
  const kind = Object.keys(where)[0];
  const kinds = [
    ["end", "End"],
    ["box_mm", "Box"],
    ["sphere", "Sphere"],
    ["plane", "Plane"],
    ["patch", "Painted patch"],
  ];
  const choose = (name) => {
    if (name === "patch") return beginPatch(k);
    leavePatch();
    return kNewRegions[name] && onChange(kNewRegions[name](place()));
  };
  const known = kinds.some(([name]) => name === kind);
  return h(
    "div",
    null,
    h(Choice, {
      label: "Where",
      value: kind,
      options: known ? kinds : [...kinds, [kind, spoken(kind)]],
      onChange: choose,
    }),
    kind === "patch"
      ? h(Patch, {k, patch: where.patch})
      : h(RegionInputs, {kind, value: where[kind], onChange: (value) => onChange({[kind]: value})}),
  );
}

// A length of 0 mm or more.
function Length(about) {
  return h(NumberInput, {unit: "mm", step: 1, min: 0, ...about});
}

function RegionInputs({kind, value, onChange}) {
  const set = (patch) => onChange({...value, ...patch});
  if (kind === "end") {
    return h(
      "div",
      {class: "pair"},
      h(Direction, {label: "Direction", value: value.direction, onChange: (direction) => set({direction})}),
      h(Length, {label: "Within", value: value.within_mm, onChange: (within_mm) => set({within_mm})}),
    );
  }
  if (kind === "box_mm") {
    return h(
      "div",
      null,
      ["Low corner", "High corner"].map((label, side) =>
        h(VectorInput, {
          key: label,
          label,
          value: value[side],
          onChange: (corner) => onChange(value.with(side, corner)),
        }),
      ),
    );
  }
  if (kind === "sphere") {
    return h(
      "div",
      null,
      h(VectorInput, {label: "Centre", value: value.center_mm, onChange: (center_mm) => set({center_mm})}),
      h(Length, {label: "Radius", value: value.radius_mm, onChange: (radius_mm) => set({radius_mm})}),
    );
  }
  if (kind === "plane") {
    return h(
      "div",
      null,
      h(PlaneInputs, {plane: value, onChange: set}),
      h(Length, {
        label: "Within",
        value: value.within_mm,
        isOptional: true,
        onChange: (within_mm) => set({within_mm}),
        hint: "Empty: everything on the normal's side.",
      }),
    );
  }
  return h(TextInput, {label: "Array and value, NAME=VALUE", value: String(value), onChange});
}

function Body() {
  const {body} = state;
  return h(
    Section,
    {title: "Body", id: "body"},
    body
      ? h("p", {class: isFresh("body") ? "lines-2" : "lines-2 stale", "data-tets": body.tets}, sizeText(body))
      : h("p", {class: "lines-2 soft"}, "There is no mesh yet."),
    h(Rows, {
      title: "Mesh",
      group: "meshing",
      about: "The body is filled with tetrahedra. 0: as many as the lengths of their edges give.",
    }),
  );
}

function sizeText({tets, skin}) {
  const text = `The mesh has ${whole(tets)} tetrahedra, and ${whole(skin.vertices.length / 3)} vertices on its skin`;
  return isFresh("body") ? `${text}.` : `${text}, with earlier settings.`;
}

/** What the tissue is, as far as one input each can say it. */
function Tissue() {
  return h(
    Section,
    {title: "Tissue", id: "tissue"},
    h(Rows, {
      title: "Stiffness and other properties",
      group: "specimen.material",
      about:
        "Young's modulus says how stiff the tissue is, Poisson's ratio how little its volume changes (0.5: not at " +
        "all). At first they are the paper's.",
    }),
  );
}

function Rows({title, group, about}) {
  const keys = rowsOf(group);
  if (!keys.length) return null;
  return h(
    "details",
    {"data-group": group, open: keys.some((key) => problemAt(key)) || undefined},
    h("summary", null, title),
    softText(about),
    h(Settings, {keys}),
  );
}

// What a stretch that is of no use means, by its outcome.
const kWrong = {
  element_inverted:
    "The tissue is pulled farther than the simulation can follow: somewhere it was turned inside out. A short or " +
    "thin piece of tissue does not bear a long pull.",
  not_converged: "The simulation found no position in which the tissue, held like this, comes to rest.",
  cancelled: "The stretch was stopped before its end.",
};

/** What went wrong with a stretch in plain words, what to try, and what the library says. Nothing for a success. */
export function Unstretched({stretch}) {
  if (!stretch || !stretch.note) return null;
  const isHere = state.step === "hold",
    isByDefault = !constraints();
  return h(
    "div",
    {class: "problem block", role: "alert", "data-unstretched": stretch.outcome},
    h("strong", null, "The tissue could not be stretched."),
    h("p", null, kWrong[stretch.outcome] || "The stretch did not end well, and nothing can be planned on it."),
    h("p", null, isHere ? "What to try:" : ["What to try in step", h(StepLinks, {steps: ["hold"]})]),
    h(
      "ul",
      {class: "tries"},
      h("li", null, isByDefault ? "Pull less: press Change these, and make the displacement smaller." : "Pull less."),
      h("li", null, "Clamp and pull larger regions, or regions farther apart."),
      h("li", null, "Make the mesh finer, under Body."),
    ),
    h("p", null, "incise reports: ", h(Explained, {text: stretch.note})),
  );
}

function Stretch() {
  const {stretch, scrub, busy} = state;
  const isStale = stretch && !isFresh("stretch");
  return h(
    Section,
    {title: "Stretch", id: "stretch"},
    rowOf(
      h(
        Button,
        {isMain: !stretch || isStale, disabled: Boolean(busy.stretch), "data-do": "stretch", onClick: stretchAndLook},
        stretch ? "Stretch again" : "Stretch",
      ),
      h(Working, {call: "stretch", text: "Stretching"}),
    ),
    stretch
      ? h(Slider, {
          label: "Rest to stretched",
          max: 1,
          step: 0.01,
          value: scrub,
          said: `${Math.round(100 * scrub)} %`,
          onInput: (share) => update({scrub: share}),
        })
      : null,
    stretch ? h("p", null, `Greatest displacement: ${mm(stretch.greatest_mm)}`) : null,
    isStale ? h("p", {class: "warning"}, "The settings have changed since this stretch.") : h(Unstretched, {stretch}),
    h(Problems, {calls: ["stretch"]}),
  );
}

// The plan gives where the tumour's edge lies on the stretched tissue.
async function stretchAndLook() {
  const found = await refresh("stretch");
  if (!found) return;
  update({scrub: 1});
  if (!found.note && state.case.edge && state.step === "hold") refresh("plan");
}
