// Which things each step shows in the 3D view.

import {
  armHulls,
  ballAbout,
  balls,
  boxLines,
  cloudPoints,
  depthLines,
  heldColours,
  needle,
  placed,
  plate,
  residualColours,
  skinMesh,
  trace,
  tubes,
} from "./things.js";
import {moved, registeredView} from "./registered.js";
import {directionOf, pointsOf} from "./geometry.js";
import {ink, intended, isDark, onBlack} from "./colours.js";
import {cutLayer, kCutColour, kPaintedColour, paintedLayer, partsOf} from "./cut_faces.js";
import {edgeAt} from "./stretched_edge.js";
import {isRing, lookOfPlan} from "./planned_path.js";
import {currentRoom, partsOfRing} from "./room.js";
import {correctedOf, dashesOf, laidOver, lookOf, shownCut, titleOf} from "./kept.js";
import {isFresh, setting} from "./store.js";
import {plain} from "./words.js";

const kTube = 0.28; // mm
const kWideTube = 0.36;
const kThinTube = 0.2;
const kDash = 0.35; // mm in 3D for a pixel of a dash in the pictures

/** The layers of the state: {name, label, colour, isArea, parts, build}; a layer is built anew when one of its `parts`
 *  is another object. @param edge  {points, isClosed} */
export function layersOf(state, edge) {
  return (kMakers[state.step] || seen)(state, edge).filter(Boolean);
}

function skinLayer(skin, name = "tissue", opacity = 1) {
  if (!skin) return null;
  return {
    name,
    label: "tissue",
    colour: ink.tissue,
    isArea: true,
    parts: [skin, opacity],
    build: () => [skinMesh(skin, {colour: ink.tissue, opacity})],
  };
}

// The skin with what the region or the scan's end has cut, and what the brush made.
// @param cut  of each triangle, as partsOf() takes it
function skinLayers(skin, cut, name) {
  if (!skin) return [];
  const parts = partsOf(skin, cut);
  return [skinLayer(parts.own, name), cutLayer(parts.cut), paintedLayer(parts.painted)];
}

// The body, stretched where it is known: both skins have the same triangles in the same order.
function bodyLayers({stretch, body}) {
  return skinLayers((stretch && stretch.skin) || (body && body.skin), body && body.cut);
}

function curveLayer(name, label, colour, points, isClosed, parts, radius = kTube) {
  if (!points || points.length < 2) return null;
  return {name, label, colour, parts, build: () => tubes(points, isClosed, colour, radius)};
}

function ballLayer(name, label, colour, points, radius, parts) {
  if (!points.length) return null;
  return {name, label, colour, isArea: true, parts, build: () => balls(points, colour, radius)};
}

function dashedTubes(points, isClosed, dash, colour, radius) {
  return dashesOf(points, isClosed, dash).flatMap((part) => tubes(part, false, colour, radius));
}

function edgeLayer(edge) {
  return curveLayer("tumour", "tumour's edge", ink.tumour, edge.points, edge.isClosed, [edge.points, edge.isClosed]);
}

function focusLayer(state) {
  return ballLayer("focus", "chosen place", ink.reached, state.focus ? [state.focus] : [], 0.9, [state.focus]);
}

// --- The steps. ---

function seen(state, edge) {
  const box = setting("ct.roi_box_mm"),
    seed = setting("ct.seed_mm");
  const {skin, cut} = state.tissue || state.body || {};
  return [
    ...skinLayers(skin, cut),
    box && {
      name: "box",
      label: "region box",
      colour: onBlack.box,
      parts: [String(box)],
      build: () => boxLines(box, onBlack.box),
    },
    seed && ballLayer("seed", "seed", "#8a7f00", [seed], 1.1, [String(seed)]),
    edge.isRest ? edgeLayer(edge) : null,
    focusLayer(state),
  ];
}

function drawn(state, edge) {
  const {edge: own, tissue, body, stretch} = state;
  const {skin, cut} = own.where === "rest" ? tissue || body || {} : {...stretch, cut: body && body.cut};
  const others = own.points.filter((_, k) => k !== own.selected);
  const chosen = own.points.filter((_, k) => k === own.selected);
  return [
    ...skinLayers(skin, cut),
    edgeLayer(edge),
    ...marginLayers(currentRoom(edge)),
    own.mode === "look" ? null : ballLayer("points", "points", ink.tumour, others, 0.7, [own.points, own.selected]),
    own.mode === "look"
      ? null
      : ballLayer("chosen", "chosen point", ink.kerf, chosen, 0.95, [own.points, own.selected]),
  ];
}

// The ring at rest; what of it leaves the specimen's own skin has the colour of refusals.
function marginLayers(room) {
  if (!room || !room.ring) return [];
  const {free, cut, isClosed} = partsOfRing(room),
    colour = intended();
  return [
    linesLayer("margin", `margin of ${plain(room.margin)} mm, before the stretch`, colour, free, isClosed, room),
    linesLayer("margin-cut", "margin where the tissue is cut off", ink.reached, cut, false, room),
  ];
}

function linesLayer(name, label, colour, lines, isClosed, part) {
  if (!lines.length) return null;
  const build = () => lines.flatMap((points) => tubes(points, isClosed, colour, kThinTube));
  return {name, label, colour, parts: [part, colour], build};
}

function held(state, edge) {
  const {body, stretch, scrub} = state;
  if (!body) return state.tissue ? skinLayers(state.tissue.skin, state.tissue.cut) : [];
  const isRest = !stretch || scrub < 0.005,
    shown = edgeAt(state, edge, stretch ? scrub : 0);
  return [
    ...heldLayers(body, stretch),
    ...plateLayers(body.skin),
    ...(isRest ? patchLayers(state.patch) : []),
    curveLayer("tumour", shown.label, ink.tumour, shown.points, shown.isClosed, [shown.points, shown.label]),
  ];
}

const kMadeShare = 0.5; // of the cut's colour, or the brush's, where such skin is held: both are to be seen

// What is held has its colour on the cut as well, and on what the brush made. All parts are built anew with a
// stretch: they move with the slider.
function heldLayers(body, stretch) {
  const {own, cut, painted} = partsOf(body.skin, body.cut);
  const of = (skin, free, share) => [skinMesh(skin, {colours: heldColours(body.held, free, share)})];
  return [
    {
      name: "body",
      label: "tissue, held parts coloured",
      colour: ink.tissue,
      isArea: true,
      parts: [body, stretch],
      build: () => of(own, ink.tissue, 0),
    },
    cut && {...cutLayer(cut), parts: [body, stretch], build: () => of(cut, kCutColour, kMadeShare)},
    painted && {
      ...paintedLayer(painted),
      parts: [body, stretch],
      build: () => of(painted, kPaintedColour, kMadeShare),
    },
  ];
}

function plateLayers(skin) {
  const list = setting("specimen.constraints") || [];
  return list.map((one, k) => {
    if (!one.plane || !Array.isArray(one.plane.point_mm)) return null;
    const normal = directionOf(one.plane.normal, [0, 0, 1]),
      about = ballAbout(skin.vertices);
    return {
      name: `plate${k}`,
      label: "support, 10 mm grid",
      colour: "#9fb2c2",
      isArea: true,
      parts: [JSON.stringify(one), skin],
      build: () => plate(one.plane.point_mm, normal, about.centre, about.radius),
    };
  });
}

// The lines of painted patches, and the stroke that is being painted.
function patchLayers({k: of, isEmpty, stroke}) {
  const list = setting("specimen.constraints") || [],
    colour = intended();
  const lines = list.map(({where}, k) => (where && where.patch && !(isEmpty && k === of) ? where.patch.path_mm : []));
  return [...lines, stroke].map((points, k) =>
    ballsAndLine(`patch${k}`, k < list.length ? `painted line of ${k + 1}` : "stroke", colour, points),
  );
}

function ballsAndLine(name, label, colour, points) {
  return points.length < 2
    ? ballLayer(name, label, colour, points, 0.6, [points, colour])
    : curveLayer(name, label, colour, points, false, [points, colour], kWideTube);
}

function planned(state, edge) {
  const {plan, stretch} = state,
    shown = plan || !edge ? {points: []} : edgeAt(state, edge, stretch ? 1 : 0);
  return [
    ...bodyLayers(state),
    ...pathLayers(plan),
    curveLayer("tumour", shown.label, ink.tumour, shown.points, shown.isClosed, [shown.points, shown.label]),
    plan && isFresh("plan") ? markerLayer(plan.verdict, plan) : null,
    focusLayer(state),
  ];
}

function pathLayers(plan) {
  if (!plan || !plan.path) return [];
  const {path} = plan,
    points = pointsOf(path),
    {isNow, label, colour, dash} = lookOfPlan();
  if (!isNow) return pastLayers(plan, label, colour, dash);
  const hasTips = Array.isArray(path.axes) && path.axes.length && path.depth_mm;
  return [
    curveLayer("path", label, colour, points, path.closed, [plan, colour]),
    hasTips
      ? {
          name: "depth",
          label: "planned depth",
          colour,
          parts: [plan, colour],
          build: () => depthLines(points, path.axes, path.depth_mm, colour),
        }
      : null,
    ballLayer("start", "start", "#56b4e9", points.slice(0, 1), 0.7, [plan]),
    curveLayer("tumour", "tumour's edge", ink.tumour, pointsOf(plan.edge), true, [plan]),
  ];
}

// Dashed, and without depth and start: a plan of settings that have changed.
function pastLayers(plan, label, colour, dash) {
  const pattern = dash.map((length) => kDash * length),
    {path, edge} = plan;
  return [
    {
      name: "path",
      label,
      colour,
      parts: [plan, colour],
      build: () => dashedTubes(pointsOf(path), path.closed, pattern, colour, kTube),
    },
    curveLayer("tumour", "tumour's edge of earlier settings", ink.tumour, pointsOf(edge), true, [plan, "past"]),
  ];
}

/** The places of a verdict's reasons. */
function markerLayer(verdict, part) {
  const places = ((verdict && verdict.reasons) || [])
    .map((reason) => reason.at && reason.at.position_mm)
    .filter(Boolean);
  return ballLayer("reasons", "reasons of the verdict", ink.reached, places, 0.8, [part]);
}

function running(state) {
  const {moment, plan} = state;
  if (!moment) return planned(state);
  return [skinLayer(moment.skin, "cut-skin"), toolLayer(moment), ...pathLayers(plan)];
}

function toolLayer(moment) {
  const axis = directionOf(setting("plan.approach"), [0, 0, -1]),
    diameter = setting("tool.diameter_mm") || 1;
  return {
    name: "tool",
    label: "needle",
    colour: ink.tool,
    isArea: true,
    parts: [moment],
    build: () => needle(moment.tip, axis, diameter, 25),
  };
}

function compared(state) {
  const {run, plan} = state;
  if (!run) return planned(state);
  const isClosed = isRing(plan);
  const line = (name, label, colour, cut) =>
    curveLayer(name, label, colour, cut && pointsOf(cut.centerline), isClosed, [run, isClosed], kWideTube);
  return [
    ...bodyLayers(state),
    ...pathLayers(plan).filter((layer) => layer && layer.name !== "depth"),
    line("before", "mid-line as planned", ink.kerf, run.as_planned),
    line("after", "mid-line corrected", ink.corrected, correctedOf(run)),
    ...keptLayers(state, isClosed),
    markerLayer(run.verdict, run),
    focusLayer(state),
  ];
}

// The mid-lines of kept results, with their dashes: a tube's colour alone is hard to tell.
function keptLayers(state, isClosed) {
  return laidOver().map((one) => {
    const {colour, dash} = lookOf(one),
      points = pointsOf((shownCut(one) || {}).centerline);
    if (points.length < 2) return null;
    const pattern = dash.map((length) => kDash * length);
    return {
      name: `kept${one.letter}`,
      label: titleOf(one),
      colour,
      parts: [one, state.keptCut, colour, isClosed],
      build: () => dashedTubes(points, isClosed, pattern, colour, kWideTube),
    };
  });
}

// The cloud over the simulated surface, whose points have the colours of their distances from it.
function registered(state) {
  const {stretch, register, cloud} = state,
    view = registeredView(register);
  if (!view) return [skinLayer(stretch && stretch.skin)];
  const colour = isDark() ? "#c9ced3" : "#4a5056";
  return [
    skinLayer(stretch && stretch.skin, "tissue", 0.3),
    {
      name: "cloud",
      label: register.is_virtual ? "virtual cloud, made up" : `cloud ${cloud.file ? cloud.file.name : ""}`,
      colour,
      isArea: true,
      parts: [view, colour],
      build: () => [cloudPoints(view.cloud, {colour, size: 3})],
    },
    {
      name: "residuals",
      label: "simulated surface, by distance",
      colour: "#74b3d8",
      isArea: true,
      parts: [view],
      build: () => [cloudPoints(view.sample, {colours: residualColours(view.residuals_mm, view.top_mm), size: 6})],
    },
    view.edge && curveLayer("edge", "tumour's edge of the case", ink.tumour, view.edge, true, [view], kWideTube),
    view.marked && markedLayer(state, view),
  ];
}

// Dashed, so that it is not the case's own edge to anybody.
function markedLayer({frame}, view) {
  const colour = isDark() ? "#f08cc4" : "#a3267a",
    isClosed = !frame || frame.summary.closed_loop;
  return {
    name: "marked",
    label: "edge marked on the tissue",
    colour,
    parts: [view, colour, isClosed],
    build: () => dashedTubes(view.marked, isClosed, [1.6, 0.8], colour, kWideTube),
  };
}

// In the robot's frame. Without an arm: as in the step before.
function played(state) {
  const {arm, plan, stretch, run} = state;
  if (!arm) return compared(state);
  const pose = arm.T_robot_sim,
    isClosed = isRing(plan);
  const line = (name, label, colour, curve) =>
    curveLayer(
      name,
      label,
      colour,
      pointsOf(curve).map((point) => moved(point, pose)),
      isClosed,
      [arm, plan, run, colour],
    );
  const skin = stretch && stretch.skin;
  return [
    skin && {
      ...skinLayer(skin),
      label: "stretched tissue",
      parts: [skin, arm],
      build: () => placed([skinMesh(skin, {colour: ink.tissue, opacity: 1})], pose),
    },
    ...armLayers(arm),
    ...(state.armOf === "run"
      ? [
          line("path", lookOfPlan().label, lookOfPlan().colour, plan && plan.path),
          line("after", "corrected path", ink.corrected, run && run.corrected && run.corrected.path),
        ]
      : [laidLayer(state)]),
    line("tumour", "tumour's edge", ink.tumour, plan && plan.edge),
    {
      name: "table",
      label: `table, ${kTableGrid} mm grid`,
      colour: "#9fb2c2",
      isArea: true,
      parts: [arm],
      build: () => plate([0, 0, arm.table_z_mm], [0, 0, 1], middleOfTable(arm), kTableRadius, kTableGrid),
    },
  ];
}

// What the program follows that was laid on the tissue; in the robot's frame already.
function laidLayer({armOf, lay, mark}) {
  const [laid, label] = armOf === "mark" ? [mark, "edge to be marked"] : [lay, "path on the tissue"];
  return laid && curveLayer("laid", label, intended(), pointsOf(laid.path), laid.path.closed, [laid, intended()]);
}

const kTableRadius = 200; // mm
const kTableGrid = 50;

// Below the course of the tip: the tissue lies there.
function middleOfTable(arm) {
  return ballAbout(arm.tip).centre;
}

function armLayers(arm) {
  const colour = isDark() ? "#9aa4ad" : "#c3c9cf";
  return [
    {
      name: "arm",
      label: "arm",
      colour,
      isArea: true,
      parts: [arm, colour],
      build: () => armHulls(arm.hulls, (name) => (name === "needle" ? ink.tool : colour)),
    },
    {
      name: "trace",
      label: "course of the tip so far",
      colour: ink.reached,
      parts: [arm],
      build: () => [trace(arm.tip, ink.reached)],
    },
  ];
}

const kMakers = {
  see: seen,
  edge: drawn,
  hold: held,
  plan: planned,
  run: running,
  compare: compared,
  register: registered,
  program: played,
};
