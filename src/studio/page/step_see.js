// Step 2: look at the scan, and say which part of it is the specimen.

import {h} from "preact";
import {state, update, hasVoxels, setting, isFresh} from "./store.js";
import {change} from "./actions.js";
import {crosshair, fitBox, showPlace} from "./views.js";
import {Brush} from "./brush_panel.js";
import {LabelValues} from "./label_values.js";
import {
  Button,
  Facts,
  NumberInput,
  OddSize,
  VectorInput,
  Problems,
  Reasons,
  Section,
  Setting,
  Slider,
  Status,
  problemAt,
  rowOf,
  softText,
} from "./widgets.js";
import {boxAbout, putBox, regionBox, stepBox} from "./region_box.js";
import {UndoButtons} from "./undo_buttons.js";
import {voxelAt} from "./geometry.js";
import {fixed, mm, plain} from "./words.js";

const kKeys = [
  "ct.window_hu",
  "ct.label_values",
  "ct.roi_box_mm",
  "ct.seed_mm",
  "ct.opening_radius_mm",
  "ct.smoothing_mm",
  "ct.edits",
];

/** The panel. */
export function StepSee() {
  if (!hasVoxels()) return h(MeshOnly);
  return h(
    "div",
    null,
    h(Picture),
    state.case.inputs["ct.labels"] ? h(LabelValues) : h(Values),
    h(Box),
    h(Brush),
    h(Seed),
    h(
      Section,
      {title: "Surface", id: "surface"},
      h(
        "div",
        {class: "pair"},
        h(Setting, {path: "ct.opening_radius_mm", step: 0.5, hint: "Cuts bridges thinner than twice this."}),
        h(Setting, {path: "ct.smoothing_mm", step: 0.1, hint: takenText()}),
      ),
    ),
    h(Found),
  );
}

// What is taken for a smoothing that is not set.
function takenText() {
  const {tissue} = state;
  if (setting("ct.smoothing_mm") !== null || !tissue || !isFresh("tissue")) return null;
  return `Automatic: ${mm(tissue.summary.smoothing_mm)}.`;
}

// A case that begins with a mesh has nothing to find.
function MeshOnly() {
  const {body} = state;
  return h(
    Section,
    {title: "Body", id: "mesh", doing: [["body", "Reading the mesh"]]},
    softText(
      "The case begins with a mesh: there are no slices, and no tissue has to be found. Step Hold sets how it is held.",
    ),
    h(Problems, {calls: ["body"]}),
    body ? h(Facts, {facts: {tets: body.tets, vertices_of_the_skin: body.skin.vertices.length / 3}}) : null,
  );
}

function Values() {
  return h(
    Section,
    {title: "Which values are tissue", id: "window"},
    h(Setting, {path: "ct.window_hu", names: ["least", "greatest"], step: 5}),
  );
}

function Picture() {
  const {scan} = state,
    hasScan = Boolean(state.case.inputs["ct.volume"]),
    here = crosshair(),
    at = here && scan ? voxelAt(scan.grid, here) : -1;
  return h(
    Section,
    {title: "Picture", id: "picture", doing: [["scan", "Reading the scan"]]},
    hasScan ? h(Extent, {scan}) : null,
    hasScan ? h(Greys) : null,
    h(Overlay),
    h(VectorInput, {
      label: "Crosshair",
      value: here && here.map((value) => Number(value.toFixed(1))),
      onChange: (point) => showPlace(point),
      hint: at >= 0 ? `${scan.voxels[at]} HU here` : scan ? "Outside the scan" : null,
      hintLines: hasScan ? 1 : 0,
    }),
    h(Problems, {calls: ["scan"]}),
  );
}

// Before the scan is there its lines have their room.
function Extent({scan}) {
  if (!scan) return h("p", {class: "soft lines-2"});
  const {size, spacing_mm: spacing} = scan.grid,
    lengths = size.map((count, k) => count * spacing[k]);
  const range = [scan.least_hu, scan.greatest_hu].map((value) => fixed(value, 0)).join(" to ");
  return [
    h(
      "p",
      {key: "is", class: "soft lines-2", "data-extent": lengths.map(plain).join(" ")},
      `${size.join(" × ")} voxels: ${lengths.map((length) => fixed(length, 1)).join(" × ")} mm, ${range} HU.`,
    ),
    h(OddSize, {key: "odd", sizes: lengths}),
  ];
}

function Greys() {
  const {window: grey, scan} = state;
  const put = (patch) => update({window: {...grey, ...patch}});
  return [
    h(
      "div",
      {key: "numbers", class: "pair"},
      h(NumberInput, {
        label: "Window width",
        unit: "HU",
        value: Math.round(grey.width),
        step: 10,
        min: 1,
        onChange: (width) => put({width}),
      }),
      h(NumberInput, {
        label: "Level",
        unit: "HU",
        value: Math.round(grey.level),
        step: 10,
        onChange: (level) => put({level}),
      }),
    ),
    h(
      "div",
      {key: "presets", class: "row"},
      h(Button, {onClick: () => put({width: 400, level: 40})}, "Soft tissue"),
      h(Button, {onClick: () => put({width: 2000, level: 400})}, "Bone"),
      h(Button, {disabled: !scan, onClick: () => put(rangeOf(scan))}, "All values"),
    ),
  ];
}

function rangeOf(scan) {
  return {width: scan.greatest_hu - scan.least_hu, level: 0.5 * (scan.greatest_hu + scan.least_hu)};
}

function Overlay() {
  return h(Slider, {
    label: "Tissue overlay",
    max: 0.8,
    step: 0.05,
    value: state.overlay,
    said: `${Math.round(100 * state.overlay)} %`,
    onInput: (overlay) => update({overlay}),
  });
}

function Box() {
  const box = regionBox(),
    scan = state.scan || state.tissue;
  if (!box) {
    return h(
      Section,
      {title: "Region box", id: "box"},
      softText("There is no box: the whole scan is searched. For a box, put the crosshair into the tissue first."),
      rowOf(
        h(
          Button,
          {disabled: !scan, onClick: () => putBox(boxAbout(crosshair(), scan.grid)), "data-do": "box"},
          "Add a box about the crosshair",
        ),
        h(UndoButtons),
      ),
    );
  }
  const put = (side) => (corner) => stepBox(box.with(side, corner));
  return h(
    Section,
    {title: "Region box", id: "box"},
    h(VectorInput, {label: "Low corner", value: box[0], onChange: put(0)}),
    h(VectorInput, {label: "High corner", value: box[1], onChange: put(1), problem: problemAt("ct.roi_box_mm")}),
    rowOf(
      h(Button, {onClick: () => fitBox(box)}, "Zoom to the box"),
      h(Button, {onClick: () => putBox(null)}, "Remove the box"),
      h(UndoButtons),
    ),
  );
}

function Seed() {
  const seed = setting("ct.seed_mm"),
    isPlacing = state.placing === "seed",
    here = crosshair();
  return h(
    Section,
    {title: "Seed", id: "seed"},
    seed
      ? h(VectorInput, {
          label: "Point inside the tissue",
          value: seed,
          problem: problemAt("ct.seed_mm"),
          onChange: (point) => change({"ct.seed_mm": point}),
        })
      : softText("There is no seed: the largest piece is taken."),
    rowOf(
      h(
        Button,
        {isPressed: isPlacing, onClick: () => update({placing: isPlacing ? null : "seed"}), "data-do": "place-seed"},
        isPlacing ? "Click in a slice…" : "Click to place",
      ),
      h(
        Button,
        {disabled: !here, onClick: () => change({"ct.seed_mm": here.map((value) => Number(value.toFixed(1)))})},
        "At the crosshair",
      ),
      seed ? h(Button, {onClick: () => change({"ct.seed_mm": null})}, "Remove") : null,
    ),
  );
}

function Found() {
  const {tissue} = state;
  return h(
    Section,
    {title: "Tissue found", id: "found", doing: [["tissue", "Finding the tissue"]]},
    h(Problems, {calls: ["change", "tissue"], shown: kKeys}),
    tissue
      ? h(
          "div",
          {class: isFresh("tissue") ? null : "stale"},
          tissue.verdict ? h("p", null, h(Status, {status: tissue.verdict.status})) : null,
          h(Reasons, {verdict: tissue.verdict, onPlace: showPlace}),
          h(Facts, {facts: tissue.summary}),
        )
      : null,
    tissue || state.busy.tissue ? null : softText("Nothing yet."),
  );
}
