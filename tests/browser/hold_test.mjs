// Constraints are added one after the other: what they lack meanwhile is said in a normal tone, and the last body stays.

import assert from "node:assert/strict";
import {test} from "node:test";
import {Studio, chain, fresh, goTo, idle, newPage, openStudio, startBrowser, stateOf, temporaryFolder, type, until, writeBlock} from "./support.mjs";

const kColoured = 8; // constraints

function settingOf(page) {
  return stateOf(page, "case.settings.specimen.constraints");
}

async function add(page, kind) {
  const before = (await settingOf(page)) || [];
  await page.click(`button:text-is("Add ${kind}")`);
  await until(page, (count) => (window.incise.state.case.settings.specimen.constraints || []).length > count, before.length);
  await idle(page);
}

test("constraints that do not hold the body yet are no failure", async (t) => {
  const folder = temporaryFolder(t);
  writeBlock(folder);
  const studio = await Studio.start(t, folder, "case"),
    page = await newPage(await startBrowser(t)),
    step = chain(t),
    shown = page.locator("[data-section=constraints]"),
    missing = page.locator("[data-missing]");

  await step("what is still needed is said, and the body is shown as it was held last", async () => {
    await openStudio(page, studio);
    await until(page, () => window.incise.state.case);
    await goTo(page, "hold");
    await fresh(page, "body");
    page.complaints.splice(0); // of the scan and the tissue that a block does not have
    const before = await stateOf(page, "body.constraints");
    await add(page, "support");
    await missing.waitFor();
    const text = await missing.textContent();
    assert.match(text, /Still needed: .* stop all six/);
    assert.match(text, /as it was held last/);
    assert.equal(await shown.locator(".problem").count(), 0);
    assert.deepEqual(await stateOf(page, "body.constraints"), before);
    assert.ok(await page.evaluate(() => window.incise.views.scene.layers.has("body")));
    assert.deepEqual(page.complaints.splice(0), ["answer 422: /api/call/body"]);
  });

  await step("without its last constraint the body is held by the default again", async () => {
    await page.click("[aria-label^='Remove constraint 1']");
    await until(page, () => !window.incise.state.case.settings.specimen.constraints);
    await fresh(page, "body");
    assert.equal(await missing.count(), 0);
    await page.waitForSelector("[data-section=constraints] :text('held by the default')");
    await add(page, "fixed");
    await fresh(page, "body");
    assert.equal(await missing.count(), 0);
    assert.deepEqual(page.complaints, []);
  });

  await step("a region without tissue is said in its constraint", async () => {
    await add(page, "fixed");
    const second = page.locator("fieldset.hold").nth(1);
    await second.locator(".number:has(label:text-is('Where')) select").selectOption("box_mm");
    await until(page, () => window.incise.state.case.settings.specimen.constraints[1].where.box_mm);
    await idle(page);
    for (const [corner, value] of [["High", 900], ["Low", 800]]) {
      await type(second.locator(`fieldset:has(> legend:text-is("${corner} corner, mm")) input`).first(), value);
      await idle(page);
    }
    await page.waitForSelector("[data-missing^='specimen.constraints[1]']", {state: "attached"});
    assert.match(await second.textContent(), /region without any vertex/);
    assert.equal(await shown.locator(".problem").count(), 0);
    await page.click("[aria-label^='Remove constraint 2']");
    await until(page, () => window.incise.state.case.settings.specimen.constraints.length === 1);
    await fresh(page, "body");
    assert.ok(page.complaints.splice(0).every((text) => text === "answer 422: /api/call/body"));
  });

  await step("the panel says so when there are more constraints than colours", async () => {
    const more = shown.locator(`p:has-text("the first ${kColoured} of them")`);
    for (let count = 2; count <= kColoured; ++count) await add(page, "fixed");
    assert.equal(await more.count(), 0);
    await add(page, "fixed");
    assert.equal(await more.count(), 1);
    await fresh(page, "body");
    assert.deepEqual(page.complaints, []);
  });
});
