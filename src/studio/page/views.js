// The four views, and what of the state they show.

import {state, update, setting, isFresh, isSame, when} from "./store.js";
import {change} from "./actions.js";
import {addStroke, brush, noteTissue, strokes} from "./brush.js";
import {dropBox, regionBox, showBox} from "./region_box.js";
import {GreyTable} from "./slice_image.js";
import {SliceView} from "./slices.js";
import {Scene, SkinQuery} from "./scene.js";
import {EdgeTool, ellipseOnSkin, withCurve} from "./edge_tool.js";
import {PatchTool} from "./patch_tool.js";
import {growPatch, isAtRest, paintPatch, paintedPatch} from "./patch.js";
import {directionOf, kPlanes, middleOf, pointsOf} from "./geometry.js";
import {isDark} from "./colours.js";
import {layersOf} from "./layers.js";
import {watchRoom} from "./room.js";
import {ballAbout, blend, poseArm, showTrace} from "./things.js";
import {moved} from "./registered.js";
import {endsAt, onPlayer, player, rewind, sampleAt} from "./arm_player.js";

/** The views by name: axial, coronal, sagittal, scene; `edge` and `patch`: the tools that draw on the skin. */
export const views = {};

const model = {table: new GreyTable(), isPlacing: false, isBoxShown: true, brush: null, strokes: [], stroke: []};

/** Makes a view in an element; once for each. */
export function makeView(host, name) {
  if (views[name]) return;
  if (name === "scene") makeScene(host);
  else views[name] = new SliceView(host, name, model, kOn);
  renderSlices();
}

const kOn = {
  cross: (cross) => update({cross}),
  window: (width, level) => update({window: {width, level}}),
  face: showBox,
  box: dropBox,
  seed: (point) => {
    change({"ct.seed_mm": point.map((value) => Math.round(10 * value) / 10)});
    update({placing: null});
  },
  painting: renderSlices,
  stroke: (path, normal) => brush() && addStroke(brush(), path, normal),
  putAway: () => update({placing: null}),
};

function makeScene(host) {
  try {
    views.scene = new Scene(host, () => update({layers: state.layers + 1}));
  } catch (error) {
    host.dataset.ready = "failed";
    update({noScene: "The 3D view needs WebGL, which this browser does not offer."});
    return;
  }
  views.edge = new EdgeTool(views.scene, {
    get: () => state.edge,
    set: (edge) => update({edge, notice: ""}),
    query: skinQuery,
    onEllipse: (point) => dropEllipse(point),
  });
  views.patch = new PatchTool(views.scene, {
    get: () => (isAtRest() ? paintedPatch() : null),
    query: skinQuery,
    on: {
      painting: (stroke) => update({patch: {...state.patch, stroke}}),
      stroke: (path) => paintedPatch() && paintPatch(state.patch.k, paintedPatch(), path),
      grow: growPatch,
      end: () => update({placing: null}),
    },
  });
  syncScene();
}

// --- Slices. ---

let scanCount = 0;
function keyed(value) {
  if (!value.key) Object.defineProperty(value, "key", {value: `n${++scanCount}`});
  return value;
}

let foundCount = 0; // of the strokes: so many are in the tissue that is shown

// What the slices show: they are drawn again where one of these is another.
function shownInSlices() {
  const edge = shownEdge();
  if (isFresh("tissue") && !("ct.edits" in state.drafts)) foundCount = strokes().length;
  return {
    room: state.case && state.case.file,
    scan: state.scan && keyed(state.scan),
    tissue: state.tissue && keyed(state.tissue),
    cross: state.cross,
    window: state.window,
    overlay: state.overlay,
    box: regionBox(),
    seed: setting("ct.seed_mm"),
    isPlacing: state.placing === "seed",
    isBoxShown: state.step === "see",
    brush: brush(),
    strokes: strokes().slice(foundCount),
    edge: edge.isRest ? edge.points : [],
  };
}

function renderSlices() {
  for (const name of kPlanes) if (views[name]) views[name].render();
}

/** The tumour's edge as it is known now: the one being drawn, else the case's. `isRest`: on the tissue as scanned. */
export function shownEdge() {
  const {edge} = state;
  if (edge.points.length) return {points: edge.curve, isClosed: edge.isClosed, isRest: edge.where === "rest"};
  const stored = state.case && state.case.edge;
  if (stored) return {points: pointsOf(stored), isClosed: true, isRest: stored.configuration === "rest"};
  return {points: [], isClosed: false, isRest: true};
}

// --- The 3D view. ---

let built = new Map();

function syncScene() {
  if (!views.scene) return;
  const wanted = layersOf(state, shownEdge());
  for (const name of built.keys()) if (!wanted.some((layer) => layer.name === name)) forget(name);
  for (const layer of wanted) build(layer);
  fitScene();
  scrub();
  placeArm();
  views.scene.gizmo.name(isArmShown() ? "robot" : "anatomical");
  chooseTool();
}

function chooseTool() {
  const isPainting = state.step === "hold" && Boolean(paintedPatch());
  views.scene.tool = state.step === "edge" ? views.edge : isPainting ? views.patch : null;
  views.scene.host.dataset.tool = isPainting ? "patch" : "";
  if (!isPainting) views.patch.hide();
}

function forget(name) {
  built.delete(name);
  views.scene.drop(name);
}

function build(layer) {
  const last = built.get(layer.name);
  if (isSame(last, layer.parts)) return;
  built.set(layer.name, layer.parts);
  views.scene.put(layer.name, layer.build(), layer);
}

let fitted = {of: null, room: "", centre: null, radius: 0};

/** Fits the view to what the step shows, where it is something else; small changes of size leave the camera alone. */
function fitScene() {
  const isArm = isArmShown(),
    of = isArm ? state.arm : shownSkin();
  if (!of || of === fitted.of) return;
  const room = `${state.case ? state.case.file : ""} ${isArm ? "robot" : "sim"}`;
  const ball = isArm ? armBall() : ballAbout(of.vertices),
    isOther = room !== fitted.room;
  fitted.of = of;
  const shift = isOther ? Infinity : Math.hypot(...ball.centre.map((value, k) => value - fitted.centre[k]));
  if (shift < 0.06 * ball.radius && Math.abs(ball.radius - fitted.radius) < 0.06 * ball.radius) return;
  fitted = {of, room, ...ball};
  const isMuch = isOtherTissue(of, ball);
  if (isOther) views.scene.forget();
  if (isMuch && !isOther) views.scene.frameWhole(ball.centre, ball.radius);
  else views.scene.fit(ball.centre, ball.radius);
}

const kMuch = 0.2; // of the radius
let found = {centre: null, radius: 0}; // the ball about the tissue that was found last

// Whether this is the tissue that was found, with another extent than the one before it. With its camera as it was,
// one might look past it.
function isOtherTissue(skin, ball) {
  if (!state.tissue || skin !== state.tissue.skin) return false;
  const {centre, radius} = found;
  found = ball;
  if (!centre) return false;
  const shift = Math.hypot(...ball.centre.map((value, k) => value - centre[k]));
  return Math.max(shift, Math.abs(ball.radius - radius)) > kMuch * radius;
}

// --- The arm, in the robot's frame. ---

function isArmShown() {
  return state.step === "program" && Boolean(state.arm);
}

function armBall() {
  const {centre, radius} = ballAbout(state.arm.ends);
  return {centre, radius: 0.95 * radius}; // of the box about all that it does: its corners are empty
}

/** Makes the whole arm, or the tissue that it cuts, fill the 3D view. @param what  "arm" or "tissue" */
export function frameOn(what) {
  const {arm, stretch} = state;
  if (!isArmShown() || !views.scene) return;
  const ball = what === "arm" || !stretch ? armBall() : ballAbout(stretch.skin.vertices);
  const centre = what === "arm" || !stretch ? ball.centre : moved(ball.centre, arm.T_robot_sim);
  views.scene.frame(centre, ball.radius);
}

/** Puts the arm where it is at the player's time. */
function placeArm() {
  const {arm} = state,
    layer = views.scene && views.scene.layers.get("arm");
  if (!isArmShown() || !layer) return;
  poseArm(layer.objects, endsAt(arm, player.time));
  const way = views.scene.layers.get("trace");
  if (way) showTrace(way.objects[0], sampleAt(arm, player.time).k + 1);
  views.scene.render();
}

/** The skin that the step shows: {vertices, triangles}, or null. */
export function shownSkin() {
  const {step, tissue, body, stretch} = state;
  if (step === "edge" && state.edge.where === "stretched") return stretch && stretch.skin;
  if (step === "see" || step === "edge" || step === "open")
    return (tissue && tissue.skin) || (body && body.skin) || null;
  if (step === "hold") return (body && body.skin) || (tissue && tissue.skin) || null;
  return (stretch && stretch.skin) || (body && body.skin) || (tissue && tissue.skin) || null;
}

function scrub() {
  const {body, stretch} = state;
  if (state.step !== "hold" || !body || !stretch) return;
  const rest = stretch.rest || body.skin.vertices;
  if (rest.length !== body.skin.vertices.length || stretch.skin.vertices.length !== rest.length) return;
  for (const name of ["body", "cut-faces", "painted-skin"]) scrubLayer(views.scene.layers.get(name), rest, stretch);
}

function scrubLayer(layer, rest, stretch) {
  if (!layer || (layer.share === state.scrub && layer.of === stretch)) return;
  blend(layer.objects[0], rest, stretch.skin.vertices, state.scrub);
  Object.assign(layer, {share: state.scrub, of: stretch});
  views.scene.render();
}

let asked = {skin: null, query: null};

/** The skin that is drawn on, ready to be asked; null where there is none. */
export function skinQuery() {
  const skin = shownSkin();
  if (skin !== asked.skin) asked = {skin, query: skin ? new SkinQuery(skin) : null};
  return asked.query;
}

/** The direction into the tissue, as the case has it; from above where it has none. */
export function approach() {
  return directionOf(setting("plan.approach"), [0, 0, -1]);
}

/** Lays an ellipse about a point, with the diameters and the turn of the panel. */
export function dropEllipse(point) {
  const query = skinQuery(),
    {edge} = state;
  const points = query && ellipseOnSkin(query, point, approach(), edge.diameters || [18, 14], edge.turn || 0);
  if (!points) return update({notice: "The ellipse leaves the skin here. Choose another place, or a smaller one."});
  const next = {...edge, points, isClosed: true, selected: -1, isSaved: false, mode: "draw"};
  return update({edge: withCurve(next, query), notice: ""});
}

/** The crosshair's place, mm: the middle of the slices where none was chosen; null without slices. */
export function crosshair() {
  const shown = state.scan || state.tissue;
  return state.cross || (shown && shown.grid ? middleOf(shown.grid) : null);
}

/** Moves crosshair and 3D view to a place, mm. */
export function showPlace(point) {
  update({cross: point, focus: point});
  if (views.scene) views.scene.goTo(point);
}

/** Shows the region box, or the found tissue, as large as it fits in the slices. */
export function fitBox(box) {
  for (const name of kPlanes) if (views[name]) views[name].fitBox(box);
}

/** Connects the views with the state. */
export function connectViews() {
  // What is dragged or painted belongs to the case and to the view that it was begun in.
  when(
    () => [state.case && state.case.file, state.step, state.large],
    () => Object.values(views).forEach((view) => view.breakOff && view.breakOff()),
  );
  when(shownInSlices, (shown) => {
    Object.assign(model, shown);
    renderSlices();
  });
  watchRoom(shownEdge);
  onPlayer(placeArm);
  when(() => [state.arm], rewind);
  when(() => [state.tissue], noteTissue);
  when(
    () => [
      state.step,
      state.tissue,
      state.body,
      state.stretch,
      state.plan,
      state.room,
      state.run,
      isDark(),
      state.kept,
      state.keptCut,
      state.register,
      state.arm,
      state.moment,
      state.edge,
      state.case,
      state.preview,
      state.drafts,
      state.focus,
      state.scrub,
      state.placing,
      state.patch,
    ],
    syncScene,
  );
}
