// What if: a result is kept, the case is run with other settings, and both are laid over each other.

import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import {test} from "node:test";
import {
  assertAccessible,
  assertNoSideways,
  chain,
  goTo,
  idle,
  inputIn,
  openedStudio,
  stateOf,
  temporaryFolder,
  type,
  until,
  writeBlock,
} from "./support.mjs";

const kNumbers = ["nearest_to_tumor_mm", "least_depth_mm", "greatest_error_mm", "mean_error_mm"];

// Waits for the run of the settings as they are.
async function ran(page) {
  await until(page, () => {
    const {run, busy, case: open} = window.incise.state;
    return run && run.revision === open.revision && !busy.run;
  });
  await idle(page);
}

function numbersOf(page, which) {
  return stateOf(page, `run.${which}.numbers`);
}

async function keepAndRun(page, label, value) {
  await type(inputIn(page, "what-if", label), value);
  await page.click("[data-do=keep-and-run]");
  await ran(page);
}

const texts = (page, selector) => page.locator(selector).allInnerTexts();

test("results are kept, laid over the next one, and put back", async (t) => {
  const folder = temporaryFolder(t),
    inside = writeBlock(folder),
    step = chain(t);
  writeBlock(folder, "other");
  const {page} = await openedStudio(t, folder, "case");
  await goTo(page, "compare");
  await page.click("[data-do=run]");
  await ran(page);
  const first = await stateOf(page, "case.settings"),
    firstNumbers = await numbersOf(page, "as_planned");

  await step("a value has the label that it has in its own step", async () => {
    const labels = await page.locator("[data-section=what-if] .grid label").allTextContents(),
      others = [];
    for (const name of ["plan", "hold"]) {
      await goTo(page, name);
      await idle(page);
      others.push(...(await page.locator(".panel label").allTextContents()));
    }
    assert.ok(labels.length > 4, `${labels}`);
    for (const label of labels) assert.ok(others.includes(label), `${label} in ${others}`);
    await goTo(page, "compare");
  });

  await step("nothing is kept before a value was changed", async () => {
    assert.equal(await page.isEnabled("[data-do=keep-and-run]"), false);
    assert.ok((await page.textContent("[data-why]")).includes("Change a value"));
    assert.equal(await page.locator("[data-section=numbers] [data-columns]").count(), 0);
  });

  await step("as planned and corrected are drawn with one scale", async () => {
    await page.waitForSelector("[data-contours=after] [data-ready=yes]");
    const scales = await page.locator(".contour-host").evaluateAll((hosts) => hosts.map((host) => host.dataset.scale));
    assert.equal(scales.length, 2);
    assert.equal(scales[0], scales[1]);
    assert.ok(Number(scales[0]) > 0);
  });

  await step("a run under way shows what it does, and can be stopped", async () => {
    await type(inputIn(page, "what-if", "Simulated speed"), 6);
    await page.click("[data-do=keep-and-run]");
    await page.waitForSelector("[data-running=yes] [role=status]");
    const [request] = await Promise.all([page.waitForRequest("**/api/call/stop"), page.click("[data-do=stop]")]);
    assert.deepEqual(request.postDataJSON(), {call: "run"});
    await page.waitForSelector("[data-running=yes]", {state: "detached"});
    await idle(page);
    assert.equal(await page.locator("[data-kept]").count(), 1, "what was kept stays");
    await page.click("[data-section=what-if] [data-do=run]");
    await ran(page);
  });

  await step("the kept result has its own settings and numbers, beside those that are shown", async () => {
    const title = `A: simulated speed ${first.cut.speed_mm_s} mm/s`;
    assert.ok((await page.textContent("[data-kept=A]")).includes(title));
    const columns = await texts(page, "[data-column]");
    assert.equal(columns.length, 2);
    assert.ok(columns[0].includes("simulated speed 6 mm/s"), columns[0]);
    assert.ok(columns[1].includes(`simulated speed ${first.cut.speed_mm_s} mm/s`), columns[1]);
    const shown = await numbersOf(page, "as_planned");
    assert.notDeepEqual(shown, firstNumbers);
    for (const key of kNumbers) {
      const cells = await texts(page, `[data-of=as_planned][data-number=${key}] td`);
      const expected = [shown, firstNumbers].map((numbers) => numbers[key].toFixed(2).replace("-", "−"));
      assert.deepEqual(cells, expected, key);
    }
    for (const id of ["before", "after"]) {
      assert.ok((await texts(page, `[data-contours=${id}] .key`)).join().includes(title), id);
    }
    for (const id of ["errors", "depths"]) {
      const spoken = await page.getAttribute(`[data-plot=${id}] .plot-host`, "aria-label");
      assert.ok(spoken.includes(title), spoken);
    }
    const layers = await page.evaluate(() => [...window.incise.views.scene.layers.values()].map(({label}) => label));
    assert.ok(layers.includes(title), layers.join());
    await assertAccessible(page, "what if");
    await page.emulateMedia({colorScheme: "dark"});
    await assertAccessible(page, "what if, dark");
    await page.emulateMedia({colorScheme: "light"});
  });

  await step("the settings are put back, and the result with them", async () => {
    await page.click("[data-kept=A] [data-do=put-back]");
    await idle(page);
    assert.deepEqual(await stateOf(page, "case.settings.cut"), first.cut);
    assert.ok(fs.readFileSync(path.join(inside, "case.yaml"), "utf8").includes(`speed_mm_s: ${first.cut.speed_mm_s}`));
    await page.click("[data-section=what-if] [data-do=run]");
    await ran(page);
    assert.deepEqual(await numbersOf(page, "as_planned"), firstNumbers);
    assert.ok((await page.textContent("[data-kept=A]")).includes("that is shown"));
    assert.equal(await page.locator("[data-column]").count(), 0, "it is not laid over itself");
  });

  await step("four results are kept at most", async () => {
    await page.click("[data-kept=A] [data-do=drop-kept]");
    assert.equal(await page.locator("[data-kept]").count(), 0);
    for (const power of [36, 37, 38, 39]) await keepAndRun(page, "Power", power);
    assert.deepEqual(await page.locator("[data-kept]").evaluateAll((all) => all.map((one) => one.dataset.kept)), [
      ..."ABCD",
    ]);
    await type(inputIn(page, "what-if", "Power"), 40);
    await idle(page);
    assert.equal(await page.isEnabled("[data-do=keep-and-run]"), false);
    assert.ok((await page.textContent("[data-why]")).includes("at a time"));
    await page.click("[data-kept=B] [data-do=drop-kept]");
    await page.click("[data-do=keep-and-run]");
    await ran(page);
    assert.ok((await page.textContent("[data-kept=B]")).includes("power 39 W"), "the letter that was free");
    await page.setViewportSize({width: 390, height: 844});
    await assertNoSideways(page, "what if");
    await page.setViewportSize({width: 1400, height: 900});
  });

  await step("a kept result does not outlive its tissue", async () => {
    await goTo(page, "open");
    await page.click("[data-file=other]");
    await until(page, () => window.incise.state.case.file.includes("other"));
    await idle(page);
    assert.deepEqual(await stateOf(page, "kept"), []);
    await goTo(page, "compare");
    await page.click("[data-do=run]");
    await ran(page);
    assert.ok((await page.textContent("[data-section=what-if]")).includes("4 kept results were of another case"));
  });

  const overtaken = /^answer 404: \/api\/blob\//; // a moment of the cut after which a newer one has come
  assert.deepEqual(page.complaints.filter((text) => !overtaken.test(text)), []);
});
