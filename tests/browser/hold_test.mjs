// Constraints are added one after the other: what they lack meanwhile is said in a normal tone, and the last body stays.

import assert from "node:assert/strict";
import path from "node:path";
import {test} from "node:test";
import {
  assertAccessible,
  chain,
  fresh,
  goTo,
  idle,
  inputIn,
  openedStudio,
  replaceIn,
  stateOf,
  temporaryFolder,
  type,
  until,
  writeBlock,
} from "./support.mjs";

const kColoured = 8; // constraints

function settingOf(page) {
  return stateOf(page, "case.settings.specimen.constraints");
}

async function add(page, kind) {
  const before = (await settingOf(page)) || [];
  await page.click(`[data-add=${kind}]`);
  await until(
    page,
    (count) => (window.incise.state.case.settings.specimen.constraints || []).length > count,
    before.length,
  );
  await idle(page);
}

test("constraints that do not hold the body yet are no failure", async (t) => {
  const folder = temporaryFolder(t);
  writeBlock(folder);
  const {page} = await openedStudio(t, folder, "case"),
    step = chain(t),
    shown = page.locator("[data-section=constraints]"),
    missing = page.locator("[data-missing]");

  await step("what is still needed is said, and the body is shown as it was held last", async () => {
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

/** Where inputs and buttons are, px from the top of the panel's content. */
function tops(page, ...selectors) {
  return page.evaluate((list) => {
    const {scrollTop} = document.querySelector(".panel");
    return list.map((selector) => scrollTop + document.querySelector(selector).getBoundingClientRect().top);
  }, selectors);
}

/** Keeps a call from the server until the returned function is called; what was held goes one after the other then, for
 *  a newer answer's arrays take the place of an older one's. */
async function holdBack(page, call) {
  const address = `**/api/call/${call}`,
    held = [];
  let isOpen = false;
  await page.route(address, (route) => (isOpen ? route.continue() : held.push(route)));
  return async () => {
    isOpen = true;
    for (const route of held) {
      const answered = page.waitForResponse((response) => response.request() === route.request());
      await route.continue();
      await answered;
    }
    await page.unroute(address, {behavior: "wait"});
  };
}

test("the default hold is said in words, and a pull that is too long as well", async (t) => {
  const folder = temporaryFolder(t);
  writeBlock(folder);
  const {page} = await openedStudio(t, folder, "case"),
    step = chain(t);

  await step("what holds the body by default is said, with the library's own numbers", async () => {
    await goTo(page, "hold");
    await fresh(page, "body");
    page.complaints.splice(0); // of the scan and the tissue that a block does not have
    const [clamp, pull, support] = await page.locator("[data-default] li").allTextContents();
    const found = await stateOf(page, "body.constraints");
    const {within_mm: clamped} = found[0].setting.where.end,
      {displacement_mm: way} = found[1].setting;
    assert.ok(clamp.includes(`The back end (${clamped} mm) is clamped`), clamp);
    assert.ok(clamp.includes(`${found[0].vertices} vertices`), clamp);
    assert.ok(pull.includes(`is pulled ${-way[1]} mm forwards`), pull);
    const share = found[1].share_of_length;
    assert.ok(share > 0.25 && share < 0.5, `${share}: 20 mm of 60 mm`);
    assert.ok(pull.includes(`A pull of ${-way[1]} mm: ${Math.round(100 * share)} % of the body's length`), pull);
    assert.match(pull, /A smaller pull deforms the tissue less/);
    assert.deepEqual([found[0], found[2]].map((one) => one.share_of_length), [null, null]);
    assert.match(support, /rests on a plane/);
  });

  await step("it can be written into the case; a count of earlier settings says that it is one", async () => {
    const counts = (await stateOf(page, "body.constraints")).map((one) => one.vertices);
    const release = await holdBack(page, "body");
    await page.click("[data-do=own-constraints]");
    await until(page, () => (window.incise.state.case.settings.specimen.constraints || []).length === 3);
    await page.waitForSelector("[data-stale]");
    assert.deepEqual(
      await page.locator("[data-stale]").evaluateAll((nodes) => nodes.map((node) => Number(node.dataset.stale))),
      counts.slice(0, 2),
    );
    await release();
    await fresh(page, "body");
    assert.equal(await page.locator("[data-stale]").count(), 0);
    assert.deepEqual((await stateOf(page, "body.constraints")).map((one) => one.vertices), counts);
  });

  const pullOf = page.locator(".holds > li").nth(1),
    way = pullOf.locator('fieldset:has(> legend:text-is("Displacement, mm")) input');

  await step("a short pull is no reason for a hint, and nothing moves while the body is computed", async () => {
    const places = () => tops(page, ".holds > li:last-child button", "[data-add=fixed]", "[data-do=stretch]");
    await type(way.nth(1), -6);
    await until(page, () => window.incise.state.case.settings.specimen.constraints[1].displacement_mm[1] === -6);
    await fresh(page, "body");
    const share = await stateOf(page, "body.constraints.1.share_of_length"),
      said = pullOf.locator("[data-share]");
    const text = `A pull of 6 mm: ${Math.round(100 * share)} % of the body's length that way.`;
    assert.equal(await said.textContent(), text);
    const before = await places(),
      release = await holdBack(page, "body");
    await type(way.nth(1), -7);
    await page.waitForSelector("[data-section=constraints] [data-busy=body]");
    assert.deepEqual(await places(), before);
    await release();
    await fresh(page, "body");
    assert.match(await said.textContent(), /A pull of 7 mm/);
    assert.deepEqual(await places(), before);
  });

  await step("a pull that the mesh cannot follow is explained, with what to try and what incise reports", async () => {
    await type(way.nth(1), -400);
    await until(page, () => window.incise.state.case.settings.specimen.constraints[1].displacement_mm[1] === -400);
    await fresh(page, "body");
    await page.click("[data-do=stretch]");
    await fresh(page, "stretch");
    const note = await stateOf(page, "stretch.note"),
      said = page.locator("[data-section=stretch] [data-unstretched]");
    assert.ok(note, "400 mm are too much for a block of a few centimetres");
    const text = await said.textContent();
    assert.match(text, /could not be stretched/);
    assert.match(text, /Pull less/);
    for (const part of note.split(/specimen.constraints|displacement_mm/)) {
      assert.ok(text.includes(part.trim()), `${part} in ${text}`);
    }
    assert.match(text, /displacement_mm \(Displacement\)/);
    assert.deepEqual(page.complaints, []);
    await assertAccessible(page, "an unfollowed pull");
  });

  await step("step Plan says the same, and leads back", async () => {
    await goTo(page, "plan");
    await page.waitForSelector(".panel [data-unstretched]");
    await idle(page);
    await page.click("[data-unstretched] [data-to=hold]");
    await page.waitForSelector(".page[data-step=hold]");
    await idle(page);
    assert.ok(page.complaints.splice(0).every((text) => text === "answer 422: /api/call/plan"));
  });

  await step("what the tissue is can be set here", async () => {
    await page.click("[data-section=tissue] summary");
    const modulus = inputIn(page, "tissue", "Young's modulus"),
      {material} = await stateOf(page, "case.settings.specimen");
    assert.equal(Number(await modulus.inputValue()), material.youngs_modulus_kpa);
    await type(modulus, 35);
    await until(page, () => window.incise.state.case.settings.specimen.material.youngs_modulus_kpa === 35);
    await type(inputIn(page, "tissue", "Poisson's ratio"), 0.9);
    await page.waitForSelector("[data-section=tissue] .problem");
    assert.match(await page.textContent("[data-section=tissue] .problem"), /0\.9/);
    await idle(page);
    const elsewhere = await page.locator("[data-section=constraints] .problem").count();
    assert.equal(elsewhere, 0, "it stands beside its input alone");
    await type(inputIn(page, "tissue", "Poisson's ratio"), 0.45);
    await until(page, () => window.incise.state.case.settings.specimen.material.poissons_ratio === 0.45);
    await idle(page);
    assert.deepEqual(page.complaints.splice(0), ["answer 422: /api/call/change"]);
  });
});

test("where no body can be made, the default is said in words, and one's own constraint replaces it", async (t) => {
  const folder = temporaryFolder(t),
    inside = writeBlock(folder);
  const {page} = await openedStudio(t, folder, "case");
  await goTo(page, "hold");
  await fresh(page, "body");
  const [{setting: clamp}, {setting: pull}] = await stateOf(page, "body.constraints");
  replaceIn(path.join(inside, "block.msh"), "$Elements", "$Nothing");
  await page.reload();
  await goTo(page, "hold");
  const said = page.locator("[data-default=words]");
  await said.waitFor();
  const text = await said.textContent();
  assert.ok(text.includes(`back end (${clamp.where.end.within_mm} mm)`), text);
  assert.ok(text.includes(`front end (${pull.where.end.within_mm} mm)`), text);
  assert.ok(text.includes(`pulled ${-pull.displacement_mm[1]} mm forwards`), text);
  assert.equal(await page.locator("[data-do=own-constraints]").count(), 0);
  await add(page, "fixed");
  assert.equal(await said.count(), 0);
  await assertAccessible(page, "no body");
});

test("the place under the robot begins with the stretched tissue on the table", async (t) => {
  const folder = temporaryFolder(t);
  writeBlock(folder);
  const {page} = await openedStudio(t, folder, "case"),
    state = page.locator("[data-do=place-robot]");
  await goTo(page, "hold");
  await fresh(page, "body");
  const release = await holdBack(page, "stretch");
  await goTo(page, "plan");
  await page.click("[data-section=robot] button:text-is('Remove')");
  await until(page, () => window.incise.state.busy.stretch && !Object.keys(window.incise.state.drafts).length);
  await state.waitFor();
  assert.equal(await state.isEnabled(), false, "nobody knows yet how the tissue lies");
  await release();
  await fresh(page, "stretch");
  await state.click();
  await page.waitForSelector("[data-height]");
  assert.match(await page.textContent("[data-height]"), /lies on the table/);
  await fresh(page, "plan");

  // Nothing moves while the path is planned anew.
  const places = () => tops(page, "[data-section=plan] input", "[data-section=cut] input", "[data-section=robot] input");
  const before = await places(),
    releasePlan = await holdBack(page, "plan");
  await type(inputIn(page, "plan", "Depth"), 4);
  await page.waitForSelector("[data-section=planned] [data-busy=plan]");
  await page.waitForSelector("[data-section=planned] :text('Path of earlier settings')");
  assert.deepEqual(await places(), before);
  await releasePlan();
  await fresh(page, "plan");
  assert.deepEqual(page.complaints.filter((text) => !text.endsWith("/tissue") && !text.endsWith("/scan")), []);
});
