// A photograph with the lines found on it, to be zoomed, moved and drawn on.

import {CanvasView, barPath, writeWord} from "./canvas_view.js";
import {clamp, roundedDown} from "./geometry.js";
import {onPhoto} from "./colours.js";
import {tenths} from "./photo_settings.js";

const kReach = 13; // px of the screen: how near to a handle a pointer takes it
const kTouchReach = 24;
const kSmallMove = 5; // px: less is a click

/** The view. A point is [u, v], px. Its model is
 *  {picture, lines, handles, selected, marks, clock, mm_per_pixel, isDrawing}: picture {width, height, rgb}; lines
 *  [{points, colour, isClosed, dash}]; marks: points of the scale; handles: points with numbers; clock
 *  [{at, from, text}]. It calls `on.add(point)`, `on.select(k)`, `on.move(k, point)`, `on.remove(k)`, `on.close()`. */
export class PhotoView extends CanvasView {
  constructor(host, on) {
    super(host, {
      label:
        "Photograph. Arrow keys move it, or the chosen point while a line is drawn; Page Up and Page Down choose a " +
        "point, Delete removes it, Enter closes the line, plus and minus zoom, Home shows all.",
      zooms: [0.02, 60],
      ends: ["pointerup", "pointercancel"],
    });
    Object.assign(this, {on, model: {}, held: -1});
  }

  /** Ends it. */
  close() {
    this.watch.disconnect();
  }

  /** Shows a model. Another picture is shown whole. */
  show(model) {
    const isOther = model.picture !== this.model.picture;
    this.model = model;
    if (isOther) {
      this.image = model.picture && imageOf(model.picture);
      this.fit();
    }
    this.render();
  }

  /** Shows the whole photograph. */
  fit() {
    const {picture} = this.model;
    if (!picture) return;
    this.zoom = 0.97 * Math.min(this.host.clientWidth / picture.width, this.host.clientHeight / picture.height);
    this.middle = [0.5 * (picture.width - 1), 0.5 * (picture.height - 1)];
    this.isFitted = true;
    this.render();
  }

  resize() {
    this.fill();
    if (this.isFitted || !(this.zoom > 0)) this.fit();
    this.render();
  }

  // --- From the photograph's pixels to the screen's and back. ---

  toScreen([u, v]) {
    return [this.half(0) + (u - this.middle[0]) * this.zoom, this.half(1) + (v - this.middle[1]) * this.zoom];
  }

  toPixel(x, y) {
    return [(x - this.half(0)) / this.zoom + this.middle[0], (y - this.half(1)) / this.zoom + this.middle[1]];
  }

  // --- Drawing. ---

  draw() {
    this.isDirty = false;
    const pen = this.canvas.getContext("2d"),
      {picture, lines = [], marks = [], clock = [], handles = []} = this.model;
    pen.setTransform(this.ratio || 1, 0, 0, this.ratio || 1, 0, 0);
    pen.clearRect(0, 0, this.host.clientWidth, this.host.clientHeight);
    if (!picture || !(this.zoom > 0)) return;
    this.drawPicture(pen, picture);
    for (const line of lines) this.drawLine(pen, line);
    for (const mark of clock) this.drawClock(pen, mark);
    for (const mark of marks) this.drawCross(pen, mark, marks.length > 4 ? 2.5 : 5);
    handles.forEach((point, k) => this.drawHandle(pen, point, k));
    this.drawScaleBar(pen);
    this.host.dataset.ready = "yes";
  }

  drawPicture(pen, {width, height}) {
    const [x, y] = this.toScreen([-0.5, -0.5]);
    pen.imageSmoothingEnabled = this.zoom < 4;
    pen.drawImage(this.image, x, y, width * this.zoom, height * this.zoom);
  }

  drawLine(pen, {points, colour, isClosed, dash = []}) {
    if (points.length < 2) return;
    pen.beginPath();
    for (const point of points) pen.lineTo(...this.toScreen(point));
    if (isClosed) pen.closePath();
    pen.lineJoin = "round";
    this.strokeTwice(pen, colour, 2, dash);
  }

  // With a dark border, so that it is seen on tissue, ink and paper alike.
  strokeTwice(pen, colour, width, dash = []) {
    pen.setLineDash([]);
    pen.strokeStyle = onPhoto.border;
    pen.lineWidth = width + 2;
    pen.stroke();
    pen.setLineDash(dash);
    pen.strokeStyle = colour;
    pen.lineWidth = width;
    pen.stroke();
    pen.setLineDash([]);
  }

  drawCross(pen, point, size) {
    const [x, y] = this.toScreen(point);
    pen.beginPath();
    for (const [dx, dy] of [
      [1, 1],
      [1, -1],
    ]) {
      pen.moveTo(x - size * dx, y - size * dy);
      pen.lineTo(x + size * dx, y + size * dy);
    }
    this.strokeTwice(pen, onPhoto.scale, 1.5);
  }

  drawHandle(pen, point, k) {
    const [x, y] = this.toScreen(point),
      isChosen = k === this.model.selected;
    pen.beginPath();
    pen.arc(x, y, isChosen ? 6.5 : 4.5, 0, 2 * Math.PI);
    pen.fillStyle = isChosen ? onPhoto.chosen : onPhoto.handle;
    pen.fill();
    pen.strokeStyle = onPhoto.border;
    pen.lineWidth = 1.5;
    pen.stroke();
    this.word(pen, String(k + 1), x + 9, y - 9, isChosen ? onPhoto.chosen : onPhoto.handle);
  }

  /** A mark of the clock: a tick outwards from the incision, with its hour. */
  drawClock(pen, {at, from, text}) {
    const [x, y] = this.toScreen(at),
      [fx, fy] = this.toScreen(from);
    const far = Math.max(1, Math.hypot(x - fx, y - fy)),
      out = [(x - fx) / far, (y - fy) / far];
    pen.beginPath();
    pen.moveTo(x, y);
    pen.lineTo(x + 12 * out[0], y + 12 * out[1]);
    this.strokeTwice(pen, onPhoto.words, 1.5);
    this.word(pen, text, x + 24 * out[0], y + 24 * out[1], onPhoto.words);
  }

  drawScaleBar(pen) {
    const mm = this.model.mm_per_pixel;
    if (!mm) return;
    const bar = roundedDown((Math.max(60, 0.18 * this.host.clientWidth) / this.zoom) * mm);
    const right = this.host.clientWidth - 14,
      left = right - (bar / mm) * this.zoom,
      bottom = this.host.clientHeight - 14;
    barPath(pen, left, right, bottom);
    this.strokeTwice(pen, onPhoto.words, 2);
    this.word(pen, `${Number(bar.toPrecision(2))} mm`, 0.5 * (left + right), bottom - 13, onPhoto.words);
  }

  word(pen, text, x, y, colour) {
    writeWord(pen, text, x, y, {colour, border: onPhoto.border});
  }

  // --- Mouse, touch and keyboard. ---

  handleAt(x, y, reach) {
    const away = (this.model.handles || []).map((point) => {
      const [px, py] = this.toScreen(point);
      return Math.hypot(px - x, py - y);
    });
    const nearest = away.indexOf(Math.min(...away));
    return away[nearest] <= reach ? nearest : -1;
  }

  press(event) {
    if (!this.model.picture) return;
    this.canvas.focus({preventScroll: true});
    this.canvas.setPointerCapture(event.pointerId);
    const {offsetX: x, offsetY: y} = event;
    this.fingers.set(event.pointerId, [x, y]);
    this.travel = this.fingers.size > 1 ? Infinity : 0;
    const isMain = event.button === 0 && !event.shiftKey && this.fingers.size === 1;
    this.held = isMain ? this.handleAt(x, y, event.pointerType === "touch" ? kTouchReach : kReach) : -1;
    if (this.held >= 0) this.on.select(this.held);
  }

  move(event) {
    if (!this.model.picture) return;
    const {offsetX: x, offsetY: y} = event,
      last = this.fingers.get(event.pointerId);
    this.tell(x, y);
    if (!last) return this.hover(x, y);
    const by = [x - last[0], y - last[1]],
      before = this.spread();
    this.travel += Math.abs(by[0]) + Math.abs(by[1]);
    this.fingers.set(event.pointerId, [x, y]);
    if (before > 0) this.pinch(before, by);
    else if (this.held >= 0) this.on.move(this.held, this.inside(this.toPixel(x, y)));
    else if (this.travel > kSmallMove) this.pan(by);
  }

  hover(x, y) {
    const isOver = this.handleAt(x, y, kReach) >= 0;
    this.canvas.style.cursor = isOver ? "move" : this.model.isDrawing ? "crosshair" : "grab";
  }

  release(event) {
    const isClick = event.type === "pointerup" && event.button === 0 && this.travel <= kSmallMove;
    this.fingers.delete(event.pointerId);
    if (isClick && this.held === 0) this.on.close();
    if (isClick && this.held < 0 && this.model.isDrawing)
      this.on.add(this.inside(this.toPixel(event.offsetX, event.offsetY)));
    this.held = -1;
  }

  inside([u, v]) {
    const {width, height} = this.model.picture;
    return tenths([clamp(u, 0, width - 1), clamp(v, 0, height - 1)]);
  }

  pinch(before, by) {
    this.zoomBy(Math.max(1, this.spread()) / before);
    this.pan([by[0] / 2, by[1] / 2]);
  }

  roll(event) {
    event.preventDefault();
    this.zoomBy(Math.exp(-0.0015 * event.deltaY), event.offsetX, event.offsetY);
  }

  key(event) {
    const {handles = [], selected} = this.model;
    const arrow = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key];
    const turn = {PageUp: -1, PageDown: 1}[event.key];
    if (arrow) this.step(arrow, event.shiftKey ? 10 : 1);
    else if (turn && handles.length) this.on.select((selected + turn + handles.length) % handles.length);
    else if (event.key === "Delete" || event.key === "Backspace") this.on.remove(selected);
    else if (event.key === "Enter") this.on.close();
    else if (event.key === "+" || event.key === "=") this.zoomBy(1.2);
    else if (event.key === "-") this.zoomBy(1 / 1.2);
    else if (event.key === "Home") this.fit();
    else return;
    event.preventDefault();
  }

  step(arrow, factor) {
    const {handles = [], selected} = this.model,
      point = handles[selected];
    if (!point) return this.pan(arrow.map((value) => -12 * factor * value));
    return this.on.move(selected, this.inside(point.map((value, k) => value + factor * arrow[k])));
  }

  /** The pixel under the pointer. */
  tell(x, y) {
    const [u, v] = this.toPixel(x, y).map(Math.round);
    this.readout.textContent = `${u}, ${v} px`;
  }

  /** Share of the canvas that is drawn on: proof that something is to be seen. */
  coverage() {
    this.draw();
    const {width, height} = this.canvas;
    const bytes = this.canvas.getContext("2d").getImageData(0, 0, width, height).data;
    let drawn = 0;
    for (let i = 3; i < bytes.length; i += 4) if (bytes[i] > 24) ++drawn;
    return drawn / (width * height);
  }
}

/** A canvas with a picture {width, height, rgb}. */
export function imageOf({width, height, rgb}) {
  const canvas = document.createElement("canvas");
  Object.assign(canvas, {width, height});
  const image = new ImageData(width, height);
  for (let from = 0, to = 0; from < rgb.length; from += 3, to += 4) {
    image.data[to] = rgb[from];
    image.data[to + 1] = rgb[from + 1];
    image.data[to + 2] = rgb[from + 2];
    image.data[to + 3] = 255;
  }
  canvas.getContext("2d").putImageData(image, 0, 0);
  return canvas;
}
