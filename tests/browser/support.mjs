// What the browser tests share: a studio in a temporary folder, a browser, and what a person does and sees on the page.

import assert from "node:assert/strict";
import {execFileSync, spawn} from "node:child_process";
import fs from "node:fs";
import {createRequire} from "node:module";
import os from "node:os";
import path from "node:path";
import {fileURLToPath} from "node:url";

const kHere = path.dirname(fileURLToPath(import.meta.url));
const kStop = 1000 * Number(process.env.INCISE_STOP_S || 600); // ms: ends a test that hangs; no test is about time
const kPlanes = ["axial", "coronal", "sagittal"];

/** The page's steps in their order. */
export const kSteps = ["open", "see", "edge", "hold", "plan", "run", "compare", "photograph", "register", "program"];

/** The packages of package.json, from the folder that INCISE_NODE_MODULES names, else from this one. */
export const packages = createRequire(path.join(process.env.INCISE_NODE_MODULES || kHere, "none.js"));
if (!isInstalled("playwright-core")) skip("the packages of tests/browser/package.json are not installed");

function isInstalled(name) {
  try {
    return Boolean(packages.resolve(name));
  } catch {
    return false;
  }
}

/** Ends a test file that cannot run here, with the status by which ctest knows it. */
export function skip(reason) {
  console.log(`SKIPPED: ${reason}`);
  process.exit(77);
}

function command() {
  assert.ok(process.env.INCISE_COMMAND, "INCISE_COMMAND has to name the built incise command");
  return process.env.INCISE_COMMAND;
}

const endings = new WeakMap(); // of a test: what is to be done after it, the last first

function afterwards(t, end) {
  if (!endings.has(t)) {
    endings.set(t, []);
    t.after(async () => {
      for (const one of endings.get(t).reverse()) await one();
    });
  }
  endings.get(t).push(end);
}

/** A folder that is gone after the test. */
export function temporaryFolder(t) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "incise-browser-"));
  afterwards(t, () => fs.rmSync(folder, {recursive: true, force: true}));
  return folder;
}

/** Runs `incise` in a folder. */
export function incise(folder, ...args) {
  execFileSync(command(), args, {cwd: folder, stdio: "pipe"});
}

/** Runs Python where the command's tests lie, whose modules it may import. */
function python(script, ...args) {
  const options = {cwd: path.join(kHere, "..", "cli"), stdio: "pipe"};
  execFileSync(process.env.INCISE_PYTHON || "python3", ["-B", "-c", script.join("\n"), ...args], options);
}

/** Writes a virtual specimen as a case with a coarse mesh: the tests are about the page. @returns its folder */
export function writePhantom(folder, ...options) {
  incise(folder, "phantom", ...options, "-o", "specimen");
  const to = path.join(folder, "specimen");
  replaceIn(path.join(to, "case.yaml"), /tets: \d+/, "tets: 6000");
  return to;
}

/** Replaces a text that a file has to hold. */
export function replaceIn(file, from, to) {
  const before = fs.readFileSync(file, "utf8"),
    after = before.replace(from, to);
  assert.notEqual(after, before, `${from} in ${file}`);
  fs.writeFileSync(file, after);
}

/** Writes the small block of the command's tests as a case. @param changes  laid over it  @returns its folder */
export function writeBlock(folder, name = "case", changes = {}) {
  const to = path.join(folder, name);
  const script = [
    "import json, pathlib, sys, small_case",
    "settings = small_case.merged(small_case.SOUND, json.loads(sys.argv[2]))",
    "case = small_case.write_case(pathlib.Path(sys.argv[1]), settings)",
    'small_case.write_tumor_surface(case / "tumor.stl")',
  ];
  python(script, to, JSON.stringify(changes));
  return to;
}

/** Writes the photograph of a cut: a green ring in a red one, about the pixel (250, 250). @param radii  of both, px */
export function writePhotograph(file, [green, red]) {
  const script = [
    "import pathlib, sys, small_photo",
    "rings = ((float(sys.argv[2]), 4.0, small_photo.GREEN, 0.0), (float(sys.argv[3]), 4.0, small_photo.RED, 0.0))",
    "small_photo.ring_photo(pathlib.Path(sys.argv[1]), rings=rings)",
  ];
  python(script, file, String(green), String(red));
}

/** `incise studio` in a folder. `address`: what it tells the user to open. */
export class Studio {
  static async start(t, folder, ...args) {
    const child = spawn(command(), ["studio", ...args], {cwd: folder, stdio: ["ignore", "pipe", "inherit"]});
    const studio = new Studio(child, await firstAddress(child));
    afterwards(t, () => studio.end("SIGTERM"));
    return studio;
  }

  constructor(child, address) {
    Object.assign(this, {child, address});
    this.ended = new Promise((resolve) => {
      child.once("exit", resolve);
    });
    const url = new URL(address);
    this.origin = url.origin;
    this.port = url.port;
    this.token = url.hash.replace("#token=", "");
  }

  async end(signal) {
    if (this.child.exitCode === null && this.child.signalCode === null) this.child.kill(signal);
    await this.ended;
  }

  /** A call past the page, as another program would make it. @returns {status, answer} */
  async call(name, args = {}) {
    const headers = {"Content-Type": "application/json", "X-Incise-Token": this.token};
    const options = {method: "POST", headers, body: JSON.stringify(args)};
    const response = await fetch(`${this.origin}/api/call/${name}`, options);
    return {status: response.status, answer: await response.json()};
  }
}

// Goes on reading after the address, so that the server never waits for a reader.
function firstAddress(child) {
  return new Promise((resolve, reject) => {
    let printed = "";
    child.stdout.on("data", (chunk) => {
      printed += chunk;
      const found = /http:\/\/127\.0\.0\.1:\d+\/#token=\w+/.exec(printed);
      if (found) resolve(found[0]);
    });
    child.once("error", reject);
    child.once("exit", () => reject(new Error(`incise studio ended without an address: ${printed}`)));
  });
}

/** A browser that ends with the test. */
export async function startBrowser(t) {
  const {chromium} = packages("playwright-core");
  const browser = await chromium.launch({
    executablePath: process.env.INCISE_CHROMIUM || "/usr/bin/chromium",
    args: ["--no-sandbox", "--enable-unsafe-swiftshader"], // a test machine has no user namespaces and no GPU
  });
  afterwards(t, () => browser.close());
  return browser;
}

/** A page of its own context. `page.complaints`: errors of scripts and of the console, broken policies, foreign
 *  requests. @param options  of the context */
export async function newPage(browser, options = {}) {
  const context = await browser.newContext({viewport: {width: 1400, height: 900}, colorScheme: "light", ...options});
  const page = await context.newPage();
  page.setDefaultTimeout(kStop);
  page.complaints = [];
  const note = (text) => page.complaints.push(text);
  page.on("pageerror", (error) => note(`script: ${error.message}`));
  page.on("console", (message) => {
    const isAnswer = message.text().startsWith("Failed to load resource: the server responded");
    if (message.type() === "error" && !isAnswer) note(`console: ${message.text()}`);
  });
  page.on("response", (response) => {
    const isStopped = response.status() === 499; // a call that a later change made needless
    if (response.status() >= 400 && !isStopped) note(`answer ${response.status()}: ${new URL(response.url()).pathname}`);
  });
  page.on("dialog", async (dialog) => {
    note(`dialog: ${dialog.message()}`);
    await dialog.dismiss();
  });
  if (process.env.INCISE_PAGE_FOLDER) await servePagesFrom(page, process.env.INCISE_PAGE_FOLDER);
  await page.addInitScript(() => {
    document.addEventListener("securitypolicyviolation", (event) => {
      console.error(`policy: ${event.violatedDirective} ${event.blockedURI}`);
    });
  });
  return page;
}

// Modules and style sheet from a folder in place of those built into the command: to try a page without a build.
function servePagesFrom(page, folder) {
  const folders = [folder, path.join(folder, "../../report/page")]; // whose viewer the studio shares
  return page.route("**/page/*", (route) => {
    const name = path.basename(new URL(route.request().url()).pathname);
    const file = folders.map((one) => path.join(one, name)).find((one) => fs.existsSync(one));
    return file ? route.fulfill({path: file}) : route.continue();
  });
}

/** A studio in a folder, and a page that is connected to it and shows the case that it was started with.
 *  @returns {studio, browser, page} */
export async function openedStudio(t, folder, ...args) {
  const studio = await Studio.start(t, folder, ...args),
    browser = await startBrowser(t),
    page = await newPage(browser);
  await openStudio(page, studio, args.length > 0 && !args[0].startsWith("-"));
  return {studio, browser, page};
}

/** Opens a studio's address and waits until the page is connected, and shows a case if there is one. */
export async function openStudio(page, studio, hasCase = true) {
  page.on("request", (request) => {
    const url = new URL(request.url());
    if (url.protocol.startsWith("http") && url.hostname !== "127.0.0.1") page.complaints.push(`request: ${url}`);
  });
  await page.goto(studio.address);
  await page.waitForSelector("[data-link-state=open]");
  if (hasCase) await until(page, () => window.incise.state.case);
}

/** Steps that build on one another: after one that fails, the rest is left out. */
export function chain(t) {
  let broken = "";
  return (name, body) =>
    t.test(name, async (inner) => {
      if (broken) return inner.skip(`left out after: ${broken}`);
      try {
        await body(inner);
      } catch (error) {
        broken = name;
        throw error;
      }
      return undefined;
    });
}

// --- What the page knows. ---

/** Waits until a condition holds in the page; where it never does, says how the page stands. */
export async function until(page, condition, argument) {
  try {
    await page.waitForFunction(condition, argument, {polling: 100});
  } catch (error) {
    const lines = [error.message, await page.evaluate(standing).catch(String), ...page.complaints];
    throw new Error(lines.join("\n"), {cause: error});
  }
}

function standing() {
  const {step, link, busy, running, problems, drafts, notice, case: open} = window.incise.state,
    constraints = open && open.settings.specimen.constraints;
  return JSON.stringify({step, link, busy, running, problems, drafts, notice, constraints});
}

/** Waits until no call is on its way and no setting waits to be sent. */
export function idle(page) {
  return until(page, () => {
    const {busy, drafts} = window.incise.state;
    return !Object.values(busy).some(Boolean) && Object.keys(drafts).length === 0;
  });
}

/** Waits until a result is there for the settings as they are. */
export async function fresh(page, name) {
  await until(
    page,
    (key) => {
      const {state} = window.incise;
      return state.case && state[key] && state[key].revision === state.case.revision && !state.busy[key];
    },
    name,
  );
  await idle(page);
}

/** A part of the page's state, by a dotted key. */
export function stateOf(page, key) {
  const partOf = (dotted) => dotted.split(".").reduce((part, name) => part && part[name], window.incise.state);
  return page.evaluate(partOf, key);
}

/** Goes to a step by its button. */
export async function goTo(page, step) {
  await page.click(`[data-go=${step}]`);
  await page.waitForSelector(`.page[data-step=${step}]`);
}

/** Waits until a step shows all that it can compute. */
export async function settle(page, step) {
  const shown = {see: ["tissue"], edge: ["tissue"], hold: ["body"], plan: ["plan"], run: ["plan"], compare: ["plan"]};
  for (const name of shown[step] || []) await fresh(page, name);
  await idle(page);
}

/** Runs the case as it is, until step Compare shows the result. */
export async function runCase(page) {
  await goTo(page, "run");
  await page.click("[data-do=run]");
  await page.waitForSelector(".page[data-step=compare]");
}

/** The input of a setting in a section, by its label; `within`: the legend of its group. */
export function inputIn(page, section, label, within = "") {
  const group = within ? ` fieldset:has(> legend:text-is("${within}"))` : "";
  const row = `:is(.number, .check):has(label:text-is("${label}"))`;
  return page.locator(`[data-section=${section}]${group} ${row} :is(input, select)`);
}

/** Types a value into an input and hands it on with Enter. */
export async function type(input, value) {
  await input.fill(String(value));
  await input.press("Enter");
}

/** Types numbers side by side, such as a point. */
export async function typeAll(page, section, legend, values) {
  const inputs = page.locator(`[data-section=${section}] fieldset:has(> legend:text-is("${legend}")) input`);
  assert.equal(await inputs.count(), values.length, `${section}: ${legend}`);
  for (let k = 0; k < values.length; ++k) await type(inputs.nth(k), values[k]);
}

// --- What the views show. ---

/** Shares of the pictures that are not background, by view. */
export function coverage(page) {
  return page.evaluate(
    (names) => Object.fromEntries(names.map((name) => [name, window.incise.views[name].coverage()])),
    [...kPlanes, "scene"],
  );
}

/** Red, green and blue in a slice at a place, mm. */
export function slicePixel(page, name, point) {
  return page.evaluate(
    ([view, at]) => {
      const slice = window.incise.views[view];
      slice.draw();
      const [x, y] = slice.toScreen(at).map((value) => Math.round(value * slice.ratio));
      return [...slice.canvas.getContext("2d").getImageData(x, y, 1, 1).data.slice(0, 3)];
    },
    [name, point],
  );
}

/** Red, green, blue and opacity in the 3D view at a place, mm. */
export function scenePixel(page, point) {
  return page.evaluate((at) => {
    const {scene} = window.incise.views;
    scene.draw();
    const gl = scene.renderer.getContext();
    const ratio = gl.drawingBufferWidth / scene.host.clientWidth;
    const [x, y] = scene.toScreen(at).map((value) => Math.round(value * ratio));
    const pixel = new Uint8Array(4);
    gl.readPixels(x, gl.drawingBufferHeight - 1 - y, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    return [...pixel];
  }, point);
}

/** The rectangle about all that the 3D view shows, px, and its scale: {left, right, top, bottom, pixelsPerMm}. */
export function silhouette(page) {
  return page.evaluate(() => {
    const {scene} = window.incise.views;
    scene.draw();
    const gl = scene.renderer.getContext(),
      [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
    const pixels = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    const box = {left: width, right: -1, top: height, bottom: -1, pixelsPerMm: scene.pixelsPerMm()};
    for (let k = 0; k < width * height; ++k) {
      if (pixels[4 * k + 3] <= 24) continue;
      const [x, y] = [k % width, height - 1 - Math.floor(k / width)];
      Object.assign(box, {left: Math.min(box.left, x), right: Math.max(box.right, x)});
      Object.assign(box, {top: Math.min(box.top, y), bottom: Math.max(box.bottom, y)});
    }
    return box;
  });
}

/** Turns the 3D view by one of its buttons. */
export async function look(page, name) {
  await page.click(`[data-view=scene] .view-head button:text-is("${name}")`);
}

/** Where a place, mm, is in a view, px of its canvas. It is drawn first: a view has turned only when it is drawn. */
export function toScreen(page, point, view = "scene") {
  return page.evaluate(
    ([at, name]) => {
      window.incise.views[name].draw();
      return window.incise.views[name].toScreen(at);
    },
    [point, view],
  );
}

/** Where a place, mm, is in a view, px of the page. */
export async function pixelIn(page, view, point) {
  const [x, y] = await toScreen(page, point, view),
    canvas = await page.locator(`[data-view=${view}] canvas`).boundingBox();
  return [canvas.x + x, canvas.y + y];
}

/** Clicks a place of the 3D view, mm. */
export async function clickScene(page, point) {
  await page.mouse.click(...(await pixelIn(page, "scene", point)).map(Math.round));
}

/** The names of the calls that the page makes from now on. */
export function watchCalls(page) {
  const calls = [];
  page.on("request", (request) => {
    const name = /\/api\/call\/(\w+)$/.exec(request.url());
    if (name) calls.push(name[1]);
  });
  return calls;
}

/** The brightest and the darkest block of voxels in the slices through the crosshair, and the grey of each on the canvas
 *  and by the scan: [{view, found, expected}]. The overlay has to be off. Written for scans along x, y and z. */
export function knownVoxels(page) {
  return page.evaluate(() => {
    const {scan, cross, window: grey} = window.incise.state;
    const {size, spacing_mm: spacing, origin_mm: origin} = scan.grid;
    const at = cross.map((value, k) => Math.round((value - origin[k]) / spacing[k]));
    const value = ([i, j, k]) => scan.voxels[i + size[0] * (j + size[1] * k)];
    const greyOf = (hu) => Math.max(0, Math.min(255, ((hu - grey.level) / grey.width + 0.5) * 255));
    const kHalf = 3;
    // {mean, spread} of the block about a voxel in the plane of two axes.
    const block = (middle, axes) => {
      let sum = 0,
        low = 255,
        high = 0;
      for (let a = -kHalf; a <= kHalf; ++a) {
        for (let b = -kHalf; b <= kHalf; ++b) {
          const voxel = [...middle];
          voxel[axes[0]] += a;
          voxel[axes[1]] += b;
          const shade = greyOf(value(voxel));
          [sum, low, high] = [sum + shade, Math.min(low, shade), Math.max(high, shade)];
        }
      }
      return {middle, mean: sum / (2 * kHalf + 1) ** 2, spread: high - low};
    };
    const blocks = (axes) => {
      const list = [];
      for (let a = 12; a < size[axes[0]] - 12; a += 4) {
        for (let b = 12; b < size[axes[1]] - 12; b += 4) {
          const middle = [...at];
          [middle[axes[0]], middle[axes[1]]] = [a, b];
          const isByCross = axes.some((axis) => Math.abs(middle[axis] - at[axis]) <= kHalf + 2);
          if (!isByCross) list.push(block(middle, axes));
        }
      }
      return list.filter((one) => one.spread < 90).sort((one, other) => one.mean - other.mean);
    };
    const shown = (name, middle) => {
      const view = window.incise.views[name];
      view.draw();
      const point = middle.map((index, k) => origin[k] + index * spacing[k]);
      const [x, y] = view.toScreen(point).map((pixel) => pixel * view.ratio);
      const half = Math.max(1, Math.floor(kHalf * view.zoom * spacing[0] * view.ratio)),
        [left, top] = [x, y].map((pixel) => Math.round(pixel) - half);
      const {data} = view.canvas.getContext("2d").getImageData(left, top, 2 * half + 1, 2 * half + 1);
      let sum = 0;
      for (let k = 0; k < data.length; k += 4) sum += data[k];
      return sum / (data.length / 4);
    };
    const planes = {axial: [0, 1], coronal: [0, 2], sagittal: [1, 2]};
    return Object.entries(planes).flatMap(([view, axes]) => {
      const list = blocks(axes);
      const compared = ({middle, mean}) => ({view, expected: mean, found: shown(view, middle), middle});
      return [list.at(-1), list[0]].map(compared);
    });
  });
}

// --- What has to hold on every page. ---

/** Fails where axe finds something serious or critical. */
export async function assertAccessible(page, where) {
  if (!(await page.evaluate(() => Boolean(window.axe)))) await page.evaluate(packages("axe-core").source);
  const {violations, passes} = await page.evaluate(() => window.axe.run(document, {resultTypes: ["violations"]}));
  assert.ok(passes.length > 5, `${where}: axe looked at nothing`);
  const bad = violations.filter(({impact}) => impact === "serious" || impact === "critical");
  const text = bad.map(({id, nodes}) => `${id}: ${nodes.map((node) => node.html).join(" | ")}`);
  assert.deepEqual(text, [], where);
}

/** Fails where the page is wider than its window. */
export async function assertNoSideways(page, where) {
  const [page_px, window_px] = await page.evaluate(() => [document.documentElement.scrollWidth, window.innerWidth]);
  assert.ok(page_px <= window_px, `${where}: ${page_px} px wide in a window of ${window_px} px`);
}

/** Points of a CSV file with a header line. */
export function readPoints(file) {
  const [, ...lines] = fs.readFileSync(file, "utf8").trim().split("\n");
  return lines.map((line) => line.split(",").map(Number));
}
