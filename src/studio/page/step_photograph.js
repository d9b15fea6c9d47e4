// Step 8: the photograph of the cut, its scale, the contours found on it, and what they say of the cut.

import {h} from "preact";
import {useEffect, useRef} from "preact/hooks";
import {state} from "./store.js";
import {measure, openPicture} from "./actions.js";
import {
  AsOf,
  Button,
  Choice,
  DataTable,
  NumberInput,
  Numbers,
  Problems,
  Reasons,
  Section,
  Status,
  rowOf,
  softText,
} from "./widgets.js";
import {FilePicker} from "./file_list.js";
import {Commands} from "./commands.js";
import {
  HandLines,
  addHandle,
  chooseHandle,
  closeLine,
  handlesOf,
  moveHandle,
  removeHandle,
  setPhoto,
} from "./photo_lines.js";
import {PhotoView} from "./photo_view.js";
import {Plot} from "./plots.js";
import {Swatch} from "./contour_view.js";
import {afterColour} from "./step_compare.js";
import {
  argumentsOf,
  curveOf,
  isHandComplete,
  kScales,
  pointAt,
  scaleArgument,
  scalePointCount,
} from "./photo_settings.js";
import {views} from "./views.js";
import {ink, onPhoto} from "./colours.js";
import {fixed, isNumber, mm, spoken} from "./words.js";

const kEndings = [".png", ".jpg", ".jpeg", ".tif", ".tiff"];
const kReds = [
  ["annotation", "a thin line along the cut's inner edge"],
  ["kerf", "the painted kerf itself"],
];

/** The panel. */
export function StepPhotograph() {
  const {photo, picture, photograph} = state;
  return h(
    "div",
    {"data-photograph": photograph ? photograph.evaluation.outcome : picture ? "loaded" : "none"},
    h(
      Section,
      {title: "Photograph", id: "photo-file", doing: [["picture", "Reading the photograph"]]},
      softText("A top view of the cut: the tumour's edge in green, the incision in red."),
      photo.file ? h("p", {class: "path"}, photo.file.name) : null,
      h(FilePicker, {label: "photograph", endings: kEndings, chosen: photo.file, onChoose: openPicture, id: "photo"}),
      h(Problems, {calls: ["picture"]}),
    ),
    picture ? [h(Scale, {key: "scale"}), h(Find, {key: "find"})] : null,
    photograph ? [h(Result, {key: "result"}), h(Files, {key: "files"})] : null,
    picture ? h(HandLines) : null,
  );
}

// --- The scale. ---

function setScale(patch) {
  setPhoto({scale: {...state.photo.scale, ...patch}});
}

function Scale() {
  const {scale} = state.photo;
  const [, , , hint] = kScales.find(([how]) => how === scale.how);
  return h(
    Section,
    {title: "Scale", id: "scale"},
    h(Choice, {
      label: "Found from",
      value: scale.how,
      options: kScales.map(([how, label]) => [how, label]),
      onChange: (how) => setPhoto({scale: {...scale, how, points: []}, mode: "look", selected: -1}),
    }),
    softText(hint),
    h(ScaleNumbers, {scale}),
  );
}

function ScaleNumbers({scale}) {
  const number = (label, key, isOptional, hint) =>
    h(NumberInput, {
      label,
      unit: "mm",
      value: scale[key],
      min: 0,
      isOptional,
      hint,
      onChange: (value) => setScale({[key]: value}),
    });
  if (scale.how === "mm_per_pixel") return number("One pixel", "mm_per_pixel");
  if (scale.how === "ticks")
    return number("From one finest tick to the next", "ruler_mm", true, "Without a value: 1 mm.");
  if (scale.how === "bar") return number("Length of the bar", "ruler_mm", true);
  if (scale.how === "two_points") return [h(ScalePoints), number("Distance of the two points", "distance_mm")];
  const {size_mm} = scale;
  return [
    h(ScalePoints),
    h(Numbers, {
      label: "Size",
      unit: "mm",
      names: ["width", "height"],
      value: size_mm,
      onChange: (next) => setScale({size_mm: next}),
    }),
  ];
}

const kCorners = ["Lower left", "Lower right", "Upper right", "Upper left"];

function ScalePoints() {
  const {photo} = state,
    count = scalePointCount(photo),
    isOn = photo.mode === "scale";
  const {points} = photo.scale;
  const nameOf = (k) => (count === 4 ? kCorners[k] : `Point ${k + 1}`);
  const put = (k, point) => setScale({points: points.with(k, point)});
  return h(
    "div",
    {"data-scale-points": points.length},
    rowOf(
      h(
        Button,
        {
          isPressed: isOn,
          onClick: () => setPhoto({mode: isOn ? "look" : "scale", selected: -1}),
          "data-do": "scale-points",
        },
        "Click the points",
      ),
      h(
        Button,
        {disabled: points.length >= count, onClick: () => setScale({points: [...points, middle()]})},
        "Add one",
      ),
      h(Button, {disabled: !points.length, onClick: () => setPhoto({scale: {...photo.scale, points: []}})}, "Clear"),
    ),
    points.map((point, k) =>
      h(Numbers, {
        key: k,
        label: `${k + 1}. ${nameOf(k)}`,
        unit: "px",
        names: ["u", "v"],
        value: point,
        step: 1,
        onChange: (next) => put(k, next),
      }),
    ),
  );
}

function middle() {
  return [Math.round(state.picture.width / 2), Math.round(state.picture.height / 2)];
}

// --- Finding and measuring. ---

function Find() {
  const {photo, photograph, busy} = state;
  const isReady = scaleArgument(photo) !== null && isHandComplete(photo);
  return h(
    Section,
    {title: "Contours", id: "find", doing: [["photograph", "Looking for the contours"]]},
    h(Choice, {label: "The red line is", value: photo.red, options: kReds, onChange: (red) => setPhoto({red})}),
    h(
      "details",
      null,
      h("summary", null, "More settings"),
      h(NumberInput, {
        label: "Greatest gap of a closed line",
        unit: "mm",
        value: photo.max_gap_mm,
        min: 0,
        isOptional: true,
        hint: "Without a value: as incise evaluate has it.",
        onChange: (max_gap_mm) => setPhoto({max_gap_mm}),
      }),
    ),
    h(
      Button,
      {isMain: true, disabled: !isReady || Boolean(busy.photograph), onClick: measure, "data-do": "measure"},
      photograph ? "Measure again" : "Find the contours and measure",
    ),
    h(
      "p",
      {class: "soft lines-2"},
      isReady ? "" : "The scale, or a line drawn by hand, is not complete. The tumour's edge has to be closed.",
    ),
    h(Problems, {calls: ["photograph"]}),
  );
}

// --- What was found. ---

function Result() {
  const {photograph} = state,
    {evaluation, by_hand: byHand} = photograph;
  return h(
    Section,
    {title: "Result", id: "photo-result"},
    h(AsOf, {
      isNow: photograph.asked === JSON.stringify(argumentsOf(state.photo)),
      now: "For the scale and lines as they are.",
      past: "Scale or lines have changed since.",
    }),
    byHand.length ? h("p", {class: "warning", "data-by-hand": byHand.join(" ")}, byHandText(byHand)) : null,
    h(Verdict, {evaluation, isDrawn: isAllDrawn(byHand)}),
    softText(`${scaleText(photograph)} 12 o'clock is marked on the incision.`),
    h(Measures, {evaluation}),
    h(ByClock, {evaluation}),
  );
}

const kLines = {incision: "the incision", tumor_edge: "the tumour's edge"};

function isAllDrawn(byHand) {
  return byHand.length === Object.keys(kLines).length;
}

function byHandText(byHand) {
  if (isAllDrawn(byHand))
    return "Both lines were drawn by hand. Nothing was found automatically: these are the measures of the drawing.";
  const [drawn] = byHand,
    [found] = Object.keys(kLines).filter((line) => line !== drawn);
  return `Drawn by hand: ${kLines[drawn]}. Found automatically: ${kLines[found]}.`;
}

// Of lines that were both drawn by hand, the verdict is about the scale.
function Verdict({evaluation: {outcome, verdict}, isDrawn}) {
  const ended = `Outcome: ${spoken(outcome).toLowerCase()}.`;
  if (!verdict) return h("p", {class: "verdict"}, ended);
  const isGood = !verdict.reasons.length,
    about = isDrawn ? "the scale" : "this measurement";
  return [
    h(
      "p",
      {class: "verdict", key: "status"},
      h(Status, {status: verdict.status}),
      ` ${ended} ${isGood ? `No reason against ${about} is known.` : "Reasons, worst first:"}`,
    ),
    h(Reasons, {verdict, key: "reasons"}),
  ];
}

function scaleText({mm_per_pixel: size, scale}) {
  return `One pixel is ${fixed(size, 4)} mm (from: ${spoken(scale.source).toLowerCase()}).`;
}

const yesNo = (value) => (typeof value === "boolean" ? (value ? "yes" : "no") : "–");
const plainNumber = (value, digits) => (isNumber(value) ? fixed(value, digits) : "–");

// Name, what the photograph shows, and what the simulated, corrected cut shows; "–" where a cut has no such number.
function rowsOf(found, cut) {
  const numbers = (cut && cut.numbers) || {},
    errors = found.abs_error_mm || {},
    signed = found.signed_error_mm || {};
  return [
    ["outcome", "Outcome", spoken(found.outcome), cut ? spoken(cut.outcome) : "–"],
    ["negative_margin", "Negative margin", yesNo(found.negative_margin), "–"],
    ["closed_loop", "Closed loop", yesNo(found.closed_loop), "–"],
    ["mean_error_mm", "Mean error", mm(errors.mean), mm(numbers.mean_error_mm)],
    ["greatest_error_mm", "Greatest error", mm(errors.max), mm(numbers.greatest_error_mm)],
    ["signed_mean_mm", "Mean signed error", mm(signed.mean), "–"],
    ["hausdorff_mm", "Hausdorff distance", mm(found.hausdorff_mm && found.hausdorff_mm.symmetric), "–"],
    ["hu_score", "Hu score", plainNumber(found.hu_score, 3), "–"],
    ["hu_excess", "Hu excess", plainNumber(found.hu_excess, 3), "–"],
    ["centroid_shift_mm", "Centroid shift", mm(found.centroid_shift_mm), "–"],
  ];
}

function Measures({evaluation}) {
  const cut = state.run && (state.run.corrected || state.run.as_planned);
  const which = state.run && !state.run.corrected ? "Simulated as planned" : "Simulated, corrected";
  return [
    h(DataTable, {
      key: "table",
      head: ["Measured", "Photograph", ...(cut ? [which] : [])],
      rows: rowsOf(evaluation, cut),
      keyName: "data-measure",
    }),
    h(
      "p",
      {class: "about", key: "about"},
      `The photograph's errors are those of the ${spoken(evaluation.contour).toLowerCase()} against ` +
        `${mm(evaluation.target_mm)} from the tumour's edge.`,
      cut ? " The simulated ones are those of the mid-line against its own target." : null,
    ),
  ];
}

function ByClock({evaluation}) {
  const list = evaluation.by_clock || [];
  if (!list.length) return null;
  return h(
    "details",
    null,
    h("summary", null, "Signed error by the clock"),
    h(DataTable, {
      head: ["O'clock", "Mean", "Least", "Greatest"],
      rows: list.map((one) => [one.hour, one.hour, mm(one.mean_mm), mm(one.min_mm), mm(one.max_mm)]),
      keyName: "data-hour",
    }),
  );
}

function Files() {
  const {files, command} = state.photograph;
  return h(Section, {title: "Repeat", id: "photo-files"}, h(Commands, {lines: [command], files}));
}

// --- The large part of the page. ---

const kOn = {add: addHandle, select: chooseHandle, move: moveHandle, remove: removeHandle, close: closeLine};

/** The photograph, and the error along the contour. */
export function PhotographPictures() {
  const host = useRef(null);
  useEffect(() => {
    views.photo = new PhotoView(host.current, kOn);
    return () => {
      views.photo.close();
      delete views.photo;
    };
  }, []);
  useEffect(() => views.photo.show(modelOf(state)));
  const curves = errorsOf(state);
  return [
    h(
      "section",
      {key: "photo", class: "view photo", "aria-label": "Photograph", "data-view": "photo"},
      h("div", {class: "view-head"}, h("span", {class: "view-name"}, "Photograph")),
      h("div", {class: "view-host", ref: host}),
      state.picture ? h(Key) : h("p", {class: "no-picture"}, state.busy.picture ? "" : "No photograph is chosen."),
    ),
    curves.length
      ? h(Plot, {
          key: "plot",
          id: "photo-errors",
          title: "Error of the cut; above 0: farther from the tumour",
          unit: "error, mm",
          curves,
        })
      : null,
  ];
}

function Key() {
  const lines = linesOf(state);
  if (!lines.length) return null;
  return h(
    "ul",
    {class: "key on-photo"},
    lines.map((curve) => h("li", {key: curve.label}, h(Swatch, {curve}), curve.label)),
  );
}

function modelOf({picture, photo, photograph}) {
  return {
    picture,
    lines: linesOf({photo, photograph}),
    handles: handlesOf(photo),
    selected: photo.selected,
    marks: (photograph && photo.mode !== "scale" && photograph.marks_px) || [],
    clock: photograph && photo.mode === "look" ? clockOf(photograph) : [],
    mm_per_pixel: photograph ? photograph.mm_per_pixel : null,
    isDrawing: photo.mode !== "look",
  };
}

// What is drawn by hand stands in place of what was found.
function linesOf({photo, photograph}) {
  const line = (name, label, colour, points, isClosed) => {
    const own = photo.hand[name];
    if (own)
      return {label: `${label}, drawn by hand`, colour, dash: [7, 4], points: curveOf(own), isClosed: own.isClosed};
    return points && points.length > 1 ? {label, colour, points, isClosed} : null;
  };
  const {incision_px: incision, incision_closed: isClosed, tumor_edge_px: edge} = photograph || {};
  return [
    line("tumor_edge", "tumour's edge", onPhoto.tumour, edge, true),
    line("incision", "incision", onPhoto.incision, incision, isClosed),
  ].filter(Boolean);
}

// The hours 12, 3, 6 and 9 at the incision's points that the evaluation gives them.
function clockOf({incision_px: line, incision_closed: isClosed, evaluation}) {
  const hours = evaluation.points && evaluation.points.clock_h;
  if (!hours || !line || line.length < 3) return [];
  const from = [0, 1].map((k) => line.reduce((sum, point) => sum + point[k], 0) / line.length);
  return [12, 3, 6, 9].map((hour) => {
    const off = hours.map((value) => Math.min(Math.abs(value - (hour % 12)), 12 - Math.abs(value - (hour % 12))));
    const k = off.indexOf(Math.min(...off));
    return {at: pointAt(line, isClosed, k / (isClosed ? hours.length : hours.length - 1)), from, text: String(hour)};
  });
}

let memo = {};

/** The plot's curves; the same objects for as long as the results are the same. */
function errorsOf({photograph, run}) {
  if (memo.photograph !== photograph || memo.run !== run || memo.colour !== afterColour())
    memo = {photograph, run, colour: afterColour(), curves: makeErrors(photograph, run)};
  return memo.curves;
}

function makeErrors(photograph, run) {
  const points = photograph && photograph.evaluation.points,
    cut = run && run.corrected;
  if (!points) return [];
  const simulated = cut && cut.errors;
  return [
    {label: "photograph", colour: ink.kerf, x: points.arclength_mm, y: points.signed_error_mm},
    simulated && {
      label: "simulated, corrected",
      colour: afterColour(),
      dash: [5, 3],
      x: simulated.arclength_mm,
      y: simulated.signed_mm,
    },
  ].filter(Boolean);
}
