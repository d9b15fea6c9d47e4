// Tissue by hand: strokes of the brush, labels as a case, and a patch of the skin that holds.

import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import {test} from "node:test";
import {
  assertAccessible,
  assertNoSideways,
  chain,
  fresh,
  goTo,
  idle,
  incise,
  inputIn,
  look,
  newPage,
  openStudio,
  openedStudio,
  pixelIn,
  replaceIn,
  scenePixel,
  settle,
  slicePixel,
  stateOf,
  temporaryFolder,
  type,
  typeAll,
  until,
  watchCalls,
  writePhantom,
} from "./support.mjs";

const kRadius = 4; // mm: of the brush
const kFrom = [2, -4], // mm: a stroke from the middle of the tongue out of its left side; a cavity would be filled
  kTo = [36, -4];
const kBox = [[-50, -90, -40], [8, 90, 40]]; // mm: its left face cuts through the tongue, the others are outside
const kBackBox = [[-50, -90, -40], [50, 18, 40]]; // mm: its back face cuts through the tongue
const kSmallBox = [[-50, -90, -40], [50, -5, 40]]; // mm: it leaves the tongue's front half
const kLine = [[-8, -5], [-4, -8], [0, -10], [6, -8], [9, -2]]; // mm, as seen from above: of the patch

/** Drags from place to place in a view, mm. */
async function drag(page, view, places) {
  for (const [k, place] of places.entries()) {
    await page.mouse.move(...(await pixelIn(page, view, place)), {steps: 8});
    if (k === 0) await page.mouse.down();
  }
  await page.mouse.up();
}

async function paint(page, from = kFrom, to = kTo) {
  const height = (await stateOf(page, "cross"))[2];
  await drag(page, "axial", [[...from, height], [...to, height]]);
}

/** Waits for so many strokes and the tissue with them. */
async function strokes(page, count) {
  await until(page, (wanted) => (window.incise.state.case.settings.ct.edits || []).length === wanted, count);
  await fresh(page, "tissue");
  assert.equal(await page.locator("[data-stroke]").count(), count);
  return stateOf(page, "tissue.summary");
}

/** Chooses a file in step Open. */
async function choose(page, name) {
  await page.click(`[data-file="${name}"]`);
  await page.waitForSelector("[data-section=create]");
}

/** A label volume of two blocks side by side, 1 mm voxels. */
function writeTwoLabels(file) {
  const size = [36, 24, 24],
    voxels = Buffer.alloc(size[0] * size[1] * size[2]);
  for (let k = 6; k < 18; ++k) {
    for (let j = 6; j < 18; ++j) {
      for (let i = 6; i < 30; ++i) voxels[i + size[0] * (j + size[1] * k)] = i < 20 ? 3 : 7;
    }
  }
  const head = ["NRRD0004", "type: uint8", "dimension: 3", "space: left-posterior-superior"];
  head.push(`sizes: ${size.join(" ")}`, "space directions: (1,0,0) (0,1,0) (0,0,1)", "space origin: (0,0,0)");
  head.push("encoding: raw", "", "");
  fs.writeFileSync(file, Buffer.concat([Buffer.from(head.join("\n")), voxels]));
  return {3: 14 * 12 * 12, 7: 10 * 12 * 12};
}

/** A block, 20 x 60 x 16 mm, as triangles. */
function writeBlock(file) {
  const corner = (at) => [20 * (at & 1), 30 * (at & 2), 4 * (at & 4)];
  const sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
  const triangles = sides.flatMap(([a, b, c, d]) => [[a, b, c], [a, c, d]]);
  const lines = triangles.flatMap((corners) => [
    "facet normal 0 0 0",
    "outer loop",
    ...corners.map((at) => `vertex ${corner(at).join(" ")}`),
    "endloop",
    "endfacet",
  ]);
  fs.writeFileSync(file, ["solid block", ...lines, "endsolid block", ""].join("\n"));
}

test("tissue is painted, labels become a case, and a patch of the skin holds", async (t) => {
  const folder = temporaryFolder(t),
    step = chain(t);
  writePhantom(folder, "--format", "nrrd");
  incise(folder, "segment", "specimen/ct.nrrd", "-o", "labels.nrrd");
  const counts = writeTwoLabels(path.join(folder, "two.seg.nrrd"));
  writeBlock(path.join(folder, "block.stl"));
  const caseText = () => fs.readFileSync(path.join(folder, "specimen", "case.yaml"), "utf8");
  const {studio, page} = await openedStudio(t, folder, "specimen");
  let found = null;

  await step("without a brush a drag moves the crosshair, and nothing is painted", async () => {
    await until(page, () => window.incise.state.scan);
    await fresh(page, "tissue");
    found = await stateOf(page, "tissue.summary");
    await paint(page);
    assert.ok(Math.abs((await stateOf(page, "cross"))[0] - kTo[0]) < 0.5);
    assert.equal(await stateOf(page, "case.settings.ct.edits"), null);
  });

  await step("the brush has its true size under the pointer", async () => {
    await page.click("[data-do=brush-take]");
    await type(inputIn(page, "brush", "Radius of the brush"), kRadius - 0.7);
    await page.focus("[data-view=axial] canvas");
    await page.keyboard.press("]");
    assert.equal(await stateOf(page, "brush.radius_mm"), kRadius);
    const at = [-30, 20, (await stateOf(page, "cross"))[2]]; // on black
    await page.mouse.move(...(await pixelIn(page, "axial", at)));
    const rim = await slicePixel(page, "axial", [at[0] - kRadius, at[1], at[2]]);
    assert.ok(rim[0] > 80 && rim[0] > rim[2] + 40, `orange: ${rim}`);
    assert.ok(Math.max(...(await slicePixel(page, "axial", at))) < 60, "nothing in its middle");
  });

  await step("a stroke that Escape breaks off is none, and the brush stays", async () => {
    const calls = watchCalls(page),
      height = (await stateOf(page, "cross"))[2];
    await page.mouse.move(...(await pixelIn(page, "axial", [...kFrom, height])));
    await page.mouse.down();
    await page.mouse.move(...(await pixelIn(page, "axial", [...kTo, height])), {steps: 8});
    assert.ok((await page.evaluate(() => window.incise.views.axial.model.stroke.length)) > 1);
    await page.keyboard.press("Escape");
    assert.equal(await page.evaluate(() => window.incise.views.axial.model.stroke.length), 0);
    await page.mouse.up();
    await idle(page);
    assert.equal(await stateOf(page, "placing"), "brush-take");
    assert.deepEqual(calls, []);
  });

  await step("a stroke takes tissue away, and is in the case", async () => {
    const cross = await stateOf(page, "cross");
    await paint(page);
    const after = await strokes(page, 1);
    assert.deepEqual(await stateOf(page, "cross"), cross, "the crosshair stays");
    const lost = found.volume_mm3 - after.volume_mm3,
      wide = Math.PI * kRadius ** 2; // mm2: of the stroke's section
    assert.ok(lost > 12 * wide && lost < 30 * wide, `${lost} mm3`);
    const [stroke] = await stateOf(page, "case.settings.ct.edits");
    assert.deepEqual([stroke.tissue, stroke.radius_mm], [false, kRadius]);
    stroke.path_mm.slice(1, -1).forEach((point, k) => {
      const gap = Math.hypot(...point.map((value, axis) => value - stroke.path_mm[k][axis]));
      assert.ok(gap >= 0.5 * kRadius - 0.02 && gap < 1.5 * kRadius, `${gap} mm from point to point`);
    });
    assert.match(caseText(), /edits:/);
    assert.match(caseText(), /tissue: false/);
  });

  await step("undo gives the tissue back, and redo takes it away again", async () => {
    const after = await stateOf(page, "tissue.summary");
    await page.keyboard.press("Control+z");
    assert.deepEqual(await strokes(page, 0), found);
    assert.doesNotMatch(caseText(), /edits:/);
    await page.click("[data-do=redo]");
    assert.deepEqual(await strokes(page, 1), after);
  });

  await step("a ball at the crosshair adds tissue, without a mouse", async () => {
    const before = await stateOf(page, "tissue.summary");
    await page.click("[data-do=brush-add]");
    const inputs = page.locator("[data-section=picture] .numbers input");
    for (const [k, value] of [-28, -4].entries()) await type(inputs.nth(k), value); // at the tongue's right side
    await page.focus("[data-do=ball]");
    await page.keyboard.press("Enter");
    const after = await strokes(page, 2);
    assert.ok(after.volume_mm3 > before.volume_mm3 + 40, `${after.volume_mm3 - before.volume_mm3} mm3`);
    await page.focus("[data-view=axial] canvas");
    await page.keyboard.press("Enter");
    assert.deepEqual(await strokes(page, 3), after, "the same ball again");
  });

  await step("a stroke that changes nothing is said to, with what to try", async () => {
    const said = page.locator("[data-idle]");
    assert.match(await page.textContent("[data-idle=add]"), /adds nothing: only what lies in the scan and is joined/);
    await page.keyboard.press("Control+z");
    await strokes(page, 2);
    assert.equal(await said.count(), 0, "it is undone");
    await page.keyboard.press("Control+y");
    await strokes(page, 3);
    await page.click("[data-do=brush-take]");
    const x = page.locator("[data-section=picture] .numbers input").first();
    for (const [place, isIdle] of [[-40, true], [-28, false]]) { // in air, and where the ball was added
      await type(x, place);
      await page.click("[data-do=ball]");
      await strokes(page, 4);
      assert.equal(await page.locator("[data-idle=take]").count(), isIdle ? 1 : 0, `${place}`);
      if (isIdle) assert.match(await said.textContent(), /takes nothing away: only what lies in the scan is changed/);
      if (isIdle) await assertAccessible(page, "an idle stroke");
      await page.click("[data-do=undo]");
      await strokes(page, 3);
      assert.equal(await said.count(), 0);
    }
  });

  await step("strokes are listed, and removed one by one or all together", async () => {
    assert.deepEqual(
      await page.locator("[data-stroke]").evaluateAll((rows) => rows.map((row) => row.dataset.stroke)),
      ["add", "add", "take"],
    );
    await page.focus("[aria-label='Remove stroke 1']");
    await page.keyboard.press("Enter");
    await strokes(page, 2);
    assert.notEqual(await page.evaluate(() => document.activeElement.tagName), "BODY", "the focus is kept");
    await page.click("[data-do=remove-strokes]");
    assert.deepEqual(await strokes(page, 0), found);
    await page.click("[data-do=undo]");
    await strokes(page, 2);
    await page.keyboard.press("Escape");
  });

  await step("more points than a request should hold are not sent", async () => {
    const path_mm = Array.from({length: 1998}, (_, k) => [40, 0.01 * k, 0]); // in air
    const {status} = await studio.call("change", {
      revision: await stateOf(page, "case.revision"),
      set: {"ct.edits": [{tissue: false, radius_mm: 1, path_mm}]},
    });
    assert.equal(status, 200);
    await strokes(page, 1);
    await paint(page);
    await page.waitForSelector("[data-refused]");
    await idle(page);
    assert.equal((await stateOf(page, "case.settings.ct.edits")).length, 1);
    for (const scheme of ["light", "dark"]) {
      await page.emulateMedia({colorScheme: scheme});
      await assertAccessible(page, `brush, ${scheme}`);
    }
    await page.click("[data-do=remove-strokes]");
    await strokes(page, 0);
  });

  await step("a stroke that goes through the slices takes tissue from those beside it too, as one edit", async () => {
    const labelsAt = (offset) =>
      page.evaluate((mm) => {
        const {tissue, cross} = window.incise.state,
          {size, spacing_mm: spacing, origin_mm: origin} = tissue.grid,
          area = size[0] * size[1],
          k = Math.round((cross[2] + mm - origin[2]) / spacing[2]);
        return tissue.labels.slice(k * area, (k + 1) * area).reduce((sum, label) => sum + (label ? 1 : 0), 0);
      }, offset);
    const offsets = [-2.5, 0, 2.5].map((share) => share * kRadius),
      counts = () => Promise.all(offsets.map(labelsAt));
    const through = inputIn(page, "brush", "Through"),
      before = await counts(),
      [x, y] = kFrom,
      height = (await stateOf(page, "cross"))[2];
    if ((await stateOf(page, "placing")) !== "brush-take") await page.click("[data-do=brush-take]");
    await paint(page);
    await strokes(page, 1);
    const flat = await counts();
    assert.ok(flat[0] === before[0] && flat[1] < before[1] && flat[2] === before[2], `${before}; ${flat}`);
    await page.click("[data-do=undo]");
    await strokes(page, 0);
    await type(through, 1e6);
    await paint(page);
    await page.waitForSelector("[data-refused]");
    await strokes(page, 0);
    await type(through, 5 * kRadius);
    await paint(page);
    await strokes(page, 1);
    const deep = await counts();
    deep.forEach((count, k) => assert.ok(count < before[k], `${offsets[k]} mm: ${count} of ${before[k]}`));
    const [{path_mm: points}] = await stateOf(page, "case.settings.ct.edits"),
      heights = [...new Set(points.map((point) => point[2]))].sort((a, b) => a - b);
    assert.ok(Math.abs(heights.at(-1) - heights[0] - 5 * kRadius) < 0.05, `${heights}`);
    heights.slice(1).forEach((one, k) => assert.ok(one - heights[k] <= kRadius + 0.02, `${heights}`));
    assert.ok(points.length < 60, `${points.length} points of a straight stroke`);
    await page.click("[data-do=undo]");
    assert.equal((await strokes(page, 0)).volume_mm3, found.volume_mm3);
    const limited = await page.evaluate(
      async ([box, from]) => {
        const {update} = await import("/page/store.js"),
          {strokeThrough} = await import("/page/brush.js");
        update({preview: {"ct.roi_box_mm": box}});
        const points = strokeThrough([from], {radius_mm: 2, through_mm: 40}, [0, 0, 1]).map((point) => point[2]);
        update({preview: {}});
        return [Math.min(...points), Math.max(...points)];
      },
      [[[-50, -90, height - 3], [50, 90, height + 90]], [x, y, height]],
    );
    assert.deepEqual(limited.map((z) => Number((z - height).toFixed(1))), [-3, 20], "the region box limits it");
    await type(through, 0);
  });

  await step("skin that the brush made is a layer of its own", async () => {
    const drawn = await page.evaluate(async () => {
      const {state, update} = await import("/page/store.js"),
        {tissue} = state;
      update({tissue: {...tissue, cut: tissue.cut.map((_, k) => k % 3)}});
      await new Promise(requestAnimationFrame);
      const layers = ["tissue", "cut-faces", "painted-skin"].map((name) => window.incise.views.scene.layers.get(name)),
        said = layers.map(({objects, label}) => [label, objects[0].geometry.index.count / 3]);
      update({tissue});
      return {said, all: tissue.skin.triangles.length / 3};
    });
    const part = (k) => Math.ceil((drawn.all - k) / 3);
    assert.deepEqual(drawn.said, [
      ["tissue", part(0)],
      ["cut off by the region or scan", part(1)],
      ["skin that the brush made", part(2)],
    ]);
    await until(page, () => !window.incise.views.scene.layers.get("painted-skin"));
  });

  const box = () => stateOf(page, "case.settings.ct.roi_box_mm");
  const boxed = async (wanted) => {
    await until(
      page,
      (text) => JSON.stringify(window.incise.state.case.settings.ct.roi_box_mm) === text,
      JSON.stringify(wanted),
    );
    await fresh(page, "tissue");
  };

  await step("tissue of another extent is shown whole, unless the camera sees the whole of it", async () => {
    const camera = () =>
      page.evaluate(() => {
        const {scene} = window.incise.views,
          isWhole = scene.sees(scene.centre, scene.radius);
        return {scale: scene.pixelsPerMm(), target: scene.target.toArray(), isWhole};
      });
    const setBox = async (value) => {
      await studio.call("change", {revision: await stateOf(page, "case.revision"), set: {"ct.roi_box_mm": value}});
      await boxed(value);
    };
    await page.evaluate(() => window.incise.views.scene.goTo([0, 30, 0]));
    assert.equal((await camera()).isWhole, false);
    await setBox(kSmallBox);
    assert.equal((await camera()).isWhole, true);
    await page.evaluate(() => window.incise.views.scene.zoomBy(0.4));
    const before = await camera();
    await setBox(null);
    const after = await camera();
    assert.ok(Math.abs(after.scale / before.scale - 1) < 1e-6, `${after.scale} and ${before.scale} px per mm`);
    assert.deepEqual([after.target, after.isWhole], [before.target, true]);
    await look(page, "Oblique");
  });

  await step("what the region box has cut off has a colour of its own", async () => {
    await studio.call("change", {revision: await stateOf(page, "case.revision"), set: {"ct.roi_box_mm": kBox}});
    await boxed(kBox);
    const {drawn, marked, all, at} = await page.evaluate(() => {
      const {skin, cut} = window.incise.state.tissue,
        triangles = ({objects}) => objects[0].geometry.index.count / 3;
      const layers = ["tissue", "cut-faces"].map((name) => window.incise.views.scene.layers.get(name));
      const corners = [...cut.keys()].filter((k) => cut[k]).map((k) => skin.triangles[3 * k]);
      const places = corners.map((v) => [...skin.vertices.slice(3 * v, 3 * v + 3)]);
      const middle = [1, 2].map((axis) => places.reduce((sum, place) => sum + place[axis], 0) / places.length);
      const off = ([, y, z]) => Math.hypot(y - middle[0], z - middle[1]);
      return {
        drawn: layers.map(triangles),
        marked: places.length,
        all: skin.triangles.length / 3,
        at: places.sort((one, other) => off(one) - off(other))[0],
      };
    });
    assert.ok(marked > 100 && marked < 0.5 * all, `${marked} of ${all} triangles`);
    assert.deepEqual(drawn, [all - marked, marked]);
    assert.ok(Math.abs(at[0] - kBox[1][0]) < 1, `${at} on the left face`);
    assert.equal(await page.locator(".legend label:has-text('cut off by the region')").count(), 1);
    await look(page, "Left");
    const [red, green, blue] = await scenePixel(page, at);
    assert.ok(blue > red, `slate where the box cuts: ${[red, green, blue]}`);
    await look(page, "Oblique");
  });

  await step("an edge that lies on it is said to, and what of a margin does is a line of its own", async () => {
    await goTo(page, "edge");
    await settle(page, "edge");
    await typeAll(page, "ellipse", "Middle, mm", [-1.2, -8, 20]); // 18 mm wide
    await page.click("[data-do=drop]");
    await page.waitForSelector("[data-edge-on-cut]");
    const {edge_on_cut_face: count, greatest_margin_mm: greatest} = await stateOf(page, "room"),
      text = await page.textContent("[data-section=room] [role=status]");
    assert.ok(count > 1 && greatest === null, `${count} points, ${greatest} mm`);
    assert.match(text, /The tumour's edge itself lies where .* Draw the edge elsewhere, or make the region box/);
    assert.ok(text.includes(`${count} points of the edge lie where the region box`), text);
    await page.click("button:text-is('Start again')");
    const lines = await page.evaluate(async () => {
      const {partsOfRing} = await import("/page/room.js"),
        ring = [0, 1, 2, 3, 4, 5].map((x) => [x, 0, 0]);
      const {free, cut} = partsOfRing({ring, on_cut_face: [0, 0, 1, 1, 0, 0]});
      return [free, cut].map((list) => list.map((line) => line.map(([x]) => x)));
    });
    assert.deepEqual(lines, [[[0, 1], [4, 5, 0]], [[1, 2, 3, 4]]]);
    await goTo(page, "see");
  });

  await step("and so it has in the steps after it, on the body at rest and stretched", async () => {
    await studio.call("change", {revision: await stateOf(page, "case.revision"), set: {"ct.roi_box_mm": kBackBox}});
    await boxed(kBackBox);
    // {drawn, marked}: triangles of each layer, and of the body in all and on the cut; {least}: of the cut's y, mm.
    const cutIn = (name) =>
      page.evaluate((own) => {
        const {body} = window.incise.state,
          layers = [own, "cut-faces"].map((key) => window.incise.views.scene.layers.get(key));
        const [, {geometry}] = layers.map(({objects}) => objects[0]),
          at = geometry.getAttribute("position");
        const marked = body.cut.reduce((sum, flag) => sum + flag, 0);
        return {
          drawn: layers.map(({objects}) => objects[0].geometry.index.count / 3),
          marked: [body.cut.length - marked, marked],
          least: geometry.index.array.reduce((low, v) => Math.min(low, at.getY(v)), Infinity),
        };
      }, name);
    await goTo(page, "hold");
    await fresh(page, "body");
    await page.click("[data-do=stretch]");
    await fresh(page, "stretch");
    for (const [name, layer] of Object.entries({hold: "body", plan: "tissue", run: "tissue", compare: "tissue"})) {
      await goTo(page, name);
      await idle(page);
      const {drawn, marked, least} = await cutIn(layer);
      assert.ok(marked[1] > 4 && marked[1] < marked[0], `${name}: ${marked}`);
      assert.deepEqual(drawn, marked, name);
      assert.ok(Math.abs(least - kBackBox[1][1]) < 4, `${name}: from y = ${least} mm on, where the clamp holds it`);
      assert.equal(await page.locator(".legend label:has-text('cut off by the region')").count(), 1, name);
    }
    await goTo(page, "see");
    await studio.call("change", {revision: await stateOf(page, "case.revision"), set: {"ct.roi_box_mm": kBox}});
    await boxed(kBox);
    page.complaints.splice(0); // whether a path fits on this tissue is another matter
  });

  await step("a face of the box that is dragged is written once, when it is let go, and undone in one go", async () => {
    const calls = watchCalls(page),
      from = await pixelIn(page, "axial", [kBox[1][0], 0, (await stateOf(page, "cross"))[2]]),
      pixels = await page.evaluate(() => window.incise.views.axial.zoom),
      shown = page.locator('[data-section=box] fieldset:has(> legend:text-is("High corner, mm")) input').first();
    const dragBy = async (...ways) => {
      await page.mouse.move(...from);
      await page.mouse.down();
      for (const way of ways) {
        await page.mouse.move(from[0] + way * pixels, from[1], {steps: 8});
        await until(page, (x) => Math.abs(window.incise.views.axial.model.box[1][0] - x) < 0.3, kBox[1][0] + way);
        assert.ok(Math.abs(Number(await shown.inputValue()) - kBox[1][0] - way) < 0.3, "its number follows");
        assert.deepEqual(await box(), kBox, "the case keeps its box");
      }
    };
    await page.focus("[data-view=axial] canvas");
    await page.keyboard.press("Escape"); // puts the brush away
    await dragBy(3, 6);
    await page.mouse.up();
    await until(page, (x) => window.incise.state.case.settings.ct.roi_box_mm[1][0] > x + 5, kBox[1][0]);
    await fresh(page, "tissue");
    assert.deepEqual(calls.splice(0), ["change", "tissue"]);
    const dragged = await box();
    await page.keyboard.press("Control+z");
    await boxed(kBox);
    await page.click("[data-section=box] [data-do=redo]");
    await boxed(dragged);

    // Undone during another drag: what is under the pointer is nothing to redo.
    const [x, y] = await pixelIn(page, "axial", [dragged[1][0], 0, (await stateOf(page, "cross"))[2]]);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 2 * pixels, y, {steps: 4});
    await until(page, () => window.incise.state.preview["ct.roi_box_mm"]);
    await page.keyboard.press("Control+z");
    await boxed(kBox);
    await page.keyboard.press("Escape");
    await page.mouse.up();
    await boxed(kBox);
    await page.click("[data-section=box] [data-do=redo]");
    await boxed(dragged);
    await page.click("[data-section=box] [data-do=undo]");
    await boxed(kBox);
    calls.length = 0;

    // Back where it was, or broken off: there is nothing to write.
    await dragBy(5, 0);
    await page.mouse.up();
    const canvas = page.locator("[data-view=axial] canvas");
    const breaks = [
      () => canvas.dispatchEvent("pointercancel", {pointerId: 1}),
      () => canvas.evaluate((node) => node.releasePointerCapture(1)),
      () => page.keyboard.press("Escape"),
      () => page.evaluate(() => document.querySelector("[data-go=photograph]").click()), // where there are no slices
    ];
    for (const breakOff of breaks) {
      await dragBy(5);
      await breakOff();
      await page.mouse.move(from[0] + 8 * pixels, from[1], {steps: 4});
      await until(page, (high) => window.incise.views.axial.model.box[1][0] === high, kBox[1][0]);
      await page.mouse.up();
      await idle(page);
      assert.deepEqual(await stateOf(page, "preview"), {});
      assert.deepEqual(calls, [], `${breakOff}`);
    }
    await goTo(page, "see");
    await fresh(page, "tissue");
    await page.click("button:text-is('Remove the box')");
    await boxed(null);
    assert.deepEqual(await stateOf(page, "tissue.summary"), found);
    assert.equal(await page.locator(".legend label:has-text('cut off by the region')").count(), 0);
  });

  await step("a patch painted on the skin holds its vertices", async () => {
    await studio.call("change", {revision: await stateOf(page, "case.revision"), set: {"tumor.surface": null}});
    await goTo(page, "hold");
    await fresh(page, "body");
    for (const count of [1, 2]) {
      await page.click("[data-add=fixed]"); // the first holds the back
      await until(page, (n) => (window.incise.state.case.settings.specimen.constraints || []).length === n, count);
    }
    await page.locator(".hold >> nth=1").locator("select").first().selectOption("patch");
    await look(page, "Top");
    await drag(page, "scene", kLine.map((at) => [...at, 30]));
    await until(page, () => (window.incise.state.case.settings.specimen.constraints[1].where || {}).patch);
    await fresh(page, "body");
    const [, held] = await stateOf(page, "body.constraints"),
      {path_mm: line} = await stateOf(page, "case.settings.specimen.constraints.1.where.patch");
    assert.ok(held.vertices > 5, `${held.vertices} vertices`);
    const nearest = (at) => Math.min(...line.map((point) => Math.hypot(point[0] - at[0], point[1] - at[1])));
    for (const at of kLine) assert.ok(nearest(at) < 2.6, `${at}: ${nearest(at)} mm`);
    const beside = await scenePixel(page, [line[0][0] - 1.5, line[0][1], line[0][2]]);
    assert.ok(beside[0] > beside[2] + 60, `orange beside the line: ${beside}`);
    assert.match(caseText(), /patch:/);
    await assertAccessible(page, "a painted patch");
  });

  await step("a cleared patch is in the case until it has a point again, the crosshair's for instance", async () => {
    const before = await stateOf(page, "case.revision");
    await page.click("[data-do=clear-patch]");
    await page.waitForSelector("[data-patch='0']");
    assert.equal(await stateOf(page, "case.revision"), before);
    await page.focus("[data-do=patch-crosshair]");
    await page.keyboard.press("Enter");
    await page.waitForSelector("[data-patch='1']");
    await idle(page);
    assert.equal((await stateOf(page, "case.settings.specimen.constraints.1.where.patch.path_mm")).length, 1);
    await page.click("[data-patch] summary");
    await page.click("[aria-label='Remove point 1']");
    await page.waitForSelector("[data-patch='0']");
  });

  await step("a label volume opens as a case, with the same tissue", async () => {
    await goTo(page, "open");
    await choose(page, "labels.nrrd");
    await page.selectOption("[data-section=create] select >> nth=0", "labels");
    await assertAccessible(page, "a case from labels");
    await page.click("[data-do=create]");
    await page.waitForSelector(".page[data-step=see]");
    await fresh(page, "tissue");
    const summary = await stateOf(page, "tissue.summary");
    assert.ok(Math.abs(summary.volume_mm3 / found.volume_mm3 - 1) < 0.02, `${summary.volume_mm3} mm3`);
    assert.equal(await page.locator("[data-label]").count(), 1);
    assert.equal(await page.locator("[data-section=window]").count(), 0);
  });

  await step("labels are tissue or not, as they are checked", async () => {
    await goTo(page, "open");
    await choose(page, "two.seg.nrrd");
    await page.click("[data-do=create]");
    await page.waitForSelector(".page[data-step=see]");
    await fresh(page, "tissue");
    for (const [value, voxels] of Object.entries(counts)) {
      const row = page.locator(`[data-label='${value}']`);
      assert.match((await row.textContent()).replace(/\s/g, ""), new RegExp(`Label${value}${voxels}voxels`));
      assert.ok(await row.locator("input").isChecked());
    }
    const both = await stateOf(page, "tissue.summary");
    await page.uncheck("[data-label='7'] input");
    await until(page, () => window.incise.state.case.settings.ct.label_values);
    await fresh(page, "tissue");
    assert.deepEqual(await stateOf(page, "case.settings.ct.label_values"), [3]);
    assert.ok(await page.locator("[data-label='3'] input").isDisabled(), "one label stays");
    const one = await stateOf(page, "tissue.summary"),
      share = one.voxels / both.voxels;
    assert.ok(Math.abs(share - counts[3] / (counts[3] + counts[7])) < 0.05, `${share} of both`);
    await page.check("[data-label='7'] input");
    await until(page, () => !window.incise.state.case.settings.ct.label_values);
    await fresh(page, "tissue");
    assert.deepEqual(await stateOf(page, "tissue.summary"), both);
  });

  await step("a surface is meshed, and a mesh taken as it is", async () => {
    await goTo(page, "open");
    await choose(page, "block.stl");
    await page.click("[data-do=create]");
    await page.waitForSelector("[data-section=mesh]");
    await fresh(page, "body");
    const tets = await stateOf(page, "body.tets");
    assert.ok(tets > 100, `${tets} tets`);
    fs.copyFileSync(path.join(folder, "block_case", "body.vtu"), path.join(folder, "body.vtu"));
    await goTo(page, "open"); // lists the folder as it is now
    await choose(page, "body.vtu");
    await page.click("[data-do=create]");
    await page.waitForSelector("[data-section=mesh]");
    await fresh(page, "body");
    assert.equal(await stateOf(page, "body.tets"), tets);
  });

  await step("on a phone nothing has to be moved sideways", async () => {
    await page.setViewportSize({width: 390, height: 844});
    for (const name of ["open", "see", "hold"]) {
      await goTo(page, name);
      await idle(page);
      await assertNoSideways(page, name);
    }
  });

  await step("nothing was complained of", async () => {
    assert.deepEqual(page.complaints, []);
  });
});

test("what is set, typed, dragged or painted for a case never reaches another", async (t) => {
  const folder = temporaryFolder(t),
    step = chain(t),
    first = writePhantom(folder, "--format", "nrrd"),
    other = path.join(folder, "other");
  replaceIn(path.join(first, "case.yaml"), /^ct:$/m, `ct:\n  roi_box_mm: ${JSON.stringify(kBox)}`);
  fs.cpSync(first, other, {recursive: true});
  replaceIn(path.join(other, "case.yaml"), /title: .*/, "title: Another one");
  const texts = () => [first, other].map((inside) => fs.readFileSync(path.join(inside, "case.yaml"), "utf8")),
    before = texts();
  const {studio, browser, page} = await openedStudio(t, folder, "specimen"),
    calls = watchCalls(page),
    greatest = inputIn(page, "window", "greatest"),
    x = page.locator("[data-section=box] fieldset input").first();
  const isOpen = (name) =>
    until(page, (text) => window.incise.state.case.file.includes(text) && window.incise.state.scan, `/${name}/`);
  const settled = async (name) => {
    await isOpen(name);
    await fresh(page, "tissue");
    assert.deepEqual(await stateOf(page, "preview"), {});
  };
  const openElsewhere = async (name) => {
    const {answer} = await studio.call("files");
    await studio.call("open", {file: answer.entries.find((entry) => entry.name === name).id});
    await isOpen(name);
  };
  const openHere = async (name) => {
    await goTo(page, "open");
    await page.click(`[data-file="${name}"]`);
    await until(page, () => window.incise.state.busy.open);
    await goTo(page, "see");
  };
  const at = async (...place) => pixelIn(page, "axial", [...place, (await stateOf(page, "cross"))[2]]);
  await settled("specimen");

  await step("a face that is dragged while another client opens a case", async () => {
    await page.mouse.move(...(await at(kBox[1][0], 0)));
    await page.mouse.down();
    await page.mouse.move(...(await at(kBox[1][0] + 5, 0)), {steps: 4});
    await until(page, () => window.incise.state.preview["ct.roi_box_mm"]);
    await openElsewhere("other");
    await page.mouse.move(...(await at(kBox[1][0] + 9, 0)), {steps: 4});
    await page.mouse.up();
    await settled("other");
    assert.deepEqual(texts(), before);
  });

  await step("a stroke that is painted meanwhile", async () => {
    await page.click("[data-do=brush-take]");
    await page.mouse.move(...(await at(...kFrom)));
    await page.mouse.down();
    await page.mouse.move(...(await at(...kTo)), {steps: 4});
    await openElsewhere("specimen");
    assert.equal(await page.evaluate(() => window.incise.views.axial.model.stroke.length), 0);
    await page.mouse.up();
    await settled("specimen");
    assert.deepEqual(texts(), before);
  });

  await step("a number that is half typed", async () => {
    await greatest.fill("171");
    await openElsewhere("other");
    assert.equal(Number(await greatest.inputValue()), await stateOf(page, "case.settings.ct.window_hu.1"));
    assert.equal(await page.evaluate(() => document.activeElement.tagName), "H2", "the heading has the focus");
    assert.deepEqual(texts(), before);
    assert.ok(!calls.includes("change"));
  });

  await step("what waits for a change that is under way", async () => {
    let held = null;
    await page.route("**/api/call/change", (route) => (held ? route.continue() : (held = route)));
    await type(greatest, 172);
    await until(page, () => window.incise.state.busy.change);
    await x.focus();
    await page.keyboard.press("ArrowUp");
    await type(greatest, 173);
    await openElsewhere("specimen");
    await held.continue();
    await until(page, () => !window.incise.state.busy.change);
    await settled("specimen");
    assert.deepEqual(texts(), before);
    assert.equal(calls.filter((name) => name === "change").length, 1);
    assert.deepEqual(page.complaints.splice(0), ["answer 409: /api/call/change"]);
    await page.unroute("**/api/call/change");
  });

  await step("what is set while the page opens another", async () => {
    calls.length = 0;
    const answer = new Promise((resolve) => {
      page.route("**/api/call/open", async (route) => {
        const response = await route.fetch(); // the server has opened it
        resolve(() => route.fulfill({response}));
      });
    });
    await openHere("other");
    await type(greatest, 174);
    await x.focus();
    await page.keyboard.press("ArrowUp");
    (await answer)();
    await settled("other");
    assert.ok(!calls.includes("change"), calls.join());
    assert.deepEqual(texts(), before);
    await page.unroute("**/api/call/open");
  });

  await step("but where that fails, it is sent to the case that stays", async () => {
    let held = null;
    await page.route("**/api/call/open", (route) => (held = route));
    await openHere("specimen");
    await type(greatest, 175);
    assert.ok(!calls.includes("change"));
    await held.fulfill({status: 422, json: {problem: {path: "", found: "", expected: "", hint: "", message: "No."}}});
    await until(page, () => window.incise.state.case.settings.ct.window_hu[1] === 175);
    await settled("other");
    assert.equal(texts()[0], before[0]);
    assert.deepEqual(page.complaints.splice(0), ["answer 422: /api/call/open"]);
    await page.unroute("**/api/call/open");
  });

  await step("a cloud for practice that is made for the case before is not chosen", async () => {
    const answer = new Promise((resolve) => {
      page.route("**/api/call/virtual_cloud", (route) =>
        resolve(() => route.fulfill({json: {file: "f1", name: "virtual_cloud.ply", points: 1}})),
      );
    });
    await page.evaluate(async () => {
      const {makeCloud} = await import("/page/actions.js");
      window.cloudIsMade = makeCloud(1);
    });
    const give = await answer;
    await openElsewhere("specimen");
    await give();
    await page.evaluate(() => window.cloudIsMade);
    assert.equal(await stateOf(page, "cloud.file"), null);
    await page.unroute("**/api/call/virtual_cloud");
    await openElsewhere("other");
    await settled("other");
  });

  await step("a value that was stepped just before the page goes away is kept", async () => {
    const next = await newPage(browser);
    await openStudio(next, studio);
    await page.clock.install();
    await page.clock.pauseAt(Date.now() + 60_000); // it would wait for ever
    await x.focus();
    await page.keyboard.press("ArrowUp");
    await page.goto("about:blank");
    await until(next, (low) => window.incise.state.case.settings.ct.roi_box_mm[0][0] === low, kBox[0][0] + 1);
    await fresh(next, "tissue");
    assert.deepEqual([...page.complaints, ...next.complaints], []);
  });
});
