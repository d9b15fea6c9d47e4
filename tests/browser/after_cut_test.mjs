// After the cut: the photograph and its measures, and a cloud on which the path is laid. The arm: gate_test.mjs.

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
  inputIn,
  openedStudio,
  runCase,
  stateOf,
  temporaryFolder,
  type,
  until,
  writePhantom,
  writePhotograph,
} from "./support.mjs";

const kScale = 0.06; // mm per pixel
const kRadii = [6, 10]; // mm: of the tumour's edge, and of the cut's inner edge

test("a cut that was made is measured, and one to be made is laid on a cloud", async (t) => {
  const inside = writePhantom(temporaryFolder(t), "--seed", "3"),
    step = chain(t);
  writePhotograph(path.join(inside, "cut.png"), kRadii.map((radius) => radius / kScale));
  const {page} = await openedStudio(t, inside, ".");

  await step("the contours of a photograph and their measures are shown", async () => {
    await goTo(page, "photograph");
    await page.click("[data-picker=photo] [data-file='cut.png']");
    await page.waitForSelector("[data-photograph=loaded]");
    await page.selectOption("[data-section=scale] select", "mm_per_pixel");
    await type(inputIn(page, "scale", "One pixel"), String(kScale));
    await page.click("[data-do=measure]");
    await until(page, () => window.incise.state.photograph);
    await idle(page);
    const mean = await stateOf(page, "photograph.evaluation.abs_error_mm.mean");
    assert.ok(Math.abs(mean - 0.5) < 0.05, `${mean}`);
    assert.ok((await page.textContent("[data-measure=mean_error_mm]")).includes(mean.toFixed(2)));
    assert.ok(fs.existsSync(path.join(inside, "photograph_cut", "evaluation.json")));
  });

  await step("a contour that is corrected by hand is said to be", async () => {
    await page.click("[data-line=incision] [data-do=correct]");
    await page.click("[data-do=measure]");
    await until(page, () => window.incise.state.photograph.by_hand.length === 1);
    await idle(page);
    await page.waitForSelector("[data-by-hand]");
    const kept = JSON.parse(fs.readFileSync(path.join(inside, "photograph_cut", "evaluation.json"), "utf8"));
    assert.deepEqual(kept.by_hand, ["incision"]);
    assert.ok((await page.textContent("[data-by-hand]")).includes("Found automatically: the tumour's edge"));
    await assertAccessible(page, "photograph");
  });

  await step("of two contours that were drawn by hand it is said that nothing was found", async () => {
    await page.click("[data-line=tumor_edge] [data-do=correct]");
    await page.click("[data-do=measure]");
    await until(page, () => window.incise.state.photograph.by_hand.length === 2);
    await idle(page);
    assert.ok((await page.textContent("[data-by-hand]")).includes("Nothing was found automatically"));
    assert.equal(await page.locator("[data-section=photo-result] .verdict:has-text('this measurement')").count(), 0);
  });

  await step("a cloud for practice is registered, and is called made up wherever it is shown", async () => {
    await goTo(page, "register");
    await idle(page);
    await page.click("summary:has-text('Make a virtual cloud')");
    await page.click("[data-do=virtual-cloud]");
    await until(page, () => window.incise.state.cloud.file);
    await page.click("[data-do=register]");
    await page.waitForSelector("[data-register=converged]");
    await idle(page);
    assert.ok((await page.locator("[data-virtual=yes]").count()) >= 2);
    assert.ok((await coverage(page)).scene > 0.02, "the cloud is drawn");
    assert.ok(Number(await page.getAttribute(".residual-scale", "data-top")) > 0);
    assert.equal(await page.locator("[data-edges]").count(), 0, "no edge is marked on a cloud without colours");
    await assertAccessible(page, "register");
  });

  await step("the path is laid on it, with the verdict that lets a program through or not", async () => {
    assert.equal(await page.isEnabled("[data-do=lay]"), false, "nothing was run yet");
    await runCase(page);
    await goTo(page, "register");
    await idle(page);
    if (!(await stateOf(page, "register"))) {
      await page.click("[data-do=register]");
      await page.waitForSelector("[data-register=converged]");
    }
    await page.click("[data-do=lay]");
    await until(page, () => window.incise.state.lay);
    await idle(page);
    const gate = await stateOf(page, "lay.gate");
    assert.equal(await page.locator("[data-laid=program]").count(), gate.open ? 1 : 0);
    const laid = JSON.parse(fs.readFileSync(path.join(inside, "on_tissue", "path", "path.json"), "utf8"));
    assert.deepEqual([laid.frame, laid.specimen_is], ["robot", "virtual"]);
    assert.equal(fs.existsSync(path.join(inside, "on_tissue", "program.script")), gate.open);
  });

  await step("the edge is laid on it for a mark, beside the incision", async () => {
    const before = await stateOf(page, "lay");
    await page.click("[data-do=lay-mark]");
    await until(page, () => window.incise.state.mark);
    await idle(page);
    assert.deepEqual(await stateOf(page, "lay"), before);
    assert.ok((await page.textContent("[data-marked]")).includes("to be marked"));
    await goTo(page, "program");
    await idle(page);
    assert.equal(await page.locator("[data-program-of]").count(), 3);
  });

  await step("a command that registered an earlier case is no longer there to be repeated", async () => {
    const commands = page.locator("[data-section=repeat] pre");
    assert.match(await commands.textContent(), /incise register/);
    await goTo(page, "plan");
    await idle(page);
    await type(inputIn(page, "plan", "Power"), 34);
    await until(page, () => window.incise.state.case.settings.plan.power_w === 34);
    await goTo(page, "program");
    await idle(page);
    assert.doesNotMatch(await commands.textContent(), /incise register/);
    assert.match(await commands.textContent(), /incise evaluate/, "the photograph is as it was");
  });

  await step("on a phone nothing has to be pushed sideways", async () => {
    await page.setViewportSize({width: 390, height: 844});
    for (const name of ["photograph", "register", "program"]) {
      await goTo(page, name);
      await idle(page);
      await assertNoSideways(page, name);
    }
  });
});
