// From the slices of the head CT to a planned path, as docs/head-ct.md has it, with the page alone.

import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import {test} from "node:test";
import {
  chain,
  coverage,
  fresh,
  goTo,
  idle,
  inputIn,
  knownVoxels,
  look,
  openedStudio,
  readPoints,
  scenePixel,
  skip,
  slicePixel,
  stateOf,
  temporaryFolder,
  type,
  typeAll,
  until,
} from "./support.mjs";

const kSlices = process.env.INCISE_DATA_DIR ? path.join(process.env.INCISE_DATA_DIR, "ct", "vhf_head_png") : "";
const kTets = 8000; // coarse: this is about the page
const kMiddle = [248, 175, 74]; // mm: of the edge, on the back of the tongue
const kDiameters = [20, 18];

/** Waits until the case holds a setting, given by a dotted key. */
function stored(page, key, value) {
  return until(
    page,
    ([dotted, wanted]) => {
      const found = dotted.split(".").reduce((part, name) => part && part[name], window.incise.state.case.settings);
      return JSON.stringify(found) === JSON.stringify(wanted);
    },
    [key, value],
  );
}

/** The group of the constraint that was added last. */
function lastHold(page) {
  return page.locator(".holds > li").last();
}

async function addHold(page, kind, within) {
  const count = await page.locator(".holds > li").count();
  await page.click(`[data-add=${kind}]`);
  await until(
    page,
    (before) => (window.incise.state.case.settings.specimen.constraints || []).length === before + 1,
    count,
  );
  await idle(page); // as slow as a person: what is shown next is what the server gives
  if (within) await type(lastHold(page).locator('.number:has(label:text-is("Within")) input'), within);
}

if (!fs.existsSync(kSlices)) skip("INCISE_DATA_DIR does not name the folder of shared test data");
test("the head CT's slices become a case with a planned path", async (t) => {
  const folder = temporaryFolder(t),
    scans = temporaryFolder(t); // a copy: whatever the page does, the shared data stay as they are
  fs.cpSync(kSlices, path.join(scans, "slices"), {recursive: true});
  const {studio, page} = await openedStudio(t, folder, "--root", scans),
    step = chain(t);

  await step("a case is made of the slices of another root, in the folder that the studio was started in", async () => {
    await page.waitForSelector("[data-section=files] select");
    const root = await page.locator("[data-section=files] select option:not([value=''])").nth(1).getAttribute("value");
    await page.selectOption("[data-section=files] select", root);
    const row = page.locator("button.file:has-text('slices')");
    assert.equal((await row.locator(".soft").textContent()).trim(), "Scan", "a folder has no size");
    await row.click();
    await page.waitForSelector("[data-section=create] fieldset");
    await typeAll(page, "create", "Spacing, mm", [1, 1, 10]);
    assert.equal(await page.getAttribute("[data-section=create] [data-odd]", "data-odd"), "2340"); // mm: of a head
    await typeAll(page, "create", "Spacing, mm", [1, 1, 1]);
    assert.match(await page.textContent("[data-section=create]"), /234 slices of 1 mm: 234 mm/);
    assert.equal(await page.locator("[data-odd]").count(), 0);
    await typeAll(page, "create", "HU from grey value", [16, -1024]);
    await type(page.locator("[data-section=create] input[type=text]"), "tongue");
    const place = await page.textContent("[data-section=create] [data-made-as=tongue]");
    assert.ok(place.includes(`${fs.realpathSync(folder)}/tongue`), place);
    const choice = page.locator("[data-section=create] .number:has(label:text-is('Make it in')) select option");
    assert.deepEqual(await choice.allTextContents(), [folder, scans].map((one) => fs.realpathSync(one)));
    await page.click("[data-do=create]");
    await page.waitForSelector(".page[data-step=see]");
    await until(page, () => window.incise.state.scan);
    assert.deepEqual(await stateOf(page, "scan.grid.size"), [512, 512, 234]);
    assert.ok(fs.existsSync(path.join(folder, "tongue", "case.yaml")));
    assert.deepEqual(fs.readdirSync(scans), ["slices"]);
  });

  await step("the page says how large the scan is, and a new box about the crosshair holds a tongue", async () => {
    assert.equal(await page.getAttribute("[data-extent]", "data-extent"), "512 512 234");
    assert.equal(await page.locator("[data-odd]").count(), 0);
    await typeAll(page, "picture", "Crosshair, mm", [247, 190, 20]);
    await page.click("[data-do=box]");
    await until(page, () => window.incise.state.case.settings.ct.roi_box_mm);
    const [low, high] = await stateOf(page, "case.settings.ct.roi_box_mm");
    assert.deepEqual([low.slice(0, 2), high], [[212, 155], [282, 225, 55]]);
    assert.equal(low[2], 0, "clipped to the scan");
  });

  await step("box, window, seed and surface give the tongue", async () => {
    await typeAll(page, "box", "Low corner, mm", [223, 150, 42]);
    await typeAll(page, "box", "High corner, mm", [273, 208, 77]);
    await stored(page, "ct.roi_box_mm", [[223, 150, 42], [273, 208, 77]]);
    await typeAll(page, "picture", "Crosshair, mm", [247, 190, 60]);
    await page.click("[data-section=seed] button:text-is('At the crosshair')");
    await typeAll(page, "window", "Tissue, HU", [-20, 180]);
    await type(inputIn(page, "surface", "Opening radius"), 4);
    await type(inputIn(page, "surface", "Smoothing"), 1.2);
    const wanted = {seed_mm: [247, 190, 60], window_hu: [-20, 180], opening_radius_mm: 4, smoothing_mm: 1.2};
    for (const [key, value] of Object.entries(wanted)) await stored(page, `ct.${key}`, value);
    await fresh(page, "tissue");
    const {voxels} = await stateOf(page, "tissue.summary");
    assert.ok(voxels > 40_000 && voxels < 90_000, `${voxels} voxels of 1 mm3`);
  });

  await step("what the box has cut has a colour of its own", async () => {
    const on = await page.evaluate(() => {
      const {tissue, case: open} = window.incise.state,
        {vertices} = tissue.skin,
        left = open.settings.ct.roi_box_mm[1][0];
      let best = null; // of the vertices on the box's left face the one that is nearest to its middle
      for (let i = 0; i < vertices.length; i += 3) {
        const [x, y, z] = vertices.slice(i, i + 3),
          off = Math.abs(y - 190) + Math.abs(z - 60);
        if (Math.abs(x - left) < 0.3 && (!best || off < best.off)) best = {at: [x, y, z], off};
      }
      return best.at;
    });
    await look(page, "Left");
    assert.ok(await page.locator(".legend label:has-text('cut off by the region')").count());
    const [red, green, blue] = await scenePixel(page, on);
    assert.ok(blue > red, `slate where the box cuts: ${[red, green, blue]}`);
    await look(page, "Top");
    const tissue = await scenePixel(page, kMiddle);
    assert.ok(tissue[0] > tissue[2] + 20, `the tissue's own surface: ${tissue}`);
    await look(page, "Oblique");
  });

  await step("the slices show the scan, and the tongue in it", async () => {
    for (const [view, share] of Object.entries(await coverage(page))) assert.ok(share > 0.02, `${view}: ${share}`);
    const tongue = await slicePixel(page, "axial", [252, 186, 60]);
    assert.ok(tongue[2] > tongue[0] + 25, `blue: ${tongue}`);
    await page.click("button:text-is('All values')");
    await page.fill(".slider:has(label:text-is('Tissue overlay')) input", "0");
    for (const {view, found, expected} of await knownVoxels(page)) {
      assert.ok(Math.abs(found - expected) < 14, `${view}: ${found} for ${expected}`);
    }
  });

  await step("an ellipse on the back of the tongue becomes the edge", async () => {
    await goTo(page, "edge");
    await fresh(page, "tissue");
    await typeAll(page, "ellipse", "Diameters, mm", kDiameters);
    await typeAll(page, "ellipse", "Middle, mm", kMiddle);
    await page.click("[data-do=drop]");
    await until(page, () => window.incise.state.edge.isClosed);
    await page.click("[data-do=save-edge]");
    await until(page, () => window.incise.state.case.inputs["tumor.contour"] === "tumor_edge.csv");
    await idle(page);
    const points = readPoints(path.join(folder, "tongue", "tumor_edge.csv"));
    for (const [x, y, z] of points) {
      const round = Math.hypot((2 * (x - kMiddle[0])) / kDiameters[0], (2 * (y - kMiddle[1])) / kDiameters[1]);
      assert.ok(Math.abs(round - 1) < 0.15 && z > 68 && z < 78, `${x}, ${y}, ${z}`);
    }
  });

  await step("clamp, pull and platform hold it, and it is stretched", async () => {
    const {answer} = await studio.call("case");
    await studio.call("change", {revision: answer.revision, set: {"meshing.tets": kTets}});
    await stored(page, "meshing.tets", kTets);
    await goTo(page, "hold");
    await addHold(page, "fixed", 8);
    await addHold(page, "displaced", 7);
    const pull = lastHold(page).locator('fieldset:has(> legend:text-is("Displacement, mm")) input');
    for (const [k, value] of [0, -8, 0].entries()) await type(pull.nth(k), value);
    await addHold(page, "support");
    const plane = lastHold(page).locator('fieldset:has(> legend:text-is("Point, mm")) input');
    for (const [k, value] of [248, 175, 41.5].entries()) await type(plane.nth(k), value);
    await until(page, () => (window.incise.state.case.settings.specimen.constraints || []).length === 3);
    await idle(page);
    const written = fs.readFileSync(path.join(folder, "tongue", "case.yaml"), "utf8");
    const ends = ["direction: posterior, within_mm: 8", "direction: anterior, within_mm: 7"];
    for (const part of [...ends, "[0, -8, 0]", "[248, 175, 41.5]"]) {
      assert.ok(written.replaceAll('"', "").includes(part), `${part} in\n${written}`);
    }
    await fresh(page, "body");
    const counts = (await stateOf(page, "body.constraints")).map((one) => one.vertices);
    assert.ok(counts[0] > 0 && counts[1] > 0, `${counts}`);
    await page.click("[data-do=stretch]");
    await fresh(page, "stretch");
    const greatest = await stateOf(page, "stretch.greatest_mm");
    assert.ok(greatest > 7.9 && greatest < 16, `${greatest} mm`);
  });

  await step("a path is planned round the edge", async () => {
    await goTo(page, "plan");
    await fresh(page, "plan");
    const points = await page.evaluate(() => window.incise.state.plan.path.points_mm);
    assert.ok(points.length > 20 && (await stateOf(page, "plan.path.closed")));
    const pages = await page.textContent("[data-section=planned]");
    assert.match(pages, new RegExp(`${points.length} waypoints`));
    for (const {id} of await stateOf(page, "plan.verdict.reasons")) {
      assert.ok(await page.locator(`[data-section=planned] [data-way-out=${id}]`).count(), `what to do about ${id}`);
    }
    const refused = "answer 422: /api/call/body"; // of a body that one constraint alone holds
    assert.deepEqual(page.complaints.filter((text) => text !== refused), []);
  });
});
