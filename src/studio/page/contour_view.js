// The contours of one cut, seen along the approach, with a scale bar.

import {h} from "preact";
import {useEffect, useRef} from "preact/hooks";
import {dot, letterOf, plus, pointsOf, roundedDown, viewAlong} from "./geometry.js";
import {barPath} from "./canvas_view.js";
import {isDark} from "./colours.js";

/** {low, high}: the rectangle about curves in the picture's right and up, mm. */
export function boundsOf(curves, direction) {
  const {right, up} = viewAlong(direction);
  const flat = curves.flatMap((curve) => pointsOf(curve.points).map((point) => [dot(point, right), dot(point, up)]));
  const range = (k) => flat.map((point) => point[k]);
  return {low: [Math.min(...range(0)), Math.min(...range(1))], high: [Math.max(...range(0)), Math.max(...range(1))]};
}

// The pictures that are shown, by id: {scale, draw}. They share the least of their scales, px per mm, so that what is
// larger on one of them is larger.
const pictures = new Map();

function shareScale(id, scale, draw) {
  const last = commonScale();
  pictures.set(id, {scale, draw});
  const common = commonScale();
  if (common !== last) for (const [other, picture] of pictures) if (other !== id) picture.draw();
  return common;
}

function commonScale() {
  return Math.min(...[...pictures.values()].map(({scale}) => scale));
}

/** A picture of curves. @param curves  [{label, letter, colour, width, dash, points, isClosed}]; one with a letter has
 *  it on its line   @param bounds  of the picture, the same for those beside it
 *  @param mark  a point to ring, or null */
export function ContourView({title, curves, direction, bounds, mark, id}) {
  const host = useRef(null);
  useEffect(() => {
    const room = host.current, // the observer may report once more after the component is gone
      canvas = room.querySelector("canvas");
    const draw = () => {
      const own = scaleIn(room, bounds);
      if (own > 0) drawAll(room, canvas, {curves, direction, bounds, mark, scale: shareScale(id, own, redraw)});
    };
    const redraw = () => drawAll(room, canvas, {curves, direction, bounds, mark, scale: commonScale()});
    const watch = new ResizeObserver(draw);
    watch.observe(room);
    draw();
    return () => {
      watch.disconnect();
      pictures.delete(id);
    };
  }, [curves, bounds, mark, isDark()]);
  const shown = curves.filter((curve) => pointsOf(curve.points).length > 1);
  return h(
    "figure",
    {class: "contours", "data-contours": id},
    h("figcaption", null, title),
    h(
      "div",
      {class: "contour-host", ref: host},
      h("canvas", {
        role: "img",
        "aria-label": `${title}: ${shown.map((curve) => curve.label).join(", ")}, seen along the approach.`,
      }),
    ),
    h(
      "ul",
      {class: "key"},
      shown.map((curve) =>
        h("li", {key: curve.label, title: curve.label}, h(Swatch, {curve}), h("span", null, curve.label)),
      ),
    ),
  );
}

/** A piece of a curve's line. */
export function Swatch({curve: {colour, width = 2, dash = []}}) {
  const look = {stroke: colour, "stroke-width": width, "stroke-dasharray": dash.join(" ")};
  return h(
    "svg",
    {class: "swatch-line", viewBox: "0 0 22 6", "aria-hidden": "true"},
    h("line", {x1: 0, y1: 3, x2: 22, y2: 3, ...look}),
  );
}

const kRoom = [56, 60]; // px, beside the curves for the letters of the directions and the bar

// The scale with which all curves fit, px per mm; not above 0 where there is no room.
function scaleIn(host, bounds) {
  const span = [0, 1].map((k) => Math.max(1, bounds.high[k] - bounds.low[k]));
  return Math.min((host.clientWidth - kRoom[0]) / span[0], (host.clientHeight - kRoom[1]) / span[1]);
}

function drawAll(host, canvas, {curves, direction, bounds, mark, scale}) {
  const width = host.clientWidth,
    height = host.clientHeight,
    ratio = Math.min(2, window.devicePixelRatio || 1);
  Object.assign(canvas, {width: width * ratio, height: height * ratio});
  const pen = canvas.getContext("2d");
  pen.scale(ratio, ratio);
  const {right, up} = viewAlong(direction);
  const middle = [0, 1].map((k) => 0.5 * (bounds.low[k] + bounds.high[k]));
  const at = (point) => [
    width / 2 + (dot(point, right) - middle[0]) * scale,
    height / 2 - (dot(point, up) - middle[1]) * scale,
  ];
  for (const curve of curves) stroke(pen, pointsOf(curve.points).map(at), curve);
  const lettered = curves.filter((curve) => curve.letter);
  lettered.forEach((curve, k) => letter(pen, pointsOf(curve.points).map(at), curve, (k + 0.5) / lettered.length));
  if (mark) ring(pen, at(mark));
  drawFrame(pen, width, height, scale, right, up);
  Object.assign(host.dataset, {ready: "yes", scale: scale.toFixed(3)});
}

// A curve's letter on it, at a share of its points.
function letter(pen, points, {letter: text, colour}, share) {
  if (points.length < 2) return;
  const [x, y] = points[Math.floor(share * points.length)];
  pen.beginPath();
  pen.arc(x, y, 8, 0, 2 * Math.PI);
  pen.fillStyle = isDark() ? "#1a1e22" : "#ffffff";
  pen.fill();
  pen.lineWidth = 1.5;
  pen.strokeStyle = pen.fillStyle = colour;
  pen.stroke();
  pen.font = "700 11px system-ui, sans-serif";
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  pen.fillText(text, x, y + 0.5);
}

function stroke(pen, points, {colour, width = 2, dash = [], isClosed}) {
  if (points.length < 2) return;
  pen.beginPath();
  for (const point of points) pen.lineTo(...point);
  if (isClosed) pen.closePath();
  pen.setLineDash(dash);
  pen.strokeStyle = colour;
  pen.lineWidth = width;
  pen.lineJoin = "round";
  pen.stroke();
  pen.setLineDash([]);
}

function ring(pen, [x, y]) {
  pen.beginPath();
  pen.arc(x, y, 9, 0, 2 * Math.PI);
  pen.lineWidth = 2.5;
  pen.strokeStyle = isDark() ? "#ff7f9f" : "#b3123f";
  pen.stroke();
}

function drawFrame(pen, width, height, scale, right, up) {
  const colour = isDark() ? "#a9b1b8" : "#565d65";
  pen.fillStyle = pen.strokeStyle = colour;
  pen.font = "600 11px system-ui, sans-serif";
  pen.textBaseline = "middle";
  const word = (text, x, y, align) => {
    pen.textAlign = align;
    pen.fillText(text, x, y);
  };
  word(letterOf(plus([0, 0, 0], right, -1)), 8, height / 2, "left");
  word(letterOf(right), width - 8, height / 2, "right");
  word(letterOf(up), width / 2, 11, "center");
  word(letterOf(plus([0, 0, 0], up, -1)), width / 2, height - 11, "center");
  const bar = roundedDown(70 / scale),
    left = 14,
    bottom = height - 12;
  pen.lineWidth = 2;
  barPath(pen, left, left + bar * scale, bottom);
  pen.stroke();
  word(`${Number(bar.toPrecision(2))} mm`, left + 0.5 * bar * scale, bottom - 11, "center");
}
