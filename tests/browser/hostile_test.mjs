// Texts of a case stay texts, and a page of another origin neither reads nor changes anything.

import assert from "node:assert/strict";
import fs from "node:fs";
import http from "node:http";
import path from "node:path";
import {test} from "node:test";
import {chain, goTo, idle, newPage, openedStudio, stateOf, temporaryFolder, writeBlock} from "./support.mjs";

const kMarkup = '<img src="x" onerror="window.hacked = 1">';
const kFolder = "<img src=x onerror=window.hacked=1>";

/** What markup would leave behind in the page. */
function traces(page) {
  return page.evaluate(() => ({
    hacked: window.hacked,
    elements: document.querySelectorAll("img, iframe, script:not([src]):not([type=importmap]), [onerror]").length,
  }));
}

test("a title, a file name and a setting with markup are shown as they are", async (t) => {
  const folder = temporaryFolder(t);
  const constraints = [{kind: "fixed", where: {point_array: `${kMarkup}=1`}}];
  writeBlock(folder, kFolder, {title: kMarkup});
  writeBlock(folder, "refused", {specimen: {constraints}});
  fs.mkdirSync(path.join(folder, "<svg onload=window.hacked=1>"));
  fs.writeFileSync(path.join(folder, `${kFolder}.csv`), "x_mm,y_mm,z_mm\n");
  const {page} = await openedStudio(t, folder),
    step = chain(t);

  await step("in the list of files, in the problem of a case that is refused, and in the head", async () => {
    await page.waitForSelector('button.file:has-text("<svg onload")');
    await page.waitForSelector(`li.file:has-text("${kFolder}.csv")`);
    await page.click('button.file:has-text("refused")');
    const problem = page.locator(".problem.block[data-problem=open]");
    await problem.waitFor();
    assert.ok((await problem.textContent()).includes(`found '${kMarkup}`));
    assert.deepEqual(await traces(page), {hacked: undefined, elements: 0});
    await page.click(`button.file[data-kind=case]:has-text("${kFolder}")`);
    await page.waitForSelector(".page[data-step=see]");
    assert.equal(await page.textContent(".head .title"), kMarkup);
  });

  await step("in every step", async () => {
    for (const name of ["open", "see", "edge", "hold", "plan", "run", "compare"]) {
      await goTo(page, name);
      await idle(page);
      assert.deepEqual(await traces(page), {hacked: undefined, elements: 0}, name);
    }
  });

  await step("without a broken policy or a script error", () => {
    // The refused case, and the scan and tissue that a block does not have.
    const unexpected = page.complaints.filter((text) => !/^answer 422: /.test(text));
    assert.deepEqual(unexpected, []);
  });

  await step("and the policy stops a script and a handler that got into the page all the same", async () => {
    await page.evaluate((markup) => {
      const script = document.createElement("script");
      script.textContent = "window.hacked = 2";
      document.body.append(script);
      const room = document.createElement("div");
      room.innerHTML = markup;
      document.body.append(room);
    }, kMarkup);
    await page.waitForFunction(() => document.querySelector("div > img[src=x]").complete);
    assert.equal((await traces(page)).hacked, undefined);
    assert.ok(page.complaints.some((text) => /policy: script-src/.test(text)), page.complaints.join("\n"));
  });
});

/** A server of another origin that gives every visitor the same page. */
async function otherOrigin(t, html) {
  const server = http.createServer((_, response) => response.setHeader("Content-Type", "text/html").end(html));
  await new Promise((resolve) => {
    server.listen(0, "127.0.0.1", resolve);
  });
  t.after(() => server.close());
  return `http://127.0.0.1:${server.address().port}/`;
}

/** Asks a studio from within a page. @returns what can be read of the answer, or "refused" */
function ask(page, address, options) {
  return page.evaluate(
    async ([target, how]) => {
      try {
        const response = await fetch(target, how);
        return {type: response.type, status: response.status, text: await response.text()};
      } catch {
        return "refused";
      }
    },
    [address, options],
  );
}

test("a page of another origin reads nothing and changes nothing", async (t) => {
  const folder = temporaryFolder(t),
    file = path.join(writeBlock(folder), "case.yaml"),
    before = fs.readFileSync(file, "utf8");
  const {studio, browser, page: own} = await openedStudio(t, folder, "case");
  await idle(own);
  const body = JSON.stringify({revision: await stateOf(own, "case.revision"), set: {"plan.depth_mm": 4}});
  const change = `${studio.origin}/api/call/change`,
    state = `${studio.origin}/api/call/state`;
  const headers = {"Content-Type": "application/json"};
  const json = (token) => ({method: "POST", headers: {...headers, "X-Incise-Token": token}, body});
  const html = `<!doctype html><title>other</title><iframe src="${studio.address}"></iframe>
    <form method="post" enctype="text/plain" action="${change}" target="answer">
      <input name='${body.slice(0, -1)}, "a' value='": 1}'>
    </form>
    <iframe name="answer"></iframe>`;
  const other = await newPage(browser),
    elsewhere = await otherOrigin(t, html);
  await other.goto(elsewhere);

  await t.test("the own page may ask what the other one is refused", async () => {
    const answer = await ask(own, state, {...json(studio.token), body: "{}"});
    assert.equal(answer.status, 200);
    assert.equal(JSON.parse(answer.text).case.title, "Test block");
  });

  await t.test("calls with a guessed token, with the right one, and as plain text", async () => {
    for (const token of ["0".repeat(32), studio.token]) {
      assert.equal(await ask(other, change, json(token)), "refused");
      assert.equal(await ask(other, state, {...json(token), body: "{}"}), "refused");
    }
    const plain = {method: "POST", headers: {"Content-Type": "text/plain"}, body};
    assert.equal(await ask(other, change, plain), "refused");
    assert.equal(await ask(other, change, {...plain, mode: "no-cors"}), "refused");
    assert.equal(await ask(other, `${studio.origin}/`, {}), "refused");
    const events = `${studio.origin}/api/events`;
    assert.equal(await ask(other, events, {headers: {"X-Incise-Token": studio.token}}), "refused");
  });

  await t.test("a form", async () => {
    const isAnswer = (response) => response.url() === change && response.request().method() === "POST";
    const answered = other.waitForResponse(isAnswer);
    await other.evaluate(() => document.forms[0].submit());
    assert.ok((await answered).status() >= 400);
  });

  await t.test("a frame about the studio stays empty", async () => {
    const frames = other.frames().filter((frame) => frame !== other.mainFrame() && frame.name() !== "answer");
    assert.equal(frames.length, 1);
    await frames[0].waitForLoadState();
    assert.equal(frames[0].url(), "chrome-error://chromewebdata/");
    assert.equal(await frames[0].locator("#app").count(), 0);
  });

  await t.test("the case is untouched, until its own page changes it", async () => {
    assert.equal(fs.readFileSync(file, "utf8"), before);
    assert.equal((await ask(own, change, json(studio.token))).status, 200);
    assert.notEqual(fs.readFileSync(file, "utf8"), before);
  });
});
