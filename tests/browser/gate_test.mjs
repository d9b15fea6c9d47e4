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
  inputIn,
  openedStudio,
  runCase,
  stateOf,
  temporaryFolder,
  type,
  until,
  writeBlock,
} from "./support.mjs";

function gateOf(folder) {
  return JSON.parse(fs.readFileSync(path.join(folder, "out", "study.json"), "utf8")).program;
}

const kSecond = "A second reason of the same caution.";

/** Gives the run a second reason of its first missing caution, which is refused if asked for. @returns both messages */
function giveSecondReason(page, isRefused) {
  return page.evaluate(
    async ([message, refuse]) => {
      const {state, update} = await import("/page/store.js"),
        {run} = state,
        [id, ...missing] = run.gate.missing,
        first = run.verdict.reasons.find((reason) => reason.id === id);
      const verdict = {...run.verdict, reasons: [...run.verdict.reasons, {...first, message}]};
      window.givenRun = run;
      update({run: {...run, verdict, gate: refuse ? {...run.gate, refused: [id], missing} : run.gate}});
      return [first.message, message];
    },
    [kSecond, isRefused],
  );
}

/** Checks that both reasons of one id are to be read at it, and puts the run back as it was. */
async function assertBothSeen(page, selector, isRefused) {
  const messages = await giveSecondReason(page, isRefused);
  const holder = page.locator(selector).filter({hasText: kSecond});
  await holder.waitFor();
  const text = await holder.textContent();
  for (const message of messages) assert.ok(text.includes(message), `${message} in ${text}`);
  await page.evaluate(async () => (await import("/page/store.js")).update({run: window.givenRun}));
  await holder.waitFor({state: "detached"});
}

/** Accepts what is ticked, which is all, and reads what is said meanwhile. */
async function acceptAll(page, said) {
  assert.equal(
    await said.textContent(),
    "Accepted. Press “Run again with these accepted”: nothing that was cut is cut again.",
  );
  let isHeld = false,
    release = null;
  const released = new Promise((resolve) => (release = resolve));
  await page.route("**/api/call/run", async (route) => {
    isHeld = true;
    await released;
    await route.continue();
  });
  await page.click("[data-do=accept]");
  await until(page, () => document.querySelector("[data-program=none]").textContent === "Writing the program…");
  while (!isHeld) await page.waitForTimeout(20);
  release();
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
  await assertBothSeen(page, ".gate label", false);
  await assertBothSeen(page, ".refusal", true);
  const said = page.locator("[data-program=none]");
  assert.match(await said.textContent(), /a person has to accept each of the cautions above/);

  for (let k = 0; k < missing.length; ++k) {
    assert.ok(!gateOf(inside).written, `${k} of ${missing.length} accepted`);
    await boxes.nth(k).check();
    if (k === 0 || k === missing.length - 1) {
      const before = await stateOf(page, "run.gate.accepted");
      await (k === 0 ? page.click("[data-do=accept]") : acceptAll(page, said));
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

// Sets a setting of step Plan, and waits until the case has it.
async function setPlan(page, label, key, value) {
  await goTo(page, "plan");
  await idle(page);
  await type(inputIn(page, "plan", label), value);
  await until(page, ([name, wanted]) => window.incise.state.case.settings.plan[name] === wanted, [key, value]);
  await idle(page);
}

// Where the correction is accepted, what is said against the planned path is no more about what a program follows.
async function assertFollowed(page) {
  await page.evaluate(async () => {
    const {state, update} = await import("/page/store.js"),
      {run} = state;
    window.givenRun = run;
    const verdict = {...run.verdict, status: "caution"};
    update({run: {...run, accepted: true, as_planned: {...run.as_planned, verdict}}});
  });
  const said = await page.textContent("[data-section=against-other]");
  assert.match(said, /^Against the cut as plannedNo program follows this path: the correction is accepted/);
  await page.evaluate(async () => (await import("/page/store.js")).update({run: window.givenRun}));
}

const kOfProgram = ["download", "play", "copy", "save-report", "accept"].map((name) => `[data-do=${name}]`);
const kAllOfProgram = [...kOfProgram, "[data-program]", ".player", ".gate", ".panel :text('checks')"];

// There is nothing to save, copy or play, and one sentence says what to do.
async function assertWithdrawn(page) {
  await goTo(page, "program");
  await idle(page);
  for (const selector of kAllOfProgram) assert.equal(await page.locator(selector).count(), 0, selector);
  assert.match(await page.textContent("[data-withdrawn=run]"), /Run again/);
  assert.deepEqual([await stateOf(page, "arm"), await stateOf(page, "run.program")], [null, null]);
}

test("a change of the case withdraws the program, its checks, its command and the arm", async (t) => {
  const folder = temporaryFolder(t);
  writeBlock(folder);
  const {page} = await openedStudio(t, folder, "case"),
    boxes = page.locator(".gate input[type=checkbox]"),
    again = page.locator("[data-do=accept]");
  await setPlan(page, "Power", "power_w", 20);
  await runCase(page);
  assert.match(await page.textContent("[data-section=to-program]"), /step Program lists the cautions that a person has/);
  await assertFollowed(page);
  await goTo(page, "program");
  assert.deepEqual([await again.textContent(), await again.isEnabled()], ["Run again", false], "nothing is ticked");
  for (let k = 0; k < (await boxes.count()); ++k) await boxes.nth(k).check();
  assert.match(await again.textContent(), /with these accepted/);
  await again.click();
  await page.waitForSelector("[data-arm=there]");
  await idle(page);
  const revision = await stateOf(page, "run.revision"),
    margin = await stateOf(page, "case.settings.plan.lateral_margin_mm");
  for (const selector of ["download", "play", "copy", "save-report"])
    assert.equal(await page.locator(`[data-do=${selector}]`).count(), 1, selector);

  await setPlan(page, "Power", "power_w", 25);
  await assertWithdrawn(page);
  await setPlan(page, "Lateral margin", "lateral_margin_mm", 40);
  assert.ok(await stateOf(page, "problems.plan"), "no such path can be planned");
  const legend = await page.locator(".legend-row label").allTextContents();
  assert.ok(legend.includes("path of earlier settings") && !legend.includes("planned path"), legend.join());
  await assertWithdrawn(page);
  await goTo(page, "compare");
  assert.equal(await page.locator("[data-section=to-program] [data-withdrawn=run]").count(), 1);

  // What was accepted is not accepted of the case when it is as it was: it has to be run again.
  await setPlan(page, "Lateral margin", "lateral_margin_mm", margin);
  await setPlan(page, "Power", "power_w", 20);
  assert.equal(await stateOf(page, "case.revision"), revision);
  await assertWithdrawn(page);
  await page.click(".panel [data-do=run]");
  await page.waitForSelector(".gate");
  assert.deepEqual([await stateOf(page, "run.program"), await page.locator("[data-withdrawn]").count()], [null, 0]);
  await assertAccessible(page, "program, run again");
});
