"use strict";
// Starts what the page has room for. Whatever fails leaves its still picture in place and says so.

window.addEventListener("error", (event) => { document.documentElement.dataset.scriptError = event.message; });

/** The slider under the axial slice. */
function startSlices(plane) {
  const figure = document.getElementById("axial");
  if (!figure || plane.slices.length < 2) return;
  const image = figure.querySelector("image"), outline = figure.querySelector("path.outline");
  const place = figure.querySelector(".place");
  const show = (k) => {
    const slice = plane.slices[k];
    image.setAttribute("href", slice.image);
    if (outline) outline.setAttribute("d", slice.outline);
    place.textContent = `${plane.axis} = ${slice.position_mm.toFixed(1)} mm`;
    slider.setAttribute("aria-valuetext", place.textContent);
  };
  const slider = element("input", {type: "range", min: 0, max: plane.slices.length - 1, step: 1, "aria-label": "Axial slice",
                                   value: plane.middle, oninput: () => show(Number(slider.value))});
  show(plane.middle);
  figure.querySelector(".slice-control").append(slider);
}

function startOutlineSwitch() {
  const box = document.getElementById("outline-switch");
  if (!box) return;
  box.parentElement.classList.remove("hidden");
  box.onchange = () => document.querySelectorAll("path.outline").forEach((path) => {
    path.style.display = box.checked ? "" : "none";
  });
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
startOutlineSwitch();
if (report.axial) startSlices(report.axial);
if (report.mesh) startView("mesh-view", (host) => new MeshView(host, report.mesh, report.view));
if (report.animations.length) startView("cut-view", (host) => new CutView(host, report.animations, report.view));
document.documentElement.dataset.pageReady = "yes";
