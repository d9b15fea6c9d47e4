// Opening, seeing and planning with the keyboard alone: everything is reached with Tab, and its focus can be seen.

import assert from "node:assert/strict";
import path from "node:path";
import {test} from "node:test";
import {
  chain,
  fresh,
  idle,
  openedStudio,
  readPoints,
  stateOf,
  temporaryFolder,
  until,
  watchCalls,
  writePhantom,
} from "./support.mjs";

const kMostTabs = 250;
const kSteps = 5; // mm: of an arrow key

/** Presses Tab until the focus is on what a selector names. @returns how often */
async function tabTo(page, selector) {
  for (let count = 1; count <= kMostTabs; ++count) {
    await page.keyboard.press("Tab");
    const at = await page.evaluate((wanted) => {
      const node = document.activeElement,
        style = getComputedStyle(node);
      const outline = style.outlineStyle === "none" ? 0 : parseFloat(style.outlineWidth);
      return {isThere: node.matches(wanted), outline};
    }, selector);
    if (!at.isThere) continue;
    assert.ok(at.outline >= 1, `the focus on ${selector} cannot be seen`);
    return count;
  }
  throw new Error(`${selector} is not reached by ${kMostTabs} Tabs`);
}

async function pressOn(page, selector, key = "Enter") {
  await tabTo(page, selector);
  await page.keyboard.press(key);
}

async function typeInto(page, selector, value) {
  await tabTo(page, selector);
  await page.keyboard.press("Control+A");
  await page.keyboard.type(String(value));
  await page.keyboard.press("Enter");
}

/** The selector of an input by its label, marked so that CSS finds it. */
async function mark(page, section, label) {
  const name = `${section}-${label}`.replaceAll(" ", "-");
  await page.evaluate(
    ([inside, text, to]) => {
      const labels = [...document.querySelectorAll(`[data-section=${inside}] label`)];
      document.getElementById(labels.find((one) => one.textContent === text).htmlFor).dataset.marked = to;
    },
    [section, label, name],
  );
  return `[data-marked="${name}"]`;
}

async function step(page, name) {
  await pressOn(page, `[data-go=${name}]`);
  await page.waitForSelector(`.page[data-step=${name}]`);
}

test("opening, seeing and planning by keyboard alone", async (t) => {
  const folder = temporaryFolder(t);
  writePhantom(folder, "--format", "nrrd");
  const {page} = await openedStudio(t, folder),
    then = chain(t);

  await then("a case is opened from the list of files", async () => {
    await page.waitForSelector("button.file");
    await pressOn(page, "button.file");
    await page.waitForSelector(".page[data-step=see]");
    const focus = await page.evaluate(() => document.activeElement.tagName);
    assert.equal(focus, "H2", "the new step's heading has the focus");
    await until(page, () => window.incise.state.scan);
    await fresh(page, "tissue");
  });

  await then("the crosshair moves by the arrow keys, and the slice by Page Up", async () => {
    const before = await stateOf(page, "cross"),
      {spacing_mm: voxel} = await stateOf(page, "scan.grid");
    await tabTo(page, "[data-view=axial] canvas");
    const keys = ["ArrowRight", "ArrowRight", "ArrowDown", "PageUp", "Shift+ArrowLeft"];
    for (const key of keys) await page.keyboard.press(key);
    const moved = (await stateOf(page, "cross")).map((value, k) => (value - before[k]) / voxel[k]);
    [-3, 1, 1].forEach((voxels, k) => assert.ok(Math.abs(moved[k] - voxels) < 1e-6, `${moved}`));
  });

  await then("the seed is set at the crosshair, and the window by its numbers", async () => {
    await pressOn(page, "[data-section=seed] button:nth-of-type(2)");
    await until(page, () => window.incise.state.case.settings.ct.seed_mm);
    const [seed, cross] = [await stateOf(page, "case.settings.ct.seed_mm"), await stateOf(page, "cross")];
    seed.forEach((value, k) => assert.ok(Math.abs(value - cross[k]) <= 0.051));
    await typeInto(page, await mark(page, "window", "greatest"), 175);
    await until(page, () => window.incise.state.case.settings.ct.window_hu[1] === 175);
    await fresh(page, "tissue");
  });

  await then("a corner of the region box that is stepped by keys is written once, and undone in one step", async () => {
    await pressOn(page, "[data-do=box]");
    await until(page, () => window.incise.state.case.settings.ct.roi_box_mm);
    await fresh(page, "tissue");
    const x = () => stateOf(page, "case.settings.ct.roi_box_mm.0.0"),
      isAt = (wanted) => until(page, (low) => window.incise.state.case.settings.ct.roi_box_mm[0][0] === low, wanted),
      before = await x(),
      low = await mark(page, "box", "x");
    await tabTo(page, low);
    await page.clock.install();
    await page.clock.pauseAt(Date.now() + 60_000); // until the test lets it go on, however long the keys take
    const calls = watchCalls(page);
    const stepped = async () => {
      for (let k = 0; k < kSteps; ++k) await page.keyboard.press("ArrowUp");
      assert.equal(Number(await page.inputValue(low)), before + kSteps);
      assert.equal(await x(), before);
    };
    await stepped();
    await pressOn(page, "[data-section=box] [data-do=undo]"); // before they are sent
    assert.equal(Number(await page.inputValue(low)), before);
    await tabTo(page, low);
    await stepped();
    assert.deepEqual(await stateOf(page, "history.future"), [], "there is nothing to redo");
    await page.clock.resume();
    await isAt(before + kSteps);
    await fresh(page, "tissue");
    assert.deepEqual(calls, ["change", "tissue"]);
    await pressOn(page, "[data-section=box] [data-do=undo]");
    await isAt(before);
    await pressOn(page, "[data-section=box] [data-do=undo]");
    await until(page, () => !window.incise.state.case.settings.ct.roi_box_mm);
    await fresh(page, "tissue");
  });

  await then("the 3D view turns by the arrow keys", async () => {
    const before = await page.evaluate(() => window.incise.views.scene.azimuth);
    await pressOn(page, "[data-view=scene] canvas", "ArrowLeft");
    assert.notEqual(await page.evaluate(() => window.incise.views.scene.azimuth), before);
  });

  await then("an edge is laid on the skin and stored", async () => {
    await step(page, "edge");
    await fresh(page, "tissue");
    await typeInto(page, await mark(page, "ellipse", "first"), 12);
    await pressOn(page, "[data-do=drop]");
    await until(page, () => window.incise.state.edge.isClosed);
    await pressOn(page, "[data-do=save-edge]");
    await until(page, () => window.incise.state.case.inputs["tumor.contour"] === "tumor_edge.csv");
    await idle(page);
    const surface = await stateOf(page, "case.inputs"),
      said = await page.textContent("[data-section=keep] .warning");
    assert.ok(said.includes(`names a tumour surface, ${surface["tumor.surface"]}:`), said);
    await pressOn(page, "[data-do=remove-surface]");
    await until(page, () => window.incise.state.case.inputs["tumor.surface"] === null);
    assert.equal(await page.locator("[data-do=remove-surface]").count(), 0);
    const x = readPoints(path.join(folder, "specimen", "tumor_edge.csv")).map((point) => point[0]);
    assert.ok(Math.abs(Math.max(...x) - Math.min(...x) - 12) < 1, "12 mm wide");
  });

  await then("the mesh is stretched and a path planned", async () => {
    await step(page, "hold");
    await fresh(page, "body");
    await pressOn(page, "[data-do=stretch]");
    await fresh(page, "stretch");
    await step(page, "plan");
    await fresh(page, "plan");
    await typeInto(page, await mark(page, "plan", "Depth"), 4);
    await until(page, () => window.incise.state.case.settings.plan.depth_mm === 4);
    await fresh(page, "plan");
    const depths = await stateOf(page, "plan.path.depth_mm");
    assert.deepEqual([...new Set(depths.map((depth) => depth.toFixed(6)))], ["4.000000"]);
  });

  await then("without a complaint", async () => {
    await idle(page);
    assert.deepEqual(page.complaints, []);
  });
});
