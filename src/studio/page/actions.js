// What the page asks of the server, and how answers reach the state.

import {call, load} from "./api.js";
import {
  state,
  update,
  hasVoxels,
  isFresh,
  newBrush,
  newHistory,
  newPatch,
  newPhoto,
  nothingFound,
  nothingLaid,
  nothingMeasured,
  setting,
} from "./store.js";
import {argumentsOf} from "./photo_settings.js";
import {basisOf, differences, freeLetter, isKept} from "./kept.js";
import {middleOf, minus, plus, voxelAt} from "./geometry.js";

const kDerived = ["tissue", "body", "stretch", "plan", "room"];
const kPlanned = ["body", "stretch", "plan"];
const kNeeds = {
  see: ["tissue"],
  edge: ["tissue"],
  hold: ["body"],
  plan: kPlanned,
  run: kPlanned,
  compare: kPlanned,
  register: ["body", "stretch"],
  program: kPlanned,
};

/** One call with its marks in the state: busy while it runs, its problem if it fails. @returns the result, or null. */
export async function ask(name, args = {}, isWanted = () => true) {
  mark(name, (state.busy[name] || 0) + 1);
  setProblem(name, null);
  try {
    if (kWhole.includes(name)) await Promise.allSettled(planning);
    const answer = call(name, args);
    if (kPlanned.includes(name)) follow(answer);
    const result = await answer;
    return isWanted() ? await load(result) : null;
  } catch (error) {
    await takeFailure(name, error, isWanted);
    return null;
  } finally {
    mark(name, state.busy[name] - 1);
  }
}

// Requests on different connections may overtake each other, and the server refuses one of kPlanned during a run.
const kWhole = ["run", "lay"];
const planning = new Set(); // answers of kPlanned that are on their way

function follow(answer) {
  const end = () => planning.delete(answer);
  planning.add(answer);
  answer.then(end, end);
}

function mark(name, count) {
  update({busy: {...state.busy, [name]: count}});
}

function setProblem(name, problem) {
  if (problem || state.problems[name]) update({problems: {...state.problems, [name]: problem}});
}

async function takeFailure(name, error, isWanted) {
  if (error.kind === "stopped" || !isWanted()) return;
  if (error.kind === "lost") return update({link: "lost"});
  if (error.kind === "denied") return update({link: "denied"});
  if (error.kind === "changed") await reload();
  if (!isWanted()) return;
  const revision = state.case ? state.case.revision : null;
  setProblem(name, {...error.problem, kind: error.kind || "crashed", message: error.message, revision});
}

async function reload() {
  const found = await ask("case");
  if (!found) return;
  if (isOpen(found.file)) update({case: found, drafts: {...pending}});
  else takeCase(found, true);
}

function isOpen(file) {
  return Boolean(state.case) && state.case.file === file;
}

/** Takes a case that the server gave; `isOther`: it is not the one that was open. */
export function takeCase(found, isOther) {
  if (isOther) document.activeElement?.blur(); // hands on what is half typed, now: it belongs to the case before
  // What a person accepted were cautions about the case as it was.
  const isSame = !isOther && state.case && state.case.revision === found.revision;
  update({case: found, problems: {}, ...(isSame ? {} : {accept: [], acceptLaid: [], acceptMark: []})});
  dropForeign();
  if (!isOther) return;
  for (const name of Object.keys(tickets)) tickets[name] += 1; // answers about the case before are of no use
  pending = {}; // and what was set belongs to that case
  update({
    ...nothingMeasured(),
    preview: {},
    drafts: {},
    refused: {},
    brush: newBrush(),
    history: newHistory(),
    patch: newPatch(),
    ...nothingFound(),
    cross: null,
    edge: {...state.edge, points: [], curve: [], isClosed: false, selected: -1, isSaved: true, mode: "look"},
  });
  scanning = loadScan();
  goTo("see");
}

// A kept result of another case, tissue or tumour's edge cannot be laid over this one's.
function dropForeign() {
  const kept = state.kept.filter((one) => one.basis === basisOf(state.case));
  if (kept.length < state.kept.length) update({kept, keptDropped: state.kept.length - kept.length});
}

let scanning = null; // the scan on its way: it comes before the tissue, which may take long without a region box

async function loadScan() {
  const file = state.case.file;
  if (!state.case.inputs["ct.volume"]) return;
  const scan = await ask("scan");
  if (scan && state.case && state.case.file === file) update({scan, cross: state.cross || firstPlace(scan.grid)});
}

// What a person wants to see first: the seed, else the middle of the region box, else that of the scan.
function firstPlace(grid) {
  const seed = setting("ct.seed_mm"),
    box = setting("ct.roi_box_mm");
  const place = seed || (box && plus(box[0], minus(box[1], box[0]), 0.5));
  return place && voxelAt(grid, place) >= 0 ? place : middleOf(grid);
}

let opening = null; // a promise while another case is being opened or made

/** Opens, makes or virtually makes a case: the calls `open`, `create` and `demo`. */
export async function begin(name, args) {
  while (sending || opening) await (sending || opening); // what is set belongs to the case that is open
  opening = open(name, args);
  if (await opening) list(); // its folder may be in the one that is listed
}

async function open(name, args) {
  const found = await ask(name, args);
  if (found) takeCase(found, true);
  opening = null;
  return found;
}

/** Lists a folder of the server; without one that which is listed, as it is now, or the start's first. */
export async function list(folder) {
  const here = folder || (state.files && state.files.folder.id);
  const files = (await ask("files", here ? {folder: here} : {})) || (here && !folder && (await ask("files")));
  if (files) update({files});
}

/** Lists the start's folder the nearest to the case. */
export async function listNearCase() {
  await list();
  const {roots = [], folder} = state.files || {};
  const about = roots.filter((root) => state.case && state.case.file.startsWith(`${root.name}/`));
  const nearest = about.sort((a, b) => b.name.length - a.name.length)[0];
  if (nearest && nearest.id !== folder.id) await list(nearest.id);
}

/** Shows a step, and computes what it shows. */
export function goTo(step) {
  update({step, placing: null, focus: null, notice: ""});
  refreshStep();
}

const tickets = {};

/** Asks for a derived result; an answer that a newer question has overtaken is dropped.
 *  @param as  the state's name for the result   @param about  what is kept with it */
export async function refresh(name, args = {}, as = name, about = {}) {
  const ticket = (tickets[as] || 0) + 1;
  tickets[as] = ticket;
  const isLast = () => tickets[as] === ticket;
  const revision = state.case.revision;
  const result = await ask(name, args, isLast);
  if (result && isLast()) update({[as]: {...withTriangles(result), revision, ...about}});
  return isLast() ? result : null;
}

// A stretched skin has the triangles of the one at rest.
function withTriangles(result) {
  if (!result.skin || result.skin.triangles || !state.body) return result;
  return {...result, skin: {...result.skin, triangles: state.body.skin.triangles}};
}

/** Computes what the step shows and what is not there yet for these settings. */
export async function refreshStep() {
  const step = state.step,
    wasRunning = Boolean(state.busy.run);
  await scanning;
  for (const name of needsOf(step)) {
    if (!state.case || state.step !== step) return;
    if (state.busy.run && !wasRunning) return; // the run that has begun meanwhile has the output folder to itself
    if (isFresh(name) || isFailed(name)) continue;
    const revision = state.case.revision;
    if (!(await refresh(name)) && state.case.revision === revision) break;
  }
  if (step === "edge" && state.step === step && isFailed("tissue") && !state.body && !isFailed("body")) refresh("body");
  if (step === "program" && state.step === step && !state.arm) playFirst();
}

// The program that was played last, where it is still there; else the first.
function playFirst() {
  const of = programOf(state.armOf) ? state.armOf : ["run", "tissue", "mark"].find(programOf);
  if (of) playProgram(of);
}

// A body that is no part of a scan has no tissue to find: its mesh is drawn on instead.
function needsOf(step) {
  if (step === "edge" && isFailed("tissue")) return ["body"];
  if (!hasVoxels() && (step === "see" || step === "edge")) return ["body"];
  return kNeeds[step] || [];
}

/** Whether a derived result is still to come for the settings as they are. */
export function isAwaited(name) {
  return !isFresh(name) && !isFailed(name);
}

// Asked again before a change, the server would give the same answer.
function isFailed(name) {
  const problem = state.problems[name];
  return Boolean(problem && state.case && problem.kind === "problem" && problem.revision === state.case.revision);
}

/** Stops a call; the server answers that call with "stopped". */
export async function stop(name) {
  await call("stop", {call: name}).catch(() => null);
}

const kPause = 300; // ms: of a value that is stepped, after its last step

let pending = {}; // set for the case that is open
let due = 0; // ms: when it may be sent
let sending = null; // a promise while changes are under way

/** Sets settings {key: value}: shown at once, and sent; what is set while a change is under way goes with the next. */
export function change(set) {
  Object.assign(pending, set);
  update({drafts: {...state.drafts, ...set}});
  sending ||= send();
}

/** The same for a value that is stepped, by a key that is held for instance: it is sent after its last step. */
export function changeSoon(set) {
  due = performance.now() + kPause;
  change(set);
}

/** Whether a setting was set and is not sent yet. */
export function isWaiting(key) {
  return key in pending;
}

/** Sends what is pending while the page goes away, without waiting for the answer. */
export function sendAtOnce() {
  if (opening || state.busy.change || !isPending()) return;
  call("change", {...ofCase(), set: pending}, {keepalive: true}).catch(() => null);
  pending = {};
  update({drafts: {}}); // if the page comes back, the server's state brings the case
}

// What a change is of: two cases with the same text have the same revision.
function ofCase() {
  return {case_file: state.case.file, revision: state.case.revision};
}

function isPending() {
  return Object.keys(pending).length > 0;
}

async function send() {
  let file = null; // of the case whose settings were sent last
  while (await isDue()) file = await sendPending();
  sending = null;
  if (file && isOpen(file)) refreshStep();
}

// Waits until what is pending may be sent. @returns whether there is something
async function isDue() {
  await pause();
  await opening;
  if (isPending()) await overtake();
  return isPending();
}

async function sendPending() {
  const {file} = state.case,
    set = pending;
  pending = {};
  const found = await ask("change", {...ofCase(), set}, () => isOpen(file));
  if (!isOpen(file)) return file;
  update({drafts: withoutSent(state.drafts, set), refused: found ? {} : {...state.refused, ...set}});
  if (found) takeCase(found, false);
  return file;
}

async function pause() {
  for (let left = due - performance.now(); left > 0; left = due - performance.now()) {
    await new Promise((resolve) => {
      setTimeout(resolve, left);
    });
  }
}

// What is computed from the settings as they were is of no use any more.
async function overtake() {
  const busy = kDerived.filter((name) => state.busy[name]);
  for (const name of busy) tickets[name] += 1;
  if (busy.length) await stop(busy[0]);
}

// A key that was set again meanwhile stays: its newer value waits in `pending`.
function withoutSent(drafts, set) {
  return Object.fromEntries(Object.entries(drafts).filter(([key]) => !(key in set) || key in pending));
}

/** Stores the tumour's edge, mm. */
export async function saveEdge(points, where) {
  const {file} = state.case;
  const found = await ask("edge", {...ofCase(), points_mm: points, configuration: where}, () => isOpen(file));
  if (!found) return;
  takeCase(found, false);
  update({edge: {...state.edge, isSaved: true, mode: "look"}, notice: "The tumour's edge is stored in the case."});
  refreshStep();
}

/** Runs the case: cut as planned, correction, cut along the corrected path. */
export function run() {
  return runWith({});
}

/** The same with the cautions of the last run that a person accepts. */
export function runAccepting() {
  return runWith({accept: state.accept, revision: state.run.revision});
}

async function runWith(acceptance) {
  if (!(await allSent())) return;
  update({messages: [], moment: null, progress: {...state.progress, run: null}, accept: acceptance.accept || []});
  update(nothingLaid()); // a run removes what was laid
  const about = {settings: state.case.settings, basis: basisOf(state.case)};
  const result = await refresh("run", acceptance, "run", about);
  askAgain();
  if (result) goTo(state.step === "program" ? "program" : "compare");
  else refreshStep();
}

// A setting that was typed just now belongs to what is run next. @returns false where the server refused one, or
// another case came
async function allSent() {
  const waiting = Object.keys(state.drafts),
    {file} = state.case;
  await sending;
  return isOpen(file) && !waiting.some((key) => key in state.refused);
}

// What was refused because a run was under way may be asked for once more.
function askAgain() {
  for (const name of kPlanned) setProblem(name, null);
}

/** Keeps the run's result beside those that follow, and runs the case with its settings as they are now. */
export async function keepAndRun() {
  if (!(await allSent())) return;
  keep();
  await run();
}

function keep() {
  const {run: result, kept} = state,
    letter = freeLetter(kept);
  if (!result || !letter || isKept(result)) return;
  const {settings, basis, as_planned, corrected, outcome, verdict} = result;
  update({kept: [...kept, {letter, settings, basis, as_planned, corrected, outcome, verdict}], keptDropped: 0});
}

/** Forgets a kept result. */
export function dropKept(letter) {
  update({kept: state.kept.filter((one) => one.letter !== letter)});
}

/** Writes a kept result's settings to the case again. */
export function putBack(one) {
  change(differences(state.case.settings, one.settings));
}

const kResults = {run: "run", tissue: "lay", mark: "mark"};

/** The text of a program, if there is one. @param of  "run"; "tissue" or "mark": one that was laid on the cloud */
export function programOf(of) {
  const result = state[kResults[of]];
  return result && result.program;
}

/** Lets the arm play a program. @param of  as of programOf */
export async function playProgram(of) {
  update({arm: null, armOf: of});
  await refresh("arm", {of});
}

/** Shows a photograph; what was found on another one is dropped. */
export async function openPicture(file) {
  update({picture: null, photograph: null, photo: {...newPhoto(), file}});
  await refresh("picture", {file: file.id});
}

/** Finds the contours on the photograph, or takes those drawn by hand, and measures the cut. */
export async function measure() {
  const asked = argumentsOf(state.photo);
  if (await refresh("photograph", asked)) update({photograph: {...state.photograph, asked: JSON.stringify(asked)}});
}

/** Makes a cloud for practice, and chooses it; one of a case that was left meanwhile is not chosen. */
export async function makeCloud(seed) {
  const {file} = state.case;
  const made = await ask("virtual_cloud", {seed}, () => isOpen(file));
  if (!made) return;
  chooseCloud({id: made.file, name: made.name}, true);
  if (state.files) list(state.files.folder.id); // it may be in the folder that is listed
}

/** Chooses the cloud to be registered; a registration of another one is dropped. */
export function chooseCloud(file, isVirtual = false) {
  const cloud = {...state.cloud, file, isVirtual, isOfFrame: false};
  update({cloud, register: null, ...nothingLaid(), notice: ""});
}

/** Finds the mark on a frame of a colour and depth camera, and chooses the frame's cloud. */
export async function readFrame() {
  const asked = frameArguments(state.framing),
    first = lastKey;
  const found = await refresh("frame", asked, "frame", {asked: JSON.stringify(asked)});
  if (!found) return;
  chooseCloud({id: found.file, name: found.name});
  const said = state.messages.filter(
    ({key, call: of, severity}) => key > first && of === "frame" && severity !== "info",
  );
  update({
    cloud: {...state.cloud, isOfFrame: true, frame: "camera"},
    frame: {...state.frame, warnings: said.map(({text}) => text)},
  });
  if (state.files) list(state.files.folder.id); // its folder may be in the one that is listed
}

/** The arguments of the call `frame`, or null while a file is missing. */
export function frameArguments({isCloud, color, organised, depth, intrinsics, mark, isOpen, planes}) {
  const about = {mark, is_open: isOpen, planes};
  if (isCloud) return organised && {color: organised.id, ...about};
  return color && depth && intrinsics && {color: color.id, depth: depth.id, intrinsics: intrinsics.id, ...about};
}

/** Finds where the simulated surface lies in the cloud. */
export async function register() {
  const {file, scale, range, settling_mm} = state.cloud;
  update(nothingLaid());
  await refresh("register", {file: file.id, scale: scale === "range" ? range : scale, settling_mm});
}

/** Drops the registration. */
export async function refuseRegistration() {
  if (!(await ask("unregister"))) return;
  update({
    register: null,
    ...nothingLaid(),
    notice: "The registration is refused, and nothing of it is kept.",
  });
}

/** What can be laid: the state's names for it and for what is accepted of it, and whose program it is. */
export const kLaid = {
  incise: {as: "lay", accepted: "acceptLaid", of: "tissue"},
  mark: {as: "mark", accepted: "acceptMark", of: "mark"},
};

/** Lays the run's path on the registered cloud, or the tumour's edge. @param kind  "incise" or "mark" */
export function lay(kind) {
  return layWith(kind, {});
}

/** The same with the cautions that a person accepts for this kind. */
export function layAccepting(kind) {
  const {as, accepted} = kLaid[kind],
    {revision, registration_sha256} = state[as];
  return layWith(kind, {accept: state[accepted], revision, registration_sha256});
}

async function layWith(kind, acceptance) {
  const {frame, camera} = state.cloud,
    {as, accepted, of} = kLaid[kind];
  update({arm: null, armOf: of, layKind: kind, [accepted]: acceptance.accept || []});
  await refresh("lay", {kind, camera: frame === "camera" && camera ? camera.id : null, ...acceptance}, as);
  if (state.step === "program") refreshStep();
}

/** Takes an event of the server. */
export function takeEvent(name, data) {
  if (name === "progress") update({progress: {...state.progress, [data.call]: data}});
  if (name === "message") update({messages: [...state.messages.slice(-199), {...data, key: nextKey()}]});
  if (name === "moment") takeMoment(data);
  if (name === "state") takeState(data);
}

let lastKey = 0;
function nextKey() {
  lastKey += 1;
  return lastKey;
}

let isMomentLoading = false;

// While one moment's arrays are on their way, others are skipped: a newer one comes soon.
async function takeMoment(data) {
  if (isMomentLoading) return;
  isMomentLoading = true;
  const moment = await load(data).catch(() => null);
  isMomentLoading = false;
  if (moment) update({moment});
}

/** Takes the state as the call or the event `state` gives it. */
export function takeState(data) {
  const wasRunning = state.running.some((job) => job.call === "run");
  update({version: data.version, running: data.running || []});
  setProblem("state", data.case_problem ? {kind: "problem", ...data.case_problem} : null);
  if (data.case && !opening) takeStored(data.case); // else the answer brings the case
  const isRunning = state.running.some((job) => job.call === "run");
  if (wasRunning && !isRunning && !state.busy.run)
    update({notice: "The run has ended. Run again to see what is there."});
}

function takeStored(found) {
  if (!isOpen(found.file)) return takeCase(found, true);
  const isComing = sending || state.busy.edge; // with an answer
  if (isComing || found.revision === state.case.revision) return undefined;
  takeCase(found, false);
  return refreshStep();
}
