// A server that is killed: the page says so, and the next server shows the case as it was.

import assert from "node:assert/strict";
import {test} from "node:test";
import {
  Studio,
  fresh,
  goTo,
  inputIn,
  newPage,
  openStudio,
  openedStudio,
  stateOf,
  temporaryFolder,
  type,
  until,
  writeBlock,
} from "./support.mjs";

test("a page whose server is killed says so, and a new server shows the same case", async (t) => {
  const folder = temporaryFolder(t);
  writeBlock(folder);
  const {studio: first, browser, page} = await openedStudio(t, folder, "case");
  await goTo(page, "plan");
  await fresh(page, "plan");
  await type(inputIn(page, "plan", "Depth"), 4);
  await until(page, () => window.incise.state.case.settings.plan.depth_mm === 4);
  await fresh(page, "plan");
  const [before, path] = [await stateOf(page, "case"), await stateOf(page, "plan.path")];

  await first.end("SIGKILL");
  await page.waitForSelector("[data-link-state=lost]");
  const notice = page.locator(".broken[role=alert]");
  assert.match(await notice.textContent(), /server does not answer.*Start incise studio again/);
  assert.deepEqual(await stateOf(page, "case"), before, "what was known stays to be seen");

  const second = await Studio.start(t, folder, "case");
  assert.notEqual(second.address, first.address);
  const next = await newPage(browser);
  await openStudio(next, second);
  assert.deepEqual(await stateOf(next, "case"), before);
  await goTo(next, "plan");
  await fresh(next, "plan");
  assert.equal(await inputIn(next, "plan", "Depth").inputValue(), "4");
  assert.deepEqual(await stateOf(next, "plan.path"), path);
  assert.equal(await next.locator(".broken").count(), 0);
  await second.end("SIGTERM");

  // At the old address with a new token, the old page is told what to do.
  await Studio.start(t, folder, "case", "--port", first.port);
  await page.waitForSelector("[data-link-state=denied]");
  assert.match(await notice.textContent(), /Open the address that incise studio printed/);
});
