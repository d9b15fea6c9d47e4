// The demo specimen through all the steps of the page, in one sitting: what is shown, stored, computed and offered.

import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import {test} from "node:test";
import {
  assertAccessible,
  assertNoSideways,
  chain,
  clickScene,
  coverage,
  fresh,
  goTo,
  idle,
  inputIn,
  kSteps,
  knownVoxels,
  look,
  openedStudio,
  pixelIn,
  readPoints,
  scenePixel,
  settle,
  silhouette,
  slicePixel,
  stateOf,
  temporaryFolder,
  toScreen,
  type,
  until,
} from "./support.mjs";

const kTets = 6000; // coarse: this is about the page, not about the cut
// The tumour's surface belongs to another edge than the one that is drawn here; no cut keeps such a close margin.
const kChanges = {"meshing.tets": kTets, "tumor.surface": null, "plan.close_margin_mm": 4.4};
const kMiddle = [0, -8]; // mm: of the edge that is drawn, on the back of the tongue
const kRadius = 6;
const kCorners = 9;
const kLargestFile = 100_000; // bytes: of a file in this project

function distance(a, b) {
  return Math.hypot(...a.map((value, k) => value - b[k]));
}

/** Corners of the edge that is drawn, as seen from above. */
function corners(height) {
  return Array.from({length: kCorners}, (_, k) => {
    const angle = (2 * Math.PI * k) / kCorners;
    return [kMiddle[0] + kRadius * Math.cos(angle), kMiddle[1] + kRadius * Math.sin(angle), height];
  });
}

function readStudy(folder) {
  return JSON.parse(fs.readFileSync(path.join(folder, "out", "study.json"), "utf8"));
}

/** What the page writes for a length. */
function mm(value) {
  return `${value.toFixed(2).replace("-", "−")} mm`;
}

/** How many of the four views can be seen in each step: on a wide page, and on a phone. */
const kViews = {
  ...{open: [4, 1], see: [4, 1], edge: [4, 1], hold: [4, 1], plan: [1, 1], run: [1, 1], compare: [1, 1]},
  ...{photograph: [1, 1], register: [1, 1], program: [1, 1]},
};

async function assertViews(page, step, isPhone) {
  const boxes = await Promise.all((await page.locator(".view").all()).map((view) => view.boundingBox()));
  const seen = boxes.filter((box) => box && box.width > 150 && box.height > 150);
  assert.equal(seen.length, kViews[step][isPhone ? 1 : 0], step);
}

/** Notes the progress and the moments that the page shows from now on. */
function watchRun(page) {
  return page.evaluate(() => {
    const seen = {progress: [], moments: [], parts: [], within: [], needle: false};
    const note = (list, value) => value !== undefined && list.at(-1) !== Number(value) && list.push(Number(value));
    window.seenOfRun = seen;
    new MutationObserver(() => {
      const bar = document.querySelector("[data-progress]"),
        moment = document.querySelector("[data-moment]");
      if (bar && bar.dataset.progress) note(seen.progress, bar.dataset.progress);
      if (moment) note(seen.moments, moment.dataset.moment);
      const all = [...document.querySelectorAll("[data-part]")];
      const parts = all.map((part) => `${part.dataset.part}: ${part.textContent}`).join("|");
      if (parts && seen.parts.at(-1) !== parts) seen.parts.push(parts);
      if (bar && bar.dataset.progress) {
        const now = document.querySelector("[data-part=now]").textContent;
        seen.within.push([`${now}: ${bar.querySelector("p").textContent.split(",")[0]}`, Number(bar.dataset.progress)]);
      }
      seen.needle ||= window.incise.views.scene.layers.has("tool");
    }).observe(document.body, {subtree: true, childList: true, attributes: true, characterData: true});
  });
}

/** Fails unless the parts of a run were under way one at a time and in their order.
 *  @param seen  each with its state, divided by | */
function assertParts(seen) {
  const now = seen.map((parts) => parts.split("|").filter((part) => part.startsWith("now: ")));
  assert.ok(now.every((parts) => parts.length === 1), seen.join("\n"));
  const names = now.map(([part]) => /[A-Z][a-z ]*\d?/.exec(part)[0]).filter((name, k, all) => name !== all[k - 1]);
  const passes = Array.from({length: 7}, (_, k) => `Pass ${k + 1}`),
    wanted = ["Preparation", "As planned", "Check of the mesh", ...passes, "Program and report"];
  assert.deepEqual(names, wanted.filter((name) => names.includes(name)), seen.join("\n"));
  assert.ok(names.includes("As planned") && names.includes("Pass 1"), seen.join("\n"));
  assert.match(seen[0], /ahead: . Passes of the correction/);
}

/** Fails where the progress of a part's stage runs back. @param seen  [[part and stage, progress]] in their order */
function assertForwards(seen) {
  const last = new Map();
  for (const [part, progress] of seen) {
    assert.ok(progress >= (last.get(part) || 0), `${part}: ${progress} after ${last.get(part)}`);
    last.set(part, progress);
  }
}

/** The texts of the reasons that are shown, without the page's own names for the settings that they name. */
function shownReasons(page) {
  return page.locator("[data-section=verdict] .reason").evaluateAll((nodes) =>
    nodes.map((node) => {
      const copy = node.cloneNode(true);
      for (const name of copy.querySelectorAll(".field-name")) name.remove();
      return copy.textContent;
    }),
  );
}

/** The ids of a verdict's reasons, as docs/models/verdict.md lists them. */
function documentedReasons() {
  const text = fs.readFileSync(new URL("../../docs/models/verdict.md", import.meta.url), "utf8");
  return [...text.matchAll(/^\| `([a-z_]+)` \| (?:refused|caution) \|/gm)].map(([, id]) => id).sort();
}

/** A place of the specimen in the robot's coordinates. */
function moved(pose, point) {
  return pose.slice(0, 3).map((row) => row[0] * point[0] + row[1] * point[1] + row[2] * point[2] + row[3]);
}

/** Waits until the case holds another place under the robot. @returns it */
async function newPose(page, before) {
  const isOther = (old) => JSON.stringify(window.incise.state.case.settings.robot.T_robot_sim) !== old;
  await until(page, isOther, JSON.stringify(before));
  await fresh(page, "plan");
  return stateOf(page, "case.settings.robot.T_robot_sim");
}

async function shownNumbers(page) {
  const rows = await page.locator(".numbers-table tbody tr").all();
  const pairs = rows.map(async (row) => [
    await row.getAttribute("data-number"),
    await row.locator("td").allTextContents(),
  ]);
  return Object.fromEntries(await Promise.all(pairs));
}

function numbersOf(cut) {
  const tooNear = cut.verdict.reasons.filter(({id}) => id === "lateral_margin" || id === "tumor_distance");
  assert.ok(tooNear.length, "the close margin is set so that each cut comes too near");
  return {
    nearest_to_tumor_mm: Math.min(...tooNear.map((reason) => reason.value)),
    least_depth_mm: cut.depth_reached_mm.min,
    greatest_error_mm: cut.abs_error_mm.max,
    mean_error_mm: cut.abs_error_mm.mean,
  };
}

/** Fails unless the page shows a study's verdict, its numbers, and a program only where one was written. */
async function assertShows(page, study) {
  const reasons = await shownReasons(page);
  assert.equal(await page.getAttribute("[data-section=verdict] [data-status]", "data-status"), study.verdict.status);
  assert.equal(reasons.length, study.verdict.reasons.length);
  study.verdict.reasons.forEach(({message}, k) => assert.ok(reasons[k].includes(message), `${reasons[k]} / ${message}`));
  const [before, after] = [numbersOf(study.before), numbersOf(study.after)];
  for (const [key, shown] of Object.entries(await shownNumbers(page))) {
    assert.deepEqual(shown, [mm(before[key]), mm(after[key])], key);
  }
  await goTo(page, "program");
  await idle(page);
  assert.equal(await page.locator("[data-do=download]").count(), study.program.written ? 1 : 0);
  assert.equal(await page.locator("[data-program=none]").count(), study.program.written ? 0 : 1);
  await goTo(page, "compare");
}

test("the demo specimen goes from its CT to two cuts side by side", async (t) => {
  const folder = temporaryFolder(t),
    inside = path.join(folder, "virtual_tongue_1");
  const {studio, page} = await openedStudio(t, folder),
    step = chain(t);
  let study = null;

  await step("without a case the page offers files and the demo, and nothing serious bars anyone from it", async () => {
    await page.waitForSelector(".files", {state: "attached"});
    assert.deepEqual(await page.locator(".steps button:disabled").count(), kSteps.length - 1);
    await assertAccessible(page, "open, no case");
  });

  await step("for every reason that a verdict can have, the page knows what a person can do, and where", async () => {
    const [ways, steps] = await page.evaluate(async () => {
      const {kWaysOut, kStepTitles} = await import("/page/words.js");
      return [kWaysOut, Object.keys(kStepTitles)];
    });
    assert.deepEqual(steps, kSteps);
    assert.deepEqual(Object.keys(ways).sort(), documentedReasons());
    for (const [id, [text, ...where]] of Object.entries(ways)) {
      assert.ok(text.length > 20 && where.length, `${id}: ${text}`);
      for (const name of where) assert.ok(kSteps.includes(name), `${id}: ${name}`);
    }
  });

  await step("the demo specimen is made, and its slices and skin are drawn where they are", async () => {
    await page.click("[data-do=demo]");
    await page.waitForSelector(".page[data-step=see]");
    await until(page, () => window.incise.state.scan);
    await fresh(page, "tissue");
    assert.equal(await page.textContent(".head .badge"), "virtual specimen");
    for (const [view, share] of Object.entries(await coverage(page))) {
      assert.ok(share > 0.05 && share < 0.9, `${view}: ${share}`);
    }
  });

  await step("the list of files shows it, as a case without a size", async () => {
    await goTo(page, "open");
    await page.waitForSelector("[data-file=virtual_tongue_1]");
    assert.equal((await page.textContent("[data-file=virtual_tongue_1] .soft")).trim(), "Case");
    await goTo(page, "see");
    await settle(page, "see");
  });

  await step("an empty input says what is taken, and typing replaces what an input holds", async () => {
    const smoothing = inputIn(page, "surface", "Smoothing");
    assert.equal(await smoothing.getAttribute("placeholder"), "automatic");
    const taken = mm(await stateOf(page, "tissue.summary.smoothing_mm"));
    assert.ok((await page.textContent("[data-section=surface]")).includes(`Automatic: ${taken}`));
    const radius = inputIn(page, "brush", "Radius of the brush");
    await radius.click();
    await page.keyboard.type("3.5");
    assert.equal(await radius.inputValue(), "3.5");
    await page.keyboard.press("Enter");
    await until(page, () => window.incise.state.brush.radius_mm === 3.5);
  });

  await step("the brush is found again as it was left", async () => {
    const take = page.locator("[data-do=brush-take]"),
      ball = page.locator("[data-do=ball]");
    await take.click();
    await goTo(page, "edge");
    assert.equal(await stateOf(page, "placing"), null);
    await goTo(page, "see");
    assert.equal(await take.getAttribute("aria-pressed"), "true");
    assert.match(await ball.textContent(), /Take a ball away/);
    await take.click();
    await goTo(page, "edge");
    await goTo(page, "see");
    assert.match(await ball.textContent(), /Add a ball/);
    await settle(page, "see");
  });

  await step("a slice shows the scan's voxels, with the patient's left on the right", async () => {
    await page.click("button:text-is('All values')");
    await page.fill(".slider:has(label:text-is('Tissue overlay')) input", "0");
    const known = await knownVoxels(page);
    assert.equal(known.length, 6);
    for (const {view, found, expected} of known) {
      assert.ok(Math.abs(found - expected) < 12, `${view}: ${found} for ${expected}`);
    }
    assert.ok(known[0].expected > known[1].expected + 60, "a bright place and a dark one");
    const [at, left, back, up] = await page.evaluate(() => {
      const {views, state} = window.incise,
        [x, y, z] = state.cross;
      return [views.axial.toScreen([x, y, z]), views.axial.toScreen([x + 9, y, z]), views.axial.toScreen([x, y + 9, z]),
        [views.coronal.toScreen([x, y, z]), views.coronal.toScreen([x, y, z + 9])]];
    });
    assert.ok(left[0] > at[0] && back[1] > at[1] && up[1][1] < up[0][1]);
    await page.click("button:text-is('Soft tissue')");
  });

  await step("the tissue lies over the slices, and follows the window", async () => {
    const inTissue = await page.evaluate(() => window.incise.state.cross);
    const beside = inTissue.map((value, k) => value + (k === 0 ? 3 : k === 1 ? 3 : 0)); // off the crosshair's lines
    const bare = await slicePixel(page, "axial", beside);
    assert.equal(bare[0], bare[2], "grey without the overlay");
    await page.fill(".slider:has(label:text-is('Tissue overlay')) input", "0.6");
    const covered = await slicePixel(page, "axial", beside);
    assert.ok(covered[2] > covered[0] + 40, `blue over ${bare}: ${covered}`);
    const before = await stateOf(page, "tissue.summary");
    await type(inputIn(page, "window", "greatest"), 45);
    await until(page, () => window.incise.state.case.settings.ct.window_hu[1] === 45);
    await fresh(page, "tissue");
    const after = await stateOf(page, "tissue.summary");
    assert.ok(after.voxels < 0.9 * before.voxels, `${after.voxels} of ${before.voxels} voxels`);
    const shown = await page.evaluate(() => window.incise.state.tissue.labels.reduce((sum, label) => sum + label, 0));
    assert.equal(shown, after.voxels);
    await type(inputIn(page, "window", "greatest"), 180);
    await until(page, () => window.incise.state.case.settings.ct.window_hu[1] === 180);
    await fresh(page, "tissue");
    assert.deepEqual(await stateOf(page, "tissue.summary"), before);
  });

  await step("a setting that another program changes appears", async () => {
    const revision = await stateOf(page, "case.revision");
    const {status, answer} = await studio.call("change", {revision, set: kChanges});
    assert.equal(status, 200, JSON.stringify(answer));
    await until(page, (tets) => window.incise.state.case.settings.meshing.tets === tets, kTets);
  });

  await step("an edge that is clicked on the skin is stored where it was clicked", async () => {
    await goTo(page, "edge");
    await fresh(page, "tissue");
    await look(page, "Top");
    await page.click("[data-do=draw]");
    for (const corner of corners(0)) await clickScene(page, corner);
    await clickScene(page, [...kMiddle, 0]); // one too many
    assert.equal((await stateOf(page, "edge.points")).length, kCorners + 1);
    await page.keyboard.press("Delete");
    assert.equal((await stateOf(page, "edge.points")).length, kCorners);
    await page.keyboard.press("Enter");
    await until(page, () => window.incise.state.edge.isClosed);
    await page.click("[data-do=save-edge]");
    await until(page, () => window.incise.state.case.inputs["tumor.contour"] === "tumor_edge.csv");
    await idle(page);
    const stored = readPoints(path.join(inside, "tumor_edge.csv"));
    const onScreen = await Promise.all(stored.map((point) => toScreen(page, point)));
    for (const corner of corners(0)) {
      const clicked = await toScreen(page, corner);
      const off = Math.min(...onScreen.map((at) => distance(at, clicked)));
      assert.ok(off < 5, `${off} px from ${clicked}`);
    }
    for (const [x, y] of stored) assert.ok(Math.abs(distance([x, y], kMiddle) - kRadius) < 1, `${x}, ${y}`);
    assert.equal(await stateOf(page, "case.settings.tumor.configuration"), "rest");
  });

  await step("how much margin fits round it is said, and the ring is drawn", async () => {
    const said = page.locator("[data-section=room] [role=status]"),
      legend = () => page.locator(".legend-row label").allTextContents();
    await page.waitForSelector("[data-fits=yes]");
    const {ring, greatest_margin_mm: greatest, on_cut_face: onCut} = await stateOf(page, "room");
    assert.ok(greatest >= 5, `${greatest} mm`);
    const most = greatest < 20 ? "at most" : "at least",
      note = `A lateral margin of ${most} ${greatest} mm fits here.`;
    assert.equal(await said.textContent(), `The margin of 5 mm fits on this skin. ${note}`);
    assert.deepEqual([onCut.length, onCut.includes(1)], [ring.length, false], "the demo's skin is all its own");
    assert.ok((await legend()).includes("margin of 5 mm, before the stretch"), `${await legend()}`);
    const edge = await stateOf(page, "edge.curve"),
      greys = [];
    for (const at of ring.filter((_, k) => k % 6 === 0)) {
      const off = Math.min(...edge.map((point) => distance(point, at)));
      assert.ok(off > 4 && off < 6, `${off} mm from the edge`);
      greys.push(Math.max(...(await scenePixel(page, at)).slice(0, 3)));
    }
    assert.ok(Math.min(...greys) < 90, `black, where the thin line covers a pixel: ${greys}`);

    const set = async (margin) => {
      const revision = await stateOf(page, "case.revision");
      await studio.call("change", {revision, set: {"plan.lateral_margin_mm": margin}});
    };
    await set(40);
    await page.waitForSelector("[data-fits=no]");
    const text = await said.textContent();
    assert.match(text, /The margin of 40 mm does not fit on this skin. A lateral margin of at \w+ [\d.]+ mm fits/);
    assert.ok(text.includes("Draw the edge elsewhere, or set a smaller margin in Plan."), text);
    assert.ok(!(await legend()).some((label) => label.startsWith("margin of")), `${await legend()}`);
    await assertAccessible(page, "edge, with a margin that does not fit");
    await set(5);
    await page.waitForSelector("[data-fits=yes]");
  });

  await step("a point that is dragged goes back with Escape", async () => {
    await page.click("[data-do=draw]");
    const before = await stateOf(page, "edge"),
      [x, y] = await pixelIn(page, "scene", before.points[2]);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 30, y + 10, {steps: 4});
    await until(page, (was) => window.incise.state.edge.points[2][0] !== was, before.points[2][0]);
    await page.keyboard.press("Escape");
    assert.deepEqual(await stateOf(page, "edge"), {...before, selected: 2});
    await page.mouse.up();
    assert.deepEqual(await stateOf(page, "edge"), {...before, selected: 2});
    await page.keyboard.press("Escape"); // ends drawing
    assert.equal(await stateOf(page, "edge.mode"), "look");
  });

  await step("the edge is drawn in its place, on the skin and in the slice", async () => {
    const stored = readPoints(path.join(inside, "tumor_edge.csv"));
    const at = stored[Math.round(stored.length / 8)];
    const [red, green, blue] = await scenePixel(page, at);
    assert.ok(green > red + 80 && green > blue + 20, `3D: ${[red, green, blue]}`);
    await goTo(page, "see");
    const inputs = page.locator("[data-section=picture] .numbers input");
    for (const [k, value] of [at[0] + 6, at[1] + 6, at[2]].entries()) await type(inputs.nth(k), value.toFixed(1));
    await until(page, (z) => Math.abs(window.incise.state.cross[2] - z) < 0.06, at[2]);
    const dot = await slicePixel(page, "axial", at);
    assert.ok(dot[1] > dot[0] + 80 && dot[1] > dot[2] + 20, `slice: ${dot}`);
  });

  await step("what holds the body is coloured before anything runs", async () => {
    await goTo(page, "hold");
    await fresh(page, "body");
    await look(page, "Top");
    assert.ok((await stateOf(page, "body.tets")) < 2 * kTets);
    const places = await page.evaluate(() => {
      const {body} = window.incise.state,
        at = (v) => [...body.skin.vertices.slice(3 * v, 3 * v + 3)];
      const numbers = [...body.held.keys()];
      const topOf = (list) => list.reduce((best, v) => (best < 0 || at(v)[2] > at(best)[2] ? v : best), -1);
      const farthest = (list, sign) =>
        list.reduce((best, v) => (best < 0 || sign * at(v)[1] > sign * at(best)[1] ? v : best), -1);
      const top = (list, sign) => {
        const end = at(farthest(list, sign))[1];
        return topOf(list.filter((v) => Math.abs(at(v)[1] - end) < 6)); // well inside the held end
      };
      const held = (bit) => numbers.filter((v) => body.held[v] & bit);
      const middle = numbers.filter((v) => body.held[v] === 0 && Math.abs(at(v)[0]) < 5);
      return {clamped: at(top(held(1), 1)), pulled: at(top(held(2), -1)), free: at(topOf(middle))};
    });
    const [clamped, pulled, free] = await Promise.all(
      [places.clamped, places.pulled, places.free].map((at) => scenePixel(page, at)),
    );
    assert.ok(clamped[2] > clamped[0] + 40, `clamped, blue: ${clamped}`);
    assert.ok(pulled[0] > pulled[2] + 80, `pulled, orange: ${pulled}`);
    assert.ok(free[0] > free[2] + 15 && free[2] > 0.5 * free[0], `free, pink: ${free}`);
  });

  await step("the stretch moves the skin, and can be scrubbed", async () => {
    await page.click("[data-do=stretch]");
    await fresh(page, "stretch");
    await look(page, "Top");
    const scrub = page.locator(".slider:has(label:text-is('Rest to stretched')) input");
    const boxes = {};
    for (const share of [0, 0.5, 1]) {
      await scrub.fill(String(share));
      await until(page, (value) => window.incise.state.scrub === value, share);
      boxes[share] = await silhouette(page);
    }
    const front = await page.evaluate(() => {
      const least = (vertices) =>
        vertices.reduce((low, value, k) => (k % 3 === 1 ? Math.min(low, value) : low), Infinity);
      const {body, stretch} = window.incise.state;
      return least(body.skin.vertices) - least(stretch.skin.vertices);
    });
    assert.ok(front > 5, `pulled forward by ${front} mm`);
    const pulled = boxes[1].bottom - boxes[0].bottom; // from above, anterior is below
    assert.ok(Math.abs(pulled - front * boxes[0].pixelsPerMm) < 4, `${pulled} px for ${front} mm`);
    const half = boxes[0.5].bottom - boxes[0].bottom;
    assert.ok(Math.abs(half - 0.5 * pulled) < 4, `half way: ${half} of ${pulled} px`);
    const shown = await page.textContent("[data-section=stretch] > p:last-of-type");
    assert.ok(shown.includes(mm(await stateOf(page, "stretch.greatest_mm"))), shown);
  });

  await step("the tumour's edge follows the stretch, and says where it is only known at rest", async () => {
    await fresh(page, "plan");
    const legend = () => page.locator(".legend-row label").allTextContents();
    assert.ok((await legend()).includes("tumour's edge"), `${await legend()}`);
    const edge = await stateOf(page, "plan.edge"),
      [red, green, blue] = await scenePixel(page, edge[Math.round(edge.length / 3)]);
    assert.ok(green > red + 60 && green > blue + 15, `green on the stretched tissue: ${[red, green, blue]}`);
    const scrub = page.locator(".slider:has(label:text-is('Rest to stretched')) input");
    await scrub.fill("0.5");
    await until(page, () => window.incise.state.scrub === 0.5);
    assert.ok((await legend()).includes("tumour's edge, as it was at rest"), `${await legend()}`);
    await scrub.fill("1");
    await until(page, () => window.incise.state.scrub === 1);
  });

  await step("the planned path is drawn round the edge and can be hidden", async () => {
    await goTo(page, "plan");
    await fresh(page, "plan");
    await look(page, "Top");
    const {points, edge} = await page.evaluate(() => {
      const {path: planned, edge: around} = window.incise.state.plan;
      const list = (value) => (Array.isArray(value) ? value : value.points_mm);
      return {points: list(planned), edge: list(around)};
    });
    const margin = await stateOf(page, "case.settings.plan.lateral_margin_mm"),
      greatest = await stateOf(page, "plan.greatest_margin_mm");
    assert.ok(greatest >= margin, `${greatest} mm`);
    const said = await page.textContent("[data-section=planned]");
    assert.ok(said.includes(await stateOf(page, "plan.margin_note")), said);
    for (const point of points) {
      const off = Math.min(...edge.map((at) => Math.hypot(at[0] - point[0], at[1] - point[1])));
      assert.ok(off > 0.7 * margin && off < 1.3 * margin, `${off} mm from the edge`);
    }
    const at = points[Math.round(points.length / 3)];
    const shown = await scenePixel(page, at);
    assert.ok(Math.max(...shown.slice(0, 3)) < 90, `black: ${shown}`);
    await page.uncheck(".legend label:has-text('planned path') input");
    const hidden = await scenePixel(page, at);
    assert.ok(hidden[0] > shown[0] + 50, `tissue: ${hidden}`);
    await page.check(".legend label:has-text('planned path') input");
  });

  await step("the place under the robot is a place and a turn; a matrix for what they cannot say", async () => {
    const first = await stateOf(page, "case.settings.robot.T_robot_sim"),
      edge = await stateOf(page, "plan.edge"),
      middle = [0, 1, 2].map((k) => edge.reduce((sum, point) => sum + point[k], 0) / edge.length);
    const legend = "Middle of the tumour's edge, mm",
      at = page.locator(`[data-section=robot] fieldset:has(> legend:text-is("${legend}")) input`);
    for (const [k, value] of moved(first, middle).entries()) {
      assert.ok(Math.abs(Number(await at.nth(k).inputValue()) - value) < 0.01, `${k}: ${value}`);
    }
    await type(at.nth(0), 512);
    let pose = await newPose(page, first);
    assert.ok(distance(moved(pose, middle), moved(first, middle).with(0, 512)) < 0.01, `${moved(pose, middle)}`);
    await type(inputIn(page, "robot", "Turn about the vertical"), 30);
    pose = await newPose(page, pose);
    assert.ok(distance(moved(pose, middle), moved(first, middle).with(0, 512)) < 0.01, "it turns about the middle");
    assert.ok(Math.abs(pose[0][0] - Math.cos(Math.PI / 6)) < 1e-9 && Math.abs(pose[1][0] - 0.5) < 1e-9, `${pose}`);

    const lowest = (of) =>
      page.evaluate((rows) => {
        const {vertices} = window.incise.state.stretch.skin;
        const [a, b, c, d] = rows[2],
          height = (i) => a * vertices[i] + b * vertices[i + 1] + c * vertices[i + 2] + d;
        return vertices.reduce((low, _, i) => (i % 3 ? low : Math.min(low, height(i))), Infinity);
      }, of);
    const shown = async () => Number(await page.getAttribute("[data-height]", "data-height"));
    assert.ok(Math.abs((await shown()) - (await lowest(pose))) < 0.01);
    assert.match(await page.textContent("[data-height]"), /above the table.*has to hold it/);
    await page.click("[data-do=set-down]");
    pose = await newPose(page, pose);
    assert.ok(Math.abs(await lowest(pose)) < 0.01 && Math.abs(await shown()) < 0.01);
    assert.match(await page.textContent("[data-height]"), /lies on the table/);
    await type(at.nth(2), 1);
    pose = await newPose(page, pose);
    assert.match(await page.textContent("[data-height]"), /below the table.*raise z/);

    const tilted = [[1, 0, 0, 600], [0, 0.8, -0.6, 0], [0, 0.6, 0.8, 300], [0, 0, 0, 1]];
    const set = async (value) => {
      const revision = await stateOf(page, "case.revision");
      const {status} = await studio.call("change", {revision, set: {"robot.T_robot_sim": value}});
      assert.equal(status, 200);
    };
    await set(tilted);
    await newPose(page, pose);
    await page.waitForSelector("[data-place=tilted]");
    assert.equal(await at.count(), 0);
    assert.equal(await page.locator("[data-matrix] input:visible").count(), 16);
    await assertAccessible(page, "a tilted specimen");
    await set(first);
    await newPose(page, tilted);
    await page.waitForSelector("[data-place=upright]");
  });

  await step("a setting that is refused says so beside its input and is not kept", async () => {
    const deep = inputIn(page, "plan", "Depth"),
      before = await stateOf(page, "case");
    await type(deep, -1);
    await page.waitForSelector("[data-section=plan] .problem");
    assert.equal(await deep.getAttribute("aria-invalid"), "true");
    assert.deepEqual(await stateOf(page, "case"), before);
    await assertAccessible(page, "plan, with a refused setting");
    await type(deep, 4);
    await until(page, () => window.incise.state.case.settings.plan.depth_mm === 4);
    await fresh(page, "plan");
    assert.equal(await page.locator("[data-section=plan] .problem").count(), 0);
    const refused = page.complaints.splice(0);
    assert.deepEqual(refused.map((text) => /^answer 422: .api.call.change$/.test(text)), [true], refused.join("\n"));
  });

  await step("a run shows its progress, the needle and its end", async () => {
    await goTo(page, "run");
    await watchRun(page);
    await page.click("[data-do=run]");
    await page.waitForSelector("[data-progress] progress");
    await assertAccessible(page, "run, under way");
    await page.waitForSelector(".page[data-step=compare]");
    await settle(page, "compare");
    const {progress, moments, parts, within, needle} = await page.evaluate(() => window.seenOfRun);
    assert.ok(progress.length > 2 && Math.min(...progress) >= 0 && Math.max(...progress) <= 1, `progress: ${progress}`);
    // A page skips moments that arrive while it loads one: a busy machine shows fewer.
    assert.ok(moments.length > 0 && needle, `moments: ${moments}`);
    assertParts(parts);
    assertForwards(within);
    // The same message is there once, with its number.
    await goTo(page, "run");
    const ofRun = (await stateOf(page, "messages")).filter(({call}) => call === "run"),
      said = ofRun.map(({severity, text}) => `${severity} ${text}`),
      counts = await page.locator(".messages [data-count]").evaluateAll((all) => all.map((one) => one.dataset.count));
    assert.equal(await page.locator(".messages li").count(), new Set(said).size);
    assert.ok(counts.length > 0 && counts.every((count) => Number(count) > 1), `${counts}`);
    await goTo(page, "compare");
    await settle(page, "compare");
  });

  await step("verdict, reasons, numbers and program are those of the study", async () => {
    study = readStudy(inside);
    await assertShows(page, study);
    const ended = await page.textContent("[data-ended]");
    assert.ok(ended.startsWith("The ") && ended === (await stateOf(page, "run.ended")), ended);
    for (const id of ["before", "after"]) await page.waitForSelector(`[data-contours=${id}] [data-ready=yes]`);
    for (const id of ["errors", "depths"]) await page.waitForSelector(`[data-plot=${id}] canvas`);
  });

  await step("a reason that has a place moves the view there", async () => {
    const placed = study.verdict.reasons.filter(({at}) => at && at.position_mm);
    assert.ok(placed.length > 0, "a margin that is not kept has its place");
    assert.equal(await page.locator("[data-section=verdict] button.reason").count(), placed.length);
    await page.click("[data-section=verdict] button.reason >> nth=0");
    const place = placed[0].at.position_mm;
    const [target, at, size] = await page.evaluate((point) => {
      const {scene} = window.incise.views;
      scene.draw();
      return [scene.target.toArray(), scene.toScreen(point), [scene.host.clientWidth, scene.host.clientHeight]];
    }, place);
    assert.ok(distance(target, place) < 1e-6);
    assert.ok(Math.abs(at[0] - size[0] / 2) < 2 && Math.abs(at[1] - size[1] / 2) < 2, `${at} in ${size}`);
  });

  await step("after a reload the case is as it was, and its result comes from the cache", async () => {
    const before = await stateOf(page, "case"),
      plan = await stateOf(page, "plan.path");
    await page.reload();
    await page.waitForSelector(".page[data-step=see]");
    await fresh(page, "tissue");
    assert.deepEqual(await stateOf(page, "case"), before);
    await goTo(page, "compare");
    await fresh(page, "plan");
    assert.deepEqual(await stateOf(page, "plan.path"), plan);
    await page.click(".panel [data-do=run]");
    await page.waitForSelector("[data-run]");
    await idle(page);
    const again = readStudy(inside);
    assert.deepEqual(new Set(again.stages.map((stage) => stage.state).filter((state) => state === "done")), new Set());
    assert.deepEqual([again.verdict, again.before.abs_error_mm], [study.verdict, study.before.abs_error_mm]);
    await assertShows(page, again);
  });

  for (const scheme of ["light", "dark"]) {
    await step(`every step shows its views, and nothing serious bars anyone from it, ${scheme}`, async () => {
      await page.emulateMedia({colorScheme: scheme});
      for (const name of kSteps) {
        await goTo(page, name);
        await settle(page, name);
        await takePicture(page, `${scheme}_${name}`);
        await assertViews(page, name, false);
        await assertAccessible(page, `${name}, ${scheme}`);
      }
    });
  }

  await step("on a phone every step shows a view, and none has to be moved sideways", async () => {
    await page.emulateMedia({colorScheme: "light"});
    await page.setViewportSize({width: 390, height: 844});
    for (const name of kSteps) {
      await goTo(page, name);
      await settle(page, name);
      await takePicture(page, `phone_${name}`);
      await assertViews(page, name, true);
      await assertNoSideways(page, name);
      await assertAccessible(page, `${name}, on a phone`);
    }
  });

  await step("the picture for the README", async (inner) => {
    if (!process.env.INCISE_PICTURES) return inner.skip("INCISE_PICTURES names no folder");
    await page.setViewportSize({width: 1400, height: 900});
    await goTo(page, "plan");
    await settle(page, "plan");
    await look(page, "Oblique");
    const file = path.join(process.env.INCISE_PICTURES, "studio.jpg");
    await page.screenshot({path: file, type: "jpeg", quality: 75});
    assert.ok(fs.statSync(file).size < kLargestFile, `${fs.statSync(file).size} bytes`);
    return undefined;
  });

  await step("nothing was complained of", async () => {
    assert.deepEqual(page.complaints, []);
    assert.equal(await page.evaluate(() => document.documentElement.dataset.scriptError), undefined);
  });
});

/** A picture of the whole page for a person to look at, where INCISE_PICTURES names a folder. */
async function takePicture(page, name) {
  if (!process.env.INCISE_PICTURES) return;
  await page.screenshot({path: path.join(process.env.INCISE_PICTURES, `demo_${name}.png`), fullPage: true});
}
