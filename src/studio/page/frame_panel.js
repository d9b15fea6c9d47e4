// A frame of a colour and depth camera: its files, the mark that is found on it, and its cloud.

import {h} from "preact";
import {useEffect, useRef} from "preact/hooks";
import {state, update} from "./store.js";
import {frameArguments, readFrame} from "./actions.js";
import {AsOf, Button, Check, Choice, FactList, NumberInput, Problems, softText} from "./widgets.js";
import {FilePicker} from "./file_list.js";
import {imageOf} from "./photo_view.js";
import {Commands} from "./commands.js";
import {fixed, isNumber, mm, spoken, whole} from "./words.js";

const kPictures = [".png", ".jpg", ".jpeg", ".tif", ".tiff"];
const kForms = [
  ["pictures", "a colour picture and a depth picture"],
  ["cloud", "one organised, coloured cloud (.ply)"],
];
const kMarks = [
  ["green", "green"],
  ["red", "red"],
  ["none", "there is none"],
];

// Key, name, endings, and what it is.
const kFiles = [
  ["color", "colour picture", kPictures, "What the camera sees, with the marked edge on it."],
  ["depth", "depth picture", [".png", ".tif", ".tiff"], "How far away each point is: a grey picture of 16 bits."],
  [
    "intrinsics",
    "camera's numbers",
    [".json"],
    "The lens of the camera: focal lengths, middle, distortion, unit of depth.",
  ],
];
const kCloudFile = [
  "organised",
  "cloud",
  [".ply"],
  "Points in the order of the picture's pixels, each with its colour.",
];

function setFraming(patch) {
  update({framing: {...state.framing, ...patch}});
}

/** In which a frame is chosen and read. */
export function Frame() {
  const {framing, frame} = state,
    isReady = Boolean(frameArguments(framing));
  return [
    h(Choice, {
      key: "form",
      label: "The frame is",
      value: framing.isCloud ? "cloud" : "pictures",
      options: kForms,
      onChange: (form) => setFraming({isCloud: form === "cloud"}),
    }),
    h(Files, {key: "files"}),
    h(Choice, {
      key: "mark",
      label: "Colour of the mark",
      value: framing.mark,
      options: kMarks,
      onChange: (mark) => setFraming({mark}),
    }),
    framing.mark === "none" ? null : h(Check, {
      key: "open",
      label: "The mark is a line with two ends, not a ring",
      isOn: framing.isOpen,
      onChange: (isOpen) => setFraming({isOpen}),
    }),
    h(NumberInput, {
      key: "planes",
      label: "Flat things to take away",
      value: framing.planes,
      step: 1,
      min: 0,
      hint: "The table under the tissue, with what lies below it. 0: the tissue lies on nothing flat.",
      onChange: (planes) => setFraming({planes}),
    }),
    h(
      Button,
      {
        key: "read",
        isMain: true,
        disabled: !isReady || Boolean(state.busy.frame),
        onClick: readFrame,
        "data-do": "frame",
      },
      frame ? "Read the frame again" : "Read the frame",
    ),
    isReady ? null : h("p", {key: "why", class: "soft"}, "Choose the frame's files first."),
    h(Problems, {key: "problems", calls: ["frame"]}),
    frame ? h(Found, {key: "found"}) : null,
  ];
}

// One file after the other: each list of files is long.
function Files() {
  const {framing} = state,
    files = framing.isCloud ? [kCloudFile] : kFiles;
  const missing = files.findIndex(([key]) => !framing[key]);
  return files.map(([key, name, endings, about], k) => {
    const chosen = framing[key];
    if (missing >= 0 && k > missing) return null;
    return h(
      "div",
      {key, "data-frame-file": key},
      h("h4", null, name.charAt(0).toUpperCase() + name.slice(1)),
      h("p", {class: "path"}, chosen ? chosen.name : h("span", {class: "soft"}, about)),
      h(FilePicker, {label: name, endings, chosen, onChoose: (file) => setFraming({[key]: file}), id: key}),
    );
  });
}

function Found() {
  const {frame, framing} = state;
  return h(
    "div",
    {"data-frame": frame.summary.outcome},
    h(AsOf, {
      isNow: frame.asked === JSON.stringify(frameArguments(framing)),
      now: "For the files and settings as they are.",
      past: "Files or settings have changed since.",
    }),
    frame.found
      ? [h("h4", {key: "title"}, "The mark that was found"), h(Picture, {key: "picture", picture: frame.found})]
      : null,
    (frame.warnings || []).map((text, k) => h("p", {key: k, class: "warning"}, text)),
    h(Numbers, {frame}),
    softText(`The tissue in it, ${frame.name}, is the cloud to register.`),
    h(Commands, {lines: frame.commands, files: frame.files}),
  );
}

function Numbers({frame: {summary, points}}) {
  const yesNo = (value) => (value ? "yes" : "no");
  const ofMark = [
    ["outcome", "Outcome", spoken(summary.outcome)],
    ["closed_loop", "Closed ring", yesNo(summary.closed_loop)],
    ["length_mm", "Length of the mark", mm(summary.length_mm)],
    ["width_px", "Width of its line", isNumber(summary.width_px) ? `${fixed(summary.width_px, 1)} px` : "–"],
    ["max_gap_mm", "Longest gap in it", mm(summary.max_gap_mm)],
    ["max_hole_mm", "Longest part without depth", mm(summary.max_hole_mm)],
    ["leaves_picture", "Leaves the picture", yesNo(summary.leaves_picture)],
  ];
  const rows = [
    ...(summary.mark === "none" ? [] : ofMark),
    ["points", "Points of tissue", isNumber(points) ? whole(points) : "–"],
  ];
  return h(FactList, {rows, keyName: "data-found"});
}

function Picture({picture}) {
  const large = useRef(null);
  const size = `${picture.width} × ${picture.height} pixels`;
  return [
    h(Drawn, {
      key: "small",
      picture,
      width: kSmallWidth,
      label: `The colour picture with the mark that was found, ${size}.`,
    }),
    h(Button, {key: "show", onClick: () => large.current.showModal(), "data-do": "enlarge"}, "Enlarge"),
    h(
      "dialog",
      {key: "large", ref: large, class: "large-picture", "aria-label": "The mark that was found"},
      h(Button, {onClick: () => large.current.close(), "data-do": "close"}, "Close"),
      h(
        "div",
        {class: "scrolled", tabIndex: 0, role: "region", "aria-label": "The picture"},
        h(Drawn, {picture, width: picture.width, label: size}),
      ),
    ),
  ];
}

const kSmallWidth = 640; // px

function Drawn({picture, width, label}) {
  const canvas = useRef(null);
  useEffect(() => {
    const height = Math.round((width * picture.height) / picture.width);
    Object.assign(canvas.current, {width, height});
    const pen = canvas.current.getContext("2d");
    pen.imageSmoothingQuality = "high"; // a thin line is still one in the small picture
    pen.drawImage(imageOf(picture), 0, 0, width, height);
    canvas.current.dataset.ready = "yes";
  }, [picture, width]);
  return h("canvas", {ref: canvas, class: "frame-picture", role: "img", "aria-label": label});
}
