// What makes the page quick, counted: what is drawn and sent, and in which order. No verdict depends on time.

import assert from "node:assert/strict";
import {test} from "node:test";
import {
  chain,
  fresh,
  goTo,
  inputIn,
  openedStudio,
  stateOf,
  temporaryFolder,
  type,
  until,
  watchCalls,
  writePhantom,
} from "./support.mjs";

const kSlices = ["axial", "coronal", "sagittal"];

/** Counts from here on how often each view is drawn, and how often each slice was when the 3D view was drawn first. */
function countDrawings(page) {
  return page.evaluate(
    async (names) => {
      const {views} = window.incise;
      const frame = () => new Promise((done) => requestAnimationFrame(done));
      for (let k = 0; k < 4; ++k) await frame(); // what was to be drawn is
      const before = names.map((name) => views[name].drawnCount);
      const drawn = () => names.map((name, k) => views[name].drawnCount - before[k]);
      const counts = {scene: 0, calls: 0, slicesBefore: null};
      const draw = Object.getPrototypeOf(views.scene).draw;
      views.scene.draw = () => {
        counts.slicesBefore ||= drawn();
        draw.call(views.scene);
        counts.scene += 1;
        counts.calls = views.scene.renderer.info.render.calls;
      };
      window.counted = async () => {
        for (let k = 0; k < 4; ++k) await frame();
        return {...counts, slices: drawn()};
      };
    },
    kSlices,
  );
}

const counted = (page) => page.evaluate(() => window.counted());

/** Sets settings past the panel's inputs, all in one turn of the page. */
function change(page, ...sets) {
  return page.evaluate(async (list) => {
    const actions = await import("/page/actions.js");
    for (const set of list) actions.change(set);
  }, sets);
}

test("the page draws and sends no more than is needed", async (t) => {
  const folder = temporaryFolder(t),
    step = chain(t);
  writePhantom(folder, "--format", "nrrd");
  const {page} = await openedStudio(t, folder, "specimen");
  await goTo(page, "see");
  await fresh(page, "tissue");
  const sent = watchCalls(page);

  await step("tissue that changes is drawn once in each view, in the slices first", async () => {
    const [, greatest] = await stateOf(page, "case.settings.ct.window_hu");
    await countDrawings(page);
    await type(inputIn(page, "window", "greatest"), greatest + 5);
    await until(page, (wanted) => window.incise.state.case.settings.ct.window_hu[1] === wanted, greatest + 5);
    await fresh(page, "tissue");
    const {slices, slicesBefore, scene} = await counted(page);
    assert.deepEqual(slices, [1, 1, 1]);
    assert.equal(scene, 1);
    assert.deepEqual(slicesBefore, [1, 1, 1]);
    assert.deepEqual(sent.splice(0), ["change", "tissue"]);
  });

  await step("what is set together is sent together, and so is what is set while a change is under way", async () => {
    sent.length = 0;
    let held = null;
    await page.route("**/api/call/change", (route) => (held ? route.continue() : (held = route)));
    const radius = (mm) => ({"ct.opening_radius_mm": mm});
    await change(page, radius(1), {"ct.smoothing_mm": 0.5});
    await until(page, () => window.incise.state.busy.change === 1);
    for (const mm of [1.5, 2, 2.5]) await change(page, radius(mm));
    assert.deepEqual(sent, ["change"]);
    assert.deepEqual(held.request().postDataJSON().set, {...radius(1), "ct.smoothing_mm": 0.5});
    await held.continue();
    await until(page, () => window.incise.state.case.settings.ct.opening_radius_mm === 2.5);
    await fresh(page, "tissue");
    assert.deepEqual(sent.splice(0), ["change", "change", "tissue"]);
    await page.unroute("**/api/call/change");
  });

  await step("turning is one drawing of few calls for a picture", async () => {
    await countDrawings(page);
    await page.evaluate(() => {
      for (let k = 0; k < 5; ++k) window.incise.views.scene.turn(4, 1);
    });
    const {scene, calls, slices} = await counted(page);
    assert.equal(scene, 1);
    assert.ok(calls > 0 && calls < 20, `${calls} calls`);
    assert.deepEqual(slices, [0, 0, 0]);
  });

  await step("a plan that changes is drawn, and no slice with it", async () => {
    await goTo(page, "plan");
    await fresh(page, "plan");
    const depth = await stateOf(page, "plan.path.depth_mm");
    await countDrawings(page);
    await type(inputIn(page, "plan", "Depth"), 2.5);
    await until(page, () => window.incise.state.case.settings.plan.depth_mm === 2.5);
    await fresh(page, "plan");
    assert.notDeepEqual(await stateOf(page, "plan.path.depth_mm"), depth);
    const {slices, scene} = await counted(page);
    assert.ok(scene > 0);
    assert.deepEqual(slices, [0, 0, 0]);
  });

  assert.deepEqual(page.complaints, []);
});
