// A canvas that fills its place, with a picture to be zoomed and moved: what a slice and a photograph share.

import {clamp} from "./geometry.js";

/** A view with draw(), fit() and resize(), which zooms between `zooms`: px of the screen for one of the picture. It
 *  hands events on to press(), move(), release() at `ends`, leave(), roll() and key(). */
export class CanvasView {
  constructor(host, {label, zooms, ends}) {
    Object.assign(this, {host, zooms, zoom: 0, middle: [0, 0], fingers: new Map(), isDirty: false});
    this.canvas = document.createElement("canvas");
    this.readout = document.createElement("output");
    this.readout.className = "readout";
    host.append(this.canvas, this.readout);
    this.listen(label, ends);
    this.watch = new ResizeObserver(() => this.resize());
    this.watch.observe(host);
  }

  listen(label, ends) {
    const {canvas} = this;
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "application");
    canvas.setAttribute("aria-label", label);
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("pointerdown", (event) => this.press(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const name of ends) canvas.addEventListener(name, (event) => this.release(event));
    canvas.addEventListener("pointerleave", () => this.leave());
    canvas.addEventListener("wheel", (event) => this.roll(event), {passive: false});
    canvas.addEventListener("keydown", (event) => this.key(event));
  }

  /** Gives the canvas the size of its place. */
  fill() {
    this.ratio = Math.min(2, window.devicePixelRatio || 1);
    this.canvas.width = Math.max(1, Math.round(this.host.clientWidth * this.ratio));
    this.canvas.height = Math.max(1, Math.round(this.host.clientHeight * this.ratio));
  }

  /** Draws at the next chance, once however often it is asked. */
  render() {
    if (this.isDirty) return;
    this.isDirty = true;
    requestAnimationFrame(() => this.draw());
  }

  half(k) {
    return 0.5 * (k ? this.host.clientHeight : this.host.clientWidth);
  }

  leave() {
    this.readout.textContent = "";
  }

  /** How far apart two fingers are; 0 for one. */
  spread() {
    const [a, b] = [...this.fingers.values()];
    return b ? Math.hypot(a[0] - b[0], a[1] - b[1]) : 0;
  }

  pan(by) {
    this.middle = this.middle.map((value, k) => value - by[k] / this.zoom);
    this.isFitted = false;
    this.render();
  }

  zoomBy(factor, x = this.half(0), y = this.half(1)) {
    const zoom = clamp(this.zoom * factor, ...this.zooms),
      from = [x - this.half(0), y - this.half(1)];
    this.middle = this.middle.map((value, k) => value + from[k] / this.zoom - from[k] / zoom);
    this.zoom = zoom;
    this.isFitted = false;
    this.render();
  }
}

/** Writes a word with a border, so that it is seen on any ground. */
export function writeWord(pen, text, x, y, {colour, border, align = "center"}) {
  pen.font = "600 12px system-ui, sans-serif";
  pen.textAlign = align;
  pen.textBaseline = "middle";
  pen.lineWidth = 3;
  pen.lineJoin = "round";
  pen.strokeStyle = border;
  pen.strokeText(text, x, y);
  pen.fillStyle = colour;
  pen.fillText(text, x, y);
}

/** Begins the path of a scale bar, a line with its ends turned up. */
export function barPath(pen, left, right, bottom) {
  pen.beginPath();
  pen.moveTo(left, bottom - 5);
  pen.lineTo(left, bottom);
  pen.lineTo(right, bottom);
  pen.lineTo(right, bottom - 5);
}
