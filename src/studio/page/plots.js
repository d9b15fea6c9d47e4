// Curves over the length of the path, drawn by uPlot.

import {h} from "preact";
import {useEffect, useRef} from "preact/hooks";
import UPlot from "uplot";
import {isDark} from "./colours.js";
import {fixed, isNumber} from "./words.js";

const kLegend = 34; // px, of a legend of one line

function colours() {
  return isDark() ? {words: "#a9b1b8", grid: "#333a41"} : {words: "#565d65", grid: "#e2e3df"};
}

/** Puts curves with places of their own onto one list of places, straight between them; null beyond their ends. */
export function onOneScale(curves) {
  const places = [...new Set(curves.flatMap((curve) => curve.x))].sort((a, b) => a - b);
  return [places, ...curves.map((curve) => resampled(curve, places))];
}

function resampled({x, y}, places) {
  let k = 0;
  return places.map((at) => {
    while (k < x.length - 2 && x[k + 1] < at) ++k;
    if (!x.length || at < x[0] || at > x[x.length - 1]) return null;
    if (x.length === 1 || x[k + 1] === x[k]) return y[k];
    return y[k] + ((y[k + 1] - y[k]) * (at - x[k])) / (x[k + 1] - x[k]);
  });
}

function axis(label, size) {
  const {words, grid} = colours();
  return {
    label,
    size,
    labelSize: 18,
    stroke: words,
    font: "11px system-ui",
    labelFont: "11px system-ui",
    grid: {stroke: grid, width: 1},
    ticks: {stroke: grid, width: 1, size: 4},
  };
}

function options(title, unit, curves, size) {
  const value = (_, number) => (isNumber(number) ? `${fixed(number, 2)} mm` : "–");
  return {
    ...size,
    legend: {live: true, markers: {dash: (_, k) => (k && curves[k - 1].dash ? "dashed" : "solid")}},
    cursor: {points: {size: 6}, drag: {x: false, y: false}},
    scales: {x: {time: false}},
    axes: [axis("along the path, mm", 38), axis(unit, 48)],
    series: [
      {label: "at", value},
      ...curves.map((curve) => ({
        label: curve.label,
        stroke: curve.colour,
        width: curve.width || 1.8,
        dash: curve.dash,
        points: {show: false},
        value,
      })),
    ],
  };
}

/** A plot. @param curves  [{label, colour, dash, x, y}]; x in mm along the path, y in mm */
export function Plot({title, unit, curves, id}) {
  const host = useRef(null);
  useEffect(() => {
    const node = host.current;
    const room = (below) => ({
      width: Math.max(200, node.clientWidth),
      height: Math.max(110, node.clientHeight - below),
    });
    const plot = new UPlot(options(title, unit, curves, room(kLegend)), onOneScale(curves), node);
    const legend = node.querySelector(".u-legend");
    // With many curves the legend has several lines; its width follows the plot's, so that comes first.
    const fit = () => {
      plot.setSize(room(kLegend));
      plot.setSize(room(Math.max(kLegend, legend.offsetHeight + 6)));
    };
    const watch = new ResizeObserver(fit);
    watch.observe(node);
    fit();
    node.dataset.ready = "yes";
    return () => {
      watch.disconnect();
      plot.destroy();
    };
  }, [curves, isDark()]);
  return h(
    "figure",
    {class: "plot", "data-plot": id},
    h("figcaption", null, title),
    h("div", {ref: host, class: "plot-host", role: "img", "aria-label": summaryOf(title, curves)}),
  );
}

function summaryOf(title, curves) {
  const ranges = curves.map(({label, y}) => `${label}: ${fixed(Math.min(...y), 2)} to ${fixed(Math.max(...y), 2)} mm`);
  return `${title}. ${ranges.join("; ")}.`;
}
