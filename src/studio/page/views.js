// The four views, and what of the state they show.

import {state, update, setting, when, subscribe} from "./store.js";
import {change} from "./actions.js";
import {GreyTable} from "./slice_image.js";
import {SliceView} from "./slices.js";
import {Scene, SkinQuery} from "./scene.js";
import {EdgeTool, ellipseOnSkin, withCurve} from "./edge_tool.js";
import {directionOf, kPlanes, pointsOf} from "./geometry.js";
import {layersOf} from "./layers.js";
import {ballAbout, blend} from "./things.js";

/** The views by name: axial, coronal, sagittal, scene; `edge`: the tool that draws on the skin. */
export const views = {};

const model = {table: new GreyTable(), isPlacing: false, isBoxShown: true};

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
  box: (box) => change({"ct.roi_box_mm": box}),
  seed: (point) => {
    change({"ct.seed_mm": point.map((value) => Math.round(10 * value) / 10)});
    update({placing: null});
  },
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
  syncScene();
}

// --- Slices. ---

let scanCount = 0;
function keyed(value) {
  if (!value.key) Object.defineProperty(value, "key", {value: `n${++scanCount}`});
  return value;
}

function syncModel() {
  const edge = shownEdge();
  Object.assign(model, {
    scan: state.scan && keyed(state.scan),
    tissue: state.tissue && keyed(state.tissue),
    cross: state.cross,
    window: state.window,
    overlay: state.overlay,
    box: setting("ct.roi_box_mm"),
    seed: setting("ct.seed_mm"),
    isPlacing: state.placing === "seed",
    isBoxShown: state.step === "see",
    edge: edge.isRest ? edge.points : [],
  });
  renderSlices();
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
  views.scene.tool = state.step === "edge" ? views.edge : null;
}

function forget(name) {
  built.delete(name);
  views.scene.drop(name);
}

function build(layer) {
  const last = built.get(layer.name);
  if (last && last.length === layer.parts.length && last.every((part, k) => part === layer.parts[k])) return;
  built.set(layer.name, layer.parts);
  views.scene.put(layer.name, layer.build(), layer);
}

let fitted = {skin: null, file: "", centre: null, radius: 0};

/** Fits the view to the skin where it is another one; small changes of size leave the camera alone. */
function fitScene() {
  const skin = shownSkin(),
    file = state.case ? state.case.file : "";
  if (!skin || skin === fitted.skin) return;
  const ball = ballAbout(skin.vertices),
    isOther = file !== fitted.file;
  fitted.skin = skin;
  const shift = isOther ? Infinity : Math.hypot(...ball.centre.map((value, k) => value - fitted.centre[k]));
  if (shift < 0.06 * ball.radius && Math.abs(ball.radius - fitted.radius) < 0.06 * ball.radius) return;
  fitted = {skin, file, ...ball};
  if (isOther) views.scene.forget();
  views.scene.fit(ball.centre, ball.radius);
}

/** The skin that the step shows: {vertices, triangles}, or null. */
export function shownSkin() {
  const {step, tissue, body, stretch} = state;
  if (step === "edge" && state.edge.where === "stretched") return stretch && stretch.skin;
  if (step === "see" || step === "edge" || step === "open")
    return (tissue && tissue.skin) || (body && body.skin) || null;
  if (step === "hold") return body && body.skin;
  return (stretch && stretch.skin) || (body && body.skin) || (tissue && tissue.skin) || null;
}

function scrub() {
  const layer = views.scene.layers.get("body");
  const {body, stretch} = state;
  if (state.step !== "hold" || !layer || !body || !stretch) return;
  const rest = stretch.rest || body.skin.vertices;
  if (rest.length !== body.skin.vertices.length || stretch.skin.vertices.length !== rest.length) return;
  if (layer.share === state.scrub && layer.of === stretch) return;
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
  subscribe(syncModel);
  when(
    () => [
      state.step,
      state.tissue,
      state.body,
      state.stretch,
      state.plan,
      state.run,
      state.moment,
      state.edge,
      state.case,
      state.drafts,
      state.focus,
      state.scrub,
    ],
    syncScene,
  );
}
