// Step 1: open a case, make one from a file, or make the demo specimen.

import {h} from "preact";
import {useEffect, useState} from "preact/hooks";
import {state} from "./store.js";
import {begin, goTo, list} from "./actions.js";
import {Button, Choice, NumberInput, Numbers, Problems, Section, TextInput, Working, problemAt} from "./widgets.js";
import {FileList} from "./file_list.js";

// What a case can begin with, by the kind of file, and what is done with it.
const kBeginnings = {
  scan: ["A scan", "Which of its values are tissue is set in the next step."],
  labels: ["Labels", "Each voxel's value says what it is. Which of them are tissue is set in the next step."],
  mesh: ["A mesh", "Tetrahedra, mm. They are the body as it is."],
  surface: ["A surface", "A closed surface, mm. What lies inside is meshed now."],
};

// A file with voxels may be either; only a person knows.
function beginningsOf(file) {
  return file.kind === "scan" && file.bytes ? ["scan", "labels"] : [file.kind];
}

/** The panel. */
export function StepOpen() {
  const [source, setSource] = useState(null);
  useEffect(() => {
    if (!state.files) list();
  }, []);
  return h(
    "div",
    null,
    state.case ? h(OpenCase) : null,
    h(Section, {title: "Files on this computer", id: "files"}, h(Listing, {source, setSource})),
    source && state.files ? h(NewCase, {key: source.id, file: source}) : null,
    h(Demo),
  );
}

function OpenCase() {
  const inputs = Object.entries(state.case.inputs || {}).filter(([, name]) => name);
  return h(
    Section,
    {title: "Open case", id: "open-case"},
    h("p", {class: "path"}, state.case.title, h("br"), h("span", {class: "soft"}, state.case.file)),
    h(
      "dl",
      {class: "facts"},
      inputs.map(([key, name]) => [h("dt", null, key), h("dd", null, String(name))]),
    ),
    h(Button, {onClick: () => goTo("see")}, "Go on with it"),
  );
}

function Listing({source, setSource}) {
  const acts = {folder: (file) => list(file.id), case: (file) => begin("open", {file: file.id})};
  const actOf = (file) => {
    const act = acts[file.kind] || (kBeginnings[file.kind] ? setSource : null);
    return act && (() => act(file));
  };
  const isChosen = (file) => (kBeginnings[file.kind] ? Boolean(source) && source.id === file.id : undefined);
  return h(
    "div",
    null,
    h(FileList, {actOf, isChosen, empty: "There is nothing in this folder that can be opened."}),
    h(Problems, {calls: ["open", "state"]}),
    h(Working, {call: "open", text: "Opening the case"}),
  );
}

// Other roots hold what others keep: with them, a new case goes where the studio was started, or where one chooses.
function placesForCase({roots = [], folder}) {
  const here = [folder.id, folder.name];
  if (roots.length < 2) return [here];
  const all = [...roots.map((root) => [root.id, root.name]), here];
  return all.filter(([id], k) => all.findIndex(([other]) => other === id) === k);
}

function NewCase({file}) {
  const [name, setName] = useState(file.name.replace(/\.[^/]*$/, "") + "_case");
  const [settings, setSettings] = useState({});
  const beginnings = beginningsOf(file),
    [as, setAs] = useState(beginnings[0]);
  const places = placesForCase(state.files),
    [place, setPlace] = useState(places[0][0]);
  const make = () => begin("create", {[as]: file.id, folder: place, name, settings: as === "scan" ? settings : {}});
  return h(
    Section,
    {title: `New case from ${file.name}`, id: "create"},
    beginnings.length > 1
      ? h(Choice, {
          label: "Use it as",
          value: as,
          options: beginnings.map((kind) => [kind, kBeginnings[kind][0]]),
          onChange: setAs,
        })
      : null,
    h("p", {class: "soft"}, kBeginnings[as][1]),
    h(TextInput, {label: "Name of its folder", value: name, onChange: setName, problem: problemAt("name")}),
    places.length > 1
      ? h(Choice, {label: "Made in", value: place, options: places, onChange: setPlace, problem: problemAt("folder")})
      : null,
    as === "scan" && !file.bytes ? h(Reading, {settings, setSettings}) : null,
    h(
      Button,
      {isMain: true, disabled: !name || Boolean(state.busy.create), onClick: make, "data-do": "create"},
      "Make the case",
    ),
    h(Working, {call: "create", text: "Reading the file"}),
    h(Problems, {calls: ["create"], shown: ["name", "ct.spacing_mm", "ct.hu"]}),
  );
}

// How pictures become a scan.
function Reading({settings, setSettings}) {
  const about = (key) => ({
    value: settings[key] || null,
    onChange: (value) => setSettings({...settings, [key]: value}),
    problem: problemAt(key),
  });
  return [
    h(
      "p",
      {key: "about", class: "soft"},
      "For PNG slices only. DICOM, NRRD, NIfTI and MetaImage scans hold these numbers themselves.",
    ),
    h(Numbers, {
      key: "spacing",
      label: "Spacing",
      unit: "mm",
      names: ["column", "row", "slice"],
      step: 0.1,
      ...about("ct.spacing_mm"),
    }),
    h(Numbers, {key: "hu", label: "HU from grey value", names: ["slope", "intercept"], step: 1, ...about("ct.hu")}),
    Object.keys(settings).length
      ? h(Button, {key: "out", onClick: () => setSettings({})}, "Leave these out")
      : null,
  ];
}

function Demo() {
  const [seed, setSeed] = useState(1);
  const folder = state.files && placesForCase(state.files)[0][0];
  return h(
    Section,
    {title: "Demo specimen", id: "demo"},
    h("p", {class: "soft"}, "A virtual tongue with a CT of its own. Another seed gives another shape."),
    h(NumberInput, {label: "Seed", value: seed, step: 1, min: 0, onChange: setSeed}),
    h(
      Button,
      {disabled: !folder || Boolean(state.busy.demo), onClick: () => begin("demo", {folder, seed}), "data-do": "demo"},
      "Make the demo specimen",
    ),
    h(Working, {call: "demo", text: "Making the specimen"}),
    h(Problems, {calls: ["demo"]}),
  );
}
