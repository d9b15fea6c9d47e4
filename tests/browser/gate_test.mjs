// The gate before the robot's program: each caution is accepted by itself, and only then is there something to download.

import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import {test} from "node:test";
import {
  assertAccessible,
  coverage,
  goTo,
  idle,
  openedStudio,
  runCase,
  stateOf,
  temporaryFolder,
  until,
  writeBlock,
} from "./support.mjs";

function gateOf(folder) {
  return JSON.parse(fs.readFileSync(path.join(folder, "out", "study.json"), "utf8")).program;
}

test("a program is offered once every caution is accepted, and it is the one that was written", async (t) => {
  const folder = temporaryFolder(t),
    inside = writeBlock(folder),
    script = path.join(inside, "out", "program", "program.script");
  const {page} = await openedStudio(t, folder, "case");
  await runCase(page);
  await goTo(page, "program");
  await idle(page);
  const missing = await stateOf(page, "run.gate.missing");
  assert.ok(missing.length > 1 && !gateOf(inside).written);
  assert.equal(await page.locator("[data-do=download]").count(), 0);
  assert.ok(!fs.existsSync(script));
  const boxes = page.locator(".gate input[type=checkbox]");
  assert.equal(await boxes.count(), missing.length);

  for (let k = 0; k < missing.length; ++k) {
    assert.ok(!gateOf(inside).written, `${k} of ${missing.length} accepted`);
    await boxes.nth(k).check();
    if (k === 0 || k === missing.length - 1) {
      const before = await stateOf(page, "run.gate.accepted");
      await page.click("[data-do=accept]");
      await until(page, (count) => window.incise.state.run.gate.accepted.length > count, before.length);
      await idle(page);
    }
  }
  await page.waitForSelector("[data-program=there]");
  assert.ok(gateOf(inside).written);
  const [download] = await Promise.all([page.waitForEvent("download"), page.click("[data-do=download]")]);
  assert.equal(fs.readFileSync(await download.path(), "utf8"), fs.readFileSync(script, "utf8"));

  // The arm plays it, and the report is at hand.
  await page.waitForSelector("[data-arm=there]");
  await idle(page);
  assert.ok((await coverage(page)).scene > 0.02, "the arm is drawn");
  await page.click("[data-speed='20']");
  await page.click("[data-do=play]");
  await until(page, () => Number(document.querySelector(".player").dataset.time) > 1);
  await page.click("[data-do=rewind]");
  const [report] = await Promise.all([page.waitForEvent("download"), page.click("[data-do=save-report]")]);
  const kept = fs.readFileSync(path.join(inside, "out", "report.html"), "utf8");
  assert.equal(fs.readFileSync(await report.path(), "utf8"), kept);
  await assertAccessible(page, "program");
});
