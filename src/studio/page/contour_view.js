// The contours of one cut, seen along the approach, with a scale bar.

import {h} from "preact";
import {useEffect, useRef} from "preact/hooks";
import {dot, letterOf, plus, pointsOf, roundedDown, viewAlong} from "./geometry.js";
import {isDark} from "./colours.js";

/** {low, high}: the rectangle about curves in the picture's right and up, mm. */
export function boundsOf(curves, direction) {
  const {right, up} = viewAlong(direction);
  const flat = curves.flatMap((curve) => pointsOf(curve.points).map((point) => [dot(point, right), dot(point, up)]));
  const range = (k) => flat.map((point) => point[k]);
  return {low: [Math.min(...range(0)), Math.min(...range(1))], high: [Math.max(...range(0)), Math.max(...range(1))]};
}

/** A picture of curves. @param curves  [{label, colour, width, dash, points, isClosed}]
 *  @param bounds  of the picture, so that two pictures share one scale; @param mark  a point to ring, or null */
export function ContourView({title, curves, direction, bounds, mark, id}) {
  const host = useRef(null);
  useEffect(() => {
    const room = host.current, // the observer may report once more after the component is gone
      canvas = room.querySelector("canvas");
    const draw = () => drawAll(room, canvas, {curves, direction, bounds, mark});
    const watch = new ResizeObserver(draw);
    watch.observe(room);
    draw();
    return () => watch.disconnect();
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
      shown.map((curve) => h("li", {key: curve.label}, h(Swatch, {curve}), curve.label)),
    ),
  );
}

function Swatch({curve}) {
  return h(
    "svg",
    {class: "swatch-line", viewBox: "0 0 22 6", "aria-hidden": "true"},
    h("line", {
      x1: 0,
      y1: 3,
      x2: 22,
      y2: 3,
      stroke: curve.colour,
      "stroke-width": curve.width || 2,
      "stroke-dasharray": (curve.dash || []).join(" "),
    }),
  );
}

function drawAll(host, canvas, {curves, direction, bounds, mark}) {
  const width = host.clientWidth,
    height = host.clientHeight,
    ratio = Math.min(2, window.devicePixelRatio || 1);
  if (!width || !height) return;
  Object.assign(canvas, {width: width * ratio, height: height * ratio});
  const pen = canvas.getContext("2d");
  pen.scale(ratio, ratio);
  const {right, up} = viewAlong(direction);
  const span = [0, 1].map((k) => Math.max(1, bounds.high[k] - bounds.low[k]));
  const scale = Math.min((width - 56) / span[0], (height - 60) / span[1]);
  const middle = [0, 1].map((k) => 0.5 * (bounds.low[k] + bounds.high[k]));
  const at = (point) => [
    width / 2 + (dot(point, right) - middle[0]) * scale,
    height / 2 - (dot(point, up) - middle[1]) * scale,
  ];
  for (const curve of curves) stroke(pen, pointsOf(curve.points).map(at), curve);
  if (mark) ring(pen, at(mark));
  drawFrame(pen, width, height, scale, right, up);
  host.dataset.ready = "yes";
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
  pen.beginPath();
  for (const [x, y] of [
    [left, bottom - 5],
    [left, bottom],
    [left + bar * scale, bottom],
    [left + bar * scale, bottom - 5],
  ]) {
    pen.lineTo(x, y);
  }
  pen.stroke();
  word(`${Number(bar.toPrecision(2))} mm`, left + 0.5 * bar * scale, bottom - 11, "center");
}
