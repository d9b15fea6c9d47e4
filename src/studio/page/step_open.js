// Step 1: open a case, make one from a file, or make the demo specimen.

import {h} from "preact";
import {useEffect, useState} from "preact/hooks";
import {state} from "./store.js";
import {ask, begin, goTo, list} from "./actions.js";
import {
  Button,
  Choice,
  FactList,
  NumberInput,
  Numbers,
  OddSize,
  Problems,
  Section,
  TextInput,
  Working,
  problemAt,
  rowOf,
  softText,
} from "./widgets.js";
import {FileList} from "./file_list.js";
import {fixed, plain} from "./words.js";

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
    list(); // as it is now: cases may have been made since
  }, []);
  return h(
    "div",
    null,
    state.case ? h(OpenCase) : null,
    h(
      Section,
      {title: "Files on this computer", id: "files", doing: [["open", "Opening the case"]]},
      h(Listing, {source, setSource}),
    ),
    source && state.files ? h(NewCase, {key: source.id, file: source}) : null,
    h(Demo),
  );
}

const kInputs = {
  "ct.volume": "Scan",
  "ct.labels": "Labels",
  "specimen.mesh": "Mesh",
  "tumor.contour": "Tumour's edge",
  "tumor.surface": "Tumour's surface",
  "plan.line": "Line of the cut",
  path: "Path",
};

function OpenCase() {
  const inputs = Object.entries(state.case.inputs || {}).filter(([, name]) => name);
  return h(
    Section,
    {title: "Open case", id: "open-case"},
    h("p", {class: "path"}, state.case.title, h("br"), h("span", {class: "soft"}, state.case.file)),
    h(FactList, {rows: inputs.map(([key, name]) => [key, kInputs[key] || key, String(name)])}),
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
  );
}

// Where a case can be made: in a folder that the studio was started with, or in the one that is listed.
function placesForCase({roots = [], folder}, chosen) {
  const all = [...roots, folder, ...(chosen ? [chosen] : [])];
  return all.filter(({id}, k) => all.findIndex((other) => other.id === id) === k);
}

/** A choice of the folder in which a case is made. @param chosen  {id, name}   @param name  of the case's own folder */
function MadeIn({chosen, onChoose, name, places}) {
  return [
    h(Choice, {
      key: "in",
      label: "Make it in",
      value: chosen.id,
      options: places.map(({id, name: folder}) => [id, folder]),
      onChange: (id) => onChoose(places.find((place) => place.id === id)),
      problem: problemAt("folder"),
    }),
    h(
      "p",
      {key: "as", class: "soft path", "data-made-as": name},
      `It will be ${chosen.name}/${name}. For another folder, go there in the list above, and choose it here.`,
    ),
  ];
}

function usePlace() {
  const [chosen, setChosen] = useState(null),
    places = state.files ? placesForCase(state.files, chosen) : [];
  return {chosen: chosen || places[0], onChoose: setChosen, places};
}

/** What a file becomes a case with. Of a folder the form comes once it is known what lies in it. */
function NewCase({file}) {
  const [name, setName] = useState(file.name.replace(/\.[^/]*$/, "") + "_case");
  const [settings, setSettings] = useState({});
  const beginnings = beginningsOf(file),
    [as, setAs] = useState(beginnings[0]);
  const place = usePlace(),
    folder = place.chosen.id;
  const isFolder = as === "scan" && !file.bytes,
    [pictures, setPictures] = useState(null),
    isReading = as === "scan" && pictures > 0;
  const make = () => begin("create", {[as]: file.id, folder, name, settings: isReading ? settings : {}});
  const own = ["name", "folder", ...(isReading ? ["ct.spacing_mm", "ct.hu"] : [])];
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
    softText(kBeginnings[as][1]),
    isFolder ? h(Inside, {file, setPictures}) : null,
    isReading ? h(Reading, {pictures, settings, setSettings}) : null,
    isFolder && pictures === null
      ? null
      : [
          h(TextInput, {
            key: "name",
            label: "Name of its folder",
            value: name,
            onChange: setName,
            problem: problemAt("name"),
          }),
          h(MadeIn, {key: "in", ...place, name}),
          h(
            "div",
            {key: "row", class: "row"},
            h(
              Button,
              {isMain: true, disabled: !name || Boolean(state.busy.create), onClick: make, "data-do": "create"},
              "Make the case",
            ),
            h(Working, {call: "create", text: "Reading the file"}),
          ),
          isReading ? h(OddHeight, {key: "odd", pictures, spacing: settings["ct.spacing_mm"]}) : null,
          h(Problems, {key: "problems", calls: ["create"], shown: own}),
        ],
  );
}

/** A folder that may be a scan: a way into it, and how many pictures it holds. */
function Inside({file, setPictures}) {
  useEffect(() => {
    ask("files", {folder: file.id}).then((found) => setPictures(found ? found.entries.filter(isPicture).length : 0));
  }, []);
  return rowOf(h(Button, {onClick: () => list(file.id), "data-do": "look-inside"}, "Look into this folder"));
}

function isPicture({name}) {
  return name.toLowerCase().endsWith(".png");
}

// How pictures become a scan.
function Reading({pictures, settings, setSettings}) {
  const about = (key) => ({
    value: settings[key] || null,
    onChange: (value) => setSettings({...settings, [key]: value}),
    problem: problemAt(key),
  });
  return [
    h(
      "p",
      {key: "about", class: "soft"},
      `${pictures} PNG pictures. They hold neither millimetres nor Hounsfield units (HU): state both.`,
    ),
    h(Numbers, {
      key: "spacing",
      label: "Spacing",
      unit: "mm",
      names: ["column", "row", "slice"],
      step: 0.1,
      hint: heightText(pictures, settings["ct.spacing_mm"]),
      hintLines: 1,
      ...about("ct.spacing_mm"),
    }),
    h(Numbers, {
      key: "hu",
      label: "HU from grey value",
      names: ["slope", "intercept"],
      step: 1,
      hint: greysText(settings["ct.hu"]),
      hintLines: 3,
      ...about("ct.hu"),
    }),
  ];
}

function heightText(pictures, spacing) {
  if (!spacing) return "The spacing of the slices gives their height.";
  return `${pictures} slices of ${plain(spacing[2])} mm: ${plain(pictures * spacing[2])} mm from foot to head.`;
}

// Below the inputs: it comes while the next one is about to be clicked.
function OddHeight({pictures, spacing}) {
  return spacing ? h(OddSize, {sizes: [pictures * spacing[2]]}) : null;
}

function greysText(hu) {
  if (!hu) return "HU = slope × grey value + intercept. Air is at −1000 HU, muscle near 50 HU.";
  const at = (grey) => `${grey} is ${fixed(hu[0] * grey + hu[1], 0)} HU`;
  return `Grey value ${at(0)}, ${at(100)}, ${at(255)}. Air should come to −1000 HU, muscle to about 50 HU.`;
}

function Demo() {
  const [seed, setSeed] = useState(1);
  const place = usePlace();
  return h(
    Section,
    {title: "Demo specimen", id: "demo"},
    softText("A virtual tongue with a CT of its own. Another seed gives another shape."),
    h(NumberInput, {label: "Seed", value: seed, step: 1, min: 0, onChange: setSeed}),
    place.chosen ? h(MadeIn, {...place, name: `virtual_tongue_${seed}`}) : null,
    rowOf(
      h(
        Button,
        {
          disabled: !place.chosen || Boolean(state.busy.demo),
          onClick: () => begin("demo", {folder: place.chosen.id, seed}),
          "data-do": "demo",
        },
        "Make the demo specimen",
      ),
      h(Working, {call: "demo", text: "Making it"}),
    ),
    h(Problems, {calls: ["demo"]}),
  );
}
