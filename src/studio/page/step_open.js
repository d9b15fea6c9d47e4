// Step 1: open a case, make one from a scan, or make the demo specimen.

import {h} from "preact";
import {useEffect, useState} from "preact/hooks";
import {state} from "./store.js";
import {begin, goTo, list} from "./actions.js";
import {Button, Choice, NumberInput, Numbers, Problems, Section, TextInput, Working, problemAt} from "./widgets.js";
import {size, spoken} from "./words.js";

const kSigns = {folder: "▸", scan: "▤", case: "◆"};

/** The panel. */
export function StepOpen() {
  const [scan, setScan] = useState(null);
  useEffect(() => {
    if (!state.files) list();
  }, []);
  return h(
    "div",
    null,
    state.case ? h(OpenCase) : null,
    h(Section, {title: "Files on this computer", id: "files"}, h(Listing, {scan, setScan})),
    scan && state.files ? h(NewCase, {key: scan.id, scan}) : null,
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

function Listing({scan, setScan}) {
  const {files} = state;
  if (!files)
    return h("div", null, h(Working, {call: "files", text: "Reading the folder"}), h(Problems, {calls: ["files"]}));
  const {roots = [], folder, up, entries = []} = files;
  const roomOf = (id) => (roots.some((root) => root.id === id) ? id : "");
  return h(
    "div",
    null,
    roots.length > 1
      ? h(Choice, {
          label: "Start from",
          value: roomOf(folder.id),
          onChange: (id) => id && list(id),
          options: [["", "…"], ...roots.map((root) => [root.id, root.name])],
        })
      : null,
    h(
      "div",
      {class: "row between"},
      h("strong", {class: "path"}, folder.name),
      h(Button, {disabled: !up, onClick: () => list(up)}, "Up"),
    ),
    h(
      "ul",
      {class: "files", "aria-label": `Files in ${folder.name}`},
      entries.map((file) => h(FileRow, {key: file.id, file, isChosen: Boolean(scan) && scan.id === file.id, setScan})),
    ),
    entries.length ? null : h("p", {class: "soft"}, "There is nothing in this folder that can be opened."),
    files.left_out ? h("p", {class: "soft"}, `${files.left_out} more are not shown.`) : null,
    h(Problems, {calls: ["files", "open", "state"]}),
    h(Working, {call: "open", text: "Opening the case"}),
  );
}

function FileRow({file, isChosen, setScan}) {
  const act = {folder: () => list(file.id), case: () => begin("open", {file: file.id}), scan: () => setScan(file)}[
    file.kind
  ];
  const about = h("span", {class: "soft"}, [spoken(file.kind), size(file.bytes)].filter(Boolean).join(", "));
  const name = [
    h("span", {class: "sign", "aria-hidden": "true"}, kSigns[file.kind] || "·"),
    h("span", {class: "name"}, file.name),
    about,
  ];
  if (!act) return h("li", {class: "file"}, name);
  return h(
    "li",
    null,
    h(
      "button",
      {
        type: "button",
        class: "file",
        "data-kind": file.kind,
        "aria-pressed": file.kind === "scan" ? String(isChosen) : undefined,
        onClick: act,
      },
      name,
    ),
  );
}

// Other roots hold what others keep: with them, a new case goes where the studio was started, or where one chooses.
function placesForCase({roots = [], folder}) {
  const here = [folder.id, folder.name];
  if (roots.length < 2) return [here];
  const all = [...roots.map((root) => [root.id, root.name]), here];
  return all.filter(([id], k) => all.findIndex(([other]) => other === id) === k);
}

function NewCase({scan}) {
  const [name, setName] = useState(scan.name.replace(/\.[^/]*$/, "") + "_case");
  const [spacing, setSpacing] = useState(null),
    [hu, setHu] = useState(null);
  const settings = {...(spacing ? {"ct.spacing_mm": spacing} : {}), ...(hu ? {"ct.hu": hu} : {})};
  const places = placesForCase(state.files),
    [place, setPlace] = useState(places[0][0]);
  const make = () => begin("create", {scan: scan.id, folder: place, name, settings});
  return h(
    Section,
    {title: `New case from ${scan.name}`, id: "create"},
    h(TextInput, {label: "Name of its folder", value: name, onChange: setName, problem: problemAt("name")}),
    places.length > 1
      ? h(Choice, {label: "Made in", value: place, options: places, onChange: setPlace, problem: problemAt("folder")})
      : null,
    h(
      "p",
      {class: "soft"},
      "For PNG slices only. DICOM, NRRD, NIfTI and MetaImage scans hold these numbers themselves.",
    ),
    h(Numbers, {
      label: "Spacing",
      unit: "mm",
      names: ["column", "row", "slice"],
      value: spacing,
      step: 0.1,
      onChange: setSpacing,
      problem: problemAt("ct.spacing_mm"),
    }),
    h(Numbers, {
      label: "HU from grey value",
      names: ["slope", "intercept"],
      value: hu,
      step: 1,
      onChange: setHu,
      problem: problemAt("ct.hu"),
    }),
    spacing || hu
      ? h(
          Button,
          {
            onClick: () => {
              setSpacing(null);
              setHu(null);
            },
          },
          "Leave these out",
        )
      : null,
    h(
      Button,
      {isMain: true, disabled: !name || Boolean(state.busy.create), onClick: make, "data-do": "create"},
      "Make the case",
    ),
    h(Working, {call: "create", text: "Reading the scan"}),
    h(Problems, {calls: ["create"], shown: ["name", "ct.spacing_mm", "ct.hu"]}),
  );
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
