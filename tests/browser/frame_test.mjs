// A frame of a colour and depth camera: the mark on it, its cloud, both edges, and programs of both kinds.

import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import {test} from "node:test";
import {
  assertAccessible,
  assertNoSideways,
  chain,
  coverage,
  goTo,
  idle,
  incise,
  openedStudio,
  readPoints,
  replaceIn,
  runCase,
  stateOf,
  temporaryFolder,
  until,
  writePhantom,
} from "./support.mjs";

// Chooses a file of the folder that is listed.
async function choose(page, picker, name) {
  const list = page.locator(`[data-picker=${picker}]`);
  if (!(await list.evaluate((node) => node.open))) await list.locator("summary").click();
  await list.locator(`[data-file='${name}']`).click();
}

const layersOf = (page) => page.evaluate(() => [...window.incise.views.scene.layers.keys()]);

// Accepts every caution in a gate, and waits for what is laid with them.
async function acceptAll(page, gate, key) {
  for (const box of await page.locator(`${gate} .gate input[type=checkbox]`).all()) await box.check();
  await page.click(`${gate} [data-do=accept]`);
  await until(page, (name) => window.incise.state[name].gate.open, key);
  await idle(page);
}

test("the mark on a frame is found, and both programs are laid on the tissue that it shows", async (t) => {
  const folder = temporaryFolder(t),
    inside = writePhantom(folder, "--seed", "3"),
    step = chain(t);
  // A coarse mesh needs more room beside the tumour for a program.
  replaceIn(path.join(inside, "case.yaml"), "lateral_margin_mm: 5", "lateral_margin_mm: 8");
  incise(folder, "bench", "make", "--seed", "3", "-o", "readings", "--truth", "hidden");
  const {page} = await openedStudio(t, folder, "specimen");
  await runCase(page);
  await goTo(page, "register");
  await idle(page);

  await step("a frame is read when its three files are chosen", async () => {
    await page.selectOption("[data-section=cloud] select", "frame");
    assert.equal(await page.isEnabled("[data-do=frame]"), false);
    await page.click("[data-picker=color] [data-file=readings]");
    await idle(page);
    await choose(page, "color", "rgb.png");
    await choose(page, "depth", "depth.png");
    assert.equal(await page.isEnabled("[data-do=frame]"), false);
    await choose(page, "intrinsics", "camera.json");
    await page.click("[data-do=frame]");
    await page.waitForSelector("[data-frame=success]");
    await idle(page);
  });

  await step("the mark and its numbers are shown, and its cloud is the one to register", async () => {
    const written = await stateOf(page, "frame.files");
    const marked = readPoints(path.join(inside, written.find((name) => name.endsWith("contour.csv"))));
    assert.equal((await stateOf(page, "frame.mark_mm")).length, marked.length);
    const length = await stateOf(page, "frame.summary.length_mm");
    assert.equal(await page.textContent("[data-found=length_mm]"), `${length.toFixed(2)} mm`);
    assert.equal(await page.textContent("[data-found=closed_loop]"), "yes");
    await page.waitForSelector(".frame-picture[data-ready=yes]");
    assert.equal(await stateOf(page, "cloud.file.name"), "frame_rgb/tissue.ply");
    assert.equal(await stateOf(page, "cloud.frame"), "camera");
    await page.click("[data-do=enlarge]");
    await assertAccessible(page, "the large picture");
    await page.keyboard.press("Escape");
    assert.equal(await page.locator("dialog[open]").count(), 0);
    await assertAccessible(page, "frame");
  });

  await step("a change after it was read is said, and it can be read again", async () => {
    const about = page.locator("[data-frame] .warning");
    assert.equal(await about.count(), 0);
    await page.check("[data-section=cloud] .check:has-text('two ends') input");
    assert.ok((await about.first().innerText()).includes("changed"));
    await page.uncheck("[data-section=cloud] .check:has-text('two ends') input");
    assert.equal(await about.count(), 0);
    const first = await stateOf(page, "frame.summary");
    await page.click("[data-do=frame]");
    await idle(page);
    assert.equal(await page.locator("[data-problem]").count(), 0);
    assert.deepEqual(await stateOf(page, "frame.summary"), first);
  });

  await step("both edges are drawn, with how far they are apart", async () => {
    await page.click("[data-do=register]");
    await page.waitForSelector("[data-register=converged]");
    await idle(page);
    const {mean_mm: mean, greatest_mm: greatest} = await stateOf(page, "register.edges");
    assert.ok(mean > 0 && greatest >= mean);
    assert.equal(await page.textContent("[data-edge=mean]"), `${mean.toFixed(2)} mm`);
    assert.equal(await page.textContent("[data-edge=greatest]"), `${greatest.toFixed(2)} mm`);
    const layers = await layersOf(page);
    assert.ok(layers.includes("edge") && layers.includes("marked"), layers.join());
    // Where the page draws them they are as far apart as the library says.
    const drawn = await page.evaluate(() => {
      const middle = (name) => {
        const box = {low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity]};
        for (const {geometry} of window.incise.views.scene.layers.get(name).objects) {
          geometry.computeBoundingBox();
          const {min, max} = geometry.boundingBox;
          [min.x, min.y, min.z].forEach((value, k) => (box.low[k] = Math.min(box.low[k], value)));
          [max.x, max.y, max.z].forEach((value, k) => (box.high[k] = Math.max(box.high[k], value)));
        }
        return box.low.map((value, k) => 0.5 * (value + box.high[k]));
      };
      const [edge, marked] = [middle("edge"), middle("marked")];
      return Math.hypot(...edge.map((value, k) => value - marked[k]));
    });
    assert.ok(drawn < 1.5 * greatest, `${drawn} mm between the middles`);
  });

  await step("nothing is laid before it is known where the camera is", async () => {
    assert.equal(await page.isEnabled("[data-do=lay]"), false);
    assert.equal(await page.isEnabled("[data-do=lay-mark]"), false);
    await choose(page, "camera", "camera.json");
    await page.click("[data-do=lay-mark]");
    await page.waitForSelector("[data-marked]");
    await idle(page);
    assert.equal(await stateOf(page, "mark.follows"), "edge");
    assert.equal(await stateOf(page, "lay"), null);
    await page.click("[data-do=lay]");
    await page.waitForSelector("[data-laid]");
    await idle(page);
    assert.equal(await stateOf(page, "lay.follows"), (await stateOf(page, "run.accepted")) ? "corrected" : "planned");
    const laid = JSON.parse(fs.readFileSync(path.join(inside, "mark_on_tissue", "path", "path.json"), "utf8"));
    assert.equal(laid.kind, "mark");
    await assertAccessible(page, "both laid");
  });

  await step("what is accepted of the mark is not accepted of the incision", async () => {
    await goTo(page, "program");
    await idle(page);
    assert.deepEqual(
      await page.locator("[data-program-of]").evaluateAll((all) => all.map((one) => one.dataset.programOf)),
      ["tissue", "mark", "run"],
    );
    const before = await stateOf(page, "lay.gate");
    if (!(await stateOf(page, "mark.gate.open"))) await acceptAll(page, "[data-program-of=mark]", "mark");
    assert.deepEqual(await stateOf(page, "lay.gate"), before);
    assert.deepEqual(await stateOf(page, "acceptLaid"), []);
  });

  await step("the mark's program is saved under its own name, and the arm plays it", async () => {
    const [download] = await Promise.all([
      page.waitForEvent("download"),
      page.click("[data-program-of=mark] [data-do=download]"),
    ]);
    assert.equal(download.suggestedFilename(), "program_mark.script");
    const script = fs.readFileSync(path.join(inside, "mark_on_tissue", "program.script"), "utf8");
    assert.equal(fs.readFileSync(await download.path(), "utf8"), script);
    if (!(await stateOf(page, "lay.gate.open"))) await acceptAll(page, "[data-program-of=tissue]", "lay");
    await until(page, () => window.incise.state.arm);
    await page.selectOption("[data-section=arm] select", "mark");
    await until(page, () => window.incise.state.arm && window.incise.state.armOf === "mark");
    await idle(page);
    const layers = await layersOf(page);
    assert.ok(layers.includes("laid") && layers.includes("arm"), layers.join());
    assert.ok((await coverage(page)).scene > 0.02, "the arm is drawn");
    await assertAccessible(page, "programs");
    await page.setViewportSize({width: 390, height: 844});
    for (const name of ["program", "register"]) {
      await goTo(page, name);
      await idle(page);
      await assertNoSideways(page, name);
    }
    await page.setViewportSize({width: 1400, height: 900});
  });

  await step("a refused registration takes both with it", async () => {
    await page.click("[data-do=refuse]");
    await until(page, () => !window.incise.state.register);
    assert.deepEqual([await stateOf(page, "lay"), await stateOf(page, "mark")], [null, null]);
    assert.equal(await page.locator("[data-laid], [data-marked]").count(), 0);
    assert.ok(!fs.existsSync(path.join(inside, "mark_on_tissue")));
  });
});
