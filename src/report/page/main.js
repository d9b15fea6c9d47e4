"use strict";
// Starts what the page has room for. Whatever fails leaves its still picture in place and says so.

window.addEventListener("error", (event) => { document.documentElement.dataset.scriptError = event.message; });

/** The slider under the axial slice. */
function startSlices(plane) {
  const figure = document.getElementById("axial");
  if (!figure || plane.slices.length < 2) return;
  const image = figure.querySelector("image");
  const curves = {outline: "outline", tumor: "tumor", planned: "planned-cut"};
  const place = figure.querySelector(".place");
  const show = (k) => {
    const slice = plane.slices[k];
    image.setAttribute("href", slice.image);
    for (const [key, name] of Object.entries(curves)) figure.querySelector(`path.${name}`).setAttribute("d", slice[key]);
    place.textContent = `${plane.axis} = ${slice.position_mm.toFixed(1)} mm`;
    slider.setAttribute("aria-valuetext", place.textContent);
  };
  const slider = element("input", {type: "range", min: 0, max: plane.slices.length - 1, step: 1, value: plane.first,
                                   "aria-label": "Axial slice", oninput: () => show(Number(slider.value))});
  show(plane.first);
  figure.querySelector(".slice-control").append(slider);
}

/** The legend under the slices switches their curves. */
function startCurveSwitches() {
  for (const box of document.querySelectorAll("[data-curve]")) {
    box.onchange = () => document.querySelectorAll(`path.${box.dataset.curve}`).forEach((path) => {
      path.style.display = box.checked ? "" : "none";
    });
  }
}

/** On a phone a long table begins folded. */
function foldTables() {
  if (!window.matchMedia("(max-width: 640px)").matches) return;
  for (const fold of document.querySelectorAll("details.fold")) fold.open = false;
}

/** Two ways to colour the error: the safe one, and jet. */
function startColorSwitch() {
  const buttons = document.querySelectorAll("[data-set-colors]");
  const choose = (name) => {
    document.documentElement.dataset.errorColors = name;
    buttons.forEach((button) => button.setAttribute("aria-pressed", String(button.dataset.setColors === name)));
  };
  buttons.forEach((button) => {
    button.parentElement.classList.remove("hidden");
    button.onclick = () => choose(button.dataset.setColors);
  });
  if (buttons.length) choose("safe");
}

function startView(id, make) {
  const host = document.getElementById(id);
  if (!host) return;
  try {
    make(host);
  } catch (problem) {
    const stage = host.querySelector(".stage");
    stage.classList.remove("live");
    stage.querySelectorAll("canvas, .scale-bar, .gizmo, .clock").forEach((node) => node.remove());
    stage.append(element("div", {className: "message", textContent:
      "The 3D view needs WebGL, which this browser does not offer; this is a still picture."}));
    host.dataset.viewerFailed = String(problem.message || problem);
  }
}

const report = JSON.parse(document.getElementById("report-data").textContent);
startColorSwitch();
startCurveSwitches();
foldTables();
if (report.axial) startSlices(report.axial);
if (report.mesh) startView("mesh-view", (host) => new MeshView(host, report.mesh, report.view));
if (report.animations.length) startView("cut-view", (host) => new CutView(host, report.animations, report.view));
document.documentElement.dataset.pageReady = "yes";
