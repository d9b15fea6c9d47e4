// One of the three orthogonal slices: the picture, the tissue found, box, seed, tumour's edge and crosshair.

import {CanvasView, barPath, writeWord} from "./canvas_view.js";
import {Plane, boxOutline, clamp, filled, letterOf, middleOf, minus, plus, roundedDown, voxelAt} from "./geometry.js";
import {SliceImage, outlineOf, paintGrey, paintLabels} from "./slice_image.js";
import {onBlack, rgbOf} from "./colours.js";
import {place} from "./words.js";

const kReach = 12; // px: how near to a handle a pointer takes it
const kTouchReach = 24;
const kCut = 0.98; // of its radius: a ball of a stroke that a slice cuts farther out shows no more than a dot

/** A slice. Its `model` is shared by the three of them:
 *  {room, scan, tissue, table, window, cross, box, seed, edge, overlay, isPlacing, isBoxShown, brush, strokes, stroke};
 *  lengths in mm, LPS. `room`: the case's file, for another has other places; `brush`: {tissue, radius_mm} or null;
 *  `strokes`: those that the tissue does not show yet; `stroke`: the path that is being painted.
 *  It calls `on.cross(point)`, `on.window(width, level)`, `on.face(box)` while a face of the box is dragged (null: it
 *  goes back), `on.box(box)` when it is let go, `on.seed(point)`, `on.painting()`, `on.stroke(path)`, `on.putAway()`. */
export class SliceView extends CanvasView {
  constructor(host, name, model, on) {
    super(host, {
      label:
        `${name} slice. Arrow keys move the crosshair, Page Up and Page Down the slice, ` +
        "plus and minus zoom, Home shows all. With a brush, Enter paints a ball at the crosshair.",
      zooms: [0.05, 200],
      ends: ["pointerup", "pointercancel", "lostpointercapture"],
    });
    Object.assign(this, {name, model, on, drag: null, drawnCount: 0, outline: {key: "", path: null}});
    this.image = new SliceImage();
    this.labelImage = new SliceImage();
  }

  /** The grid of the picture: the scan's, else that of the tissue. */
  grid() {
    const {scan, tissue} = this.model;
    return scan ? scan.grid : tissue && tissue.grid ? tissue.grid : null;
  }

  plane() {
    const grid = this.grid();
    if (!grid) return null;
    if (!this.ownPlane || this.ownPlane.grid !== grid) this.take(new Plane(grid, this.name));
    return this.ownPlane;
  }

  /** Shows another grid: all of it, or, where it lies in the same room, the same place at the same size. */
  take(plane) {
    const {ownPlane: last, middle} = this,
      isSame = last && this.room === this.model.room;
    this.ownPlane = plane;
    this.room = this.model.room;
    if (!isSame) return this.fit();
    const at = last.toPixel(this.cross());
    const place = last.toPoint([middle[0] / last.step[0], middle[1] / last.step[1], at[2]]);
    this.middle = [0, 1].map((k) => plane.toPixel(place)[k] * plane.step[k]);
    return undefined;
  }

  /** Number of the slice that is shown. */
  slice() {
    const plane = this.plane();
    return clamp(Math.round(plane.toPixel(this.cross())[2]), 0, plane.slices - 1);
  }

  cross() {
    return this.model.cross || middleOf(this.grid());
  }

  /** Shows the whole slice. */
  fit() {
    const plane = this.ownPlane;
    const width = plane.columns * plane.step[0],
      height = plane.rows * plane.step[1];
    this.zoom = 0.96 * Math.min(this.host.clientWidth / width, this.host.clientHeight / height);
    this.middle = [0.5 * (width - plane.step[0]), 0.5 * (height - plane.step[1])];
    this.isFitted = true;
    this.render();
  }

  /** Shows a box [low, high], mm, with some room about it. */
  fitBox(box) {
    const plane = this.plane();
    if (!plane) return;
    const [a, b] = box.map((corner) => plane.toPixel(corner));
    const size = [0, 1].map((k) => Math.abs(a[k] - b[k]) * plane.step[k]);
    this.zoom =
      0.7 * Math.min(this.host.clientWidth / Math.max(1, size[0]), this.host.clientHeight / Math.max(1, size[1]));
    this.middle = [0, 1].map((k) => 0.5 * (a[k] + b[k]) * plane.step[k]);
    this.isFitted = false;
    this.render();
  }

  resize() {
    this.fill();
    if (!this.host.clientWidth) this.breakOff();
    if (this.ownPlane && (this.isFitted || !(this.zoom > 0))) this.fit();
    this.render();
  }

  // --- From pixels of the screen to places and back. ---

  toScreen(point) {
    const plane = this.plane(),
      pixel = plane.toPixel(point);
    return [0, 1].map((k) => this.half(k) + (pixel[k] * plane.step[k] - this.middle[k]) * this.zoom);
  }

  toPoint(x, y) {
    const plane = this.plane();
    const at = [x, y].map((value, k) => ((value - this.half(k)) / this.zoom + this.middle[k]) / plane.step[k]);
    return plane.toPoint([at[0], at[1], plane.toPixel(this.cross())[2]]);
  }

  // --- Drawing. ---

  draw() {
    this.isDirty = false;
    const pen = this.canvas.getContext("2d");
    pen.setTransform(this.ratio || 1, 0, 0, this.ratio || 1, 0, 0);
    pen.fillStyle = "#000";
    pen.fillRect(0, 0, this.host.clientWidth, this.host.clientHeight);
    if (!this.plane() || !(this.zoom > 0)) return;
    this.drawScan(pen);
    this.drawTissue(pen);
    this.drawStrokes(pen);
    this.drawBox(pen);
    this.drawEdge(pen);
    this.drawSeed(pen);
    this.drawCross(pen);
    this.drawFrame(pen);
    this.drawBrush(pen);
    this.drawnCount += 1;
    this.host.dataset.ready = "yes";
  }

  drawScan(pen) {
    const {scan, table, window: grey} = this.model;
    if (!scan) return;
    const plane = this.plane(),
      slice = this.slice();
    table.set(grey.width, grey.level);
    this.image.update(plane, slice, `${scan.key} ${slice} ${table.key}`, paintGrey(scan.voxels, table));
    this.drawImage(pen, this.image.canvas, plane, 1);
  }

  drawImage(pen, canvas, plane, opacity) {
    const [x, y] = this.toScreen(plane.toPoint([-0.5, -0.5, plane.toPixel(this.cross())[2]]));
    pen.globalAlpha = opacity;
    pen.imageSmoothingEnabled = opacity === 1 && this.zoom * plane.step[0] < 6;
    pen.drawImage(canvas, x, y, plane.columns * plane.step[0] * this.zoom, plane.rows * plane.step[1] * this.zoom);
    pen.globalAlpha = 1;
  }

  drawTissue(pen) {
    const {tissue, overlay} = this.model;
    if (!tissue || !tissue.labels || overlay <= 0) return;
    const plane = this.tissuePlane(tissue);
    const slice = Math.round(plane.toPixel(this.cross())[2]);
    if (slice < 0 || slice >= plane.slices) return;
    const key = `${tissue.key} ${slice}`;
    this.labelImage.update(plane, slice, key, paintLabels(tissue.labels, rgbOf(onBlack.tissue)));
    if (key !== this.outline.key) this.outline = {key, path: outlineOf(tissue.labels, plane, slice)};
    this.drawImage(pen, this.labelImage.canvas, plane, 0.999 * overlay);
    this.strokeOutline(pen, plane);
  }

  tissuePlane(tissue) {
    if (!this.labelPlane || this.labelPlane.grid !== tissue.grid) this.labelPlane = new Plane(tissue.grid, this.name);
    return this.labelPlane;
  }

  strokeOutline(pen, plane) {
    const [x, y] = this.toScreen(plane.toPoint([0, 0, plane.toPixel(this.cross())[2]]));
    pen.save();
    pen.translate(x, y);
    pen.scale(plane.step[0] * this.zoom, plane.step[1] * this.zoom);
    pen.strokeStyle = onBlack.tissue;
    pen.lineWidth = 1.4 / (plane.step[0] * this.zoom);
    pen.stroke(this.outline.path);
    pen.restore();
  }

  /** What is painted and not yet in the tissue: where the slice cuts the balls along a stroke's path. */
  drawStrokes(pen) {
    const {brush, stroke, strokes} = this.model;
    const shown = brush && stroke.length ? [...strokes, {...brush, path_mm: stroke}] : strokes;
    for (const one of shown) {
      pen.fillStyle = one.tissue ? onBlack.add : onBlack.take;
      pen.globalAlpha = 0.55;
      pen.fill(this.cutOf(one));
      pen.globalAlpha = 1;
    }
  }

  cutOf({radius_mm: radius, path_mm: path}) {
    const plane = this.plane(),
      slice = this.slice(),
      cut = new Path2D();
    for (const point of filled(path, 0.3 * radius)) {
      const depth = (plane.toPixel(point)[2] - slice) * plane.step[2],
        [x, y] = this.toScreen(point);
      if (Math.abs(depth) >= kCut * radius) continue;
      const wide = this.zoom * Math.sqrt(radius ** 2 - depth ** 2);
      cut.moveTo(x + wide, y);
      cut.arc(x, y, wide, 0, 2 * Math.PI);
    }
    return cut;
  }

  /** The brush under the pointer in its true size, and beside it the sign of what it does. */
  drawBrush(pen) {
    const {brush} = this.model;
    if (!brush || !this.pointer) return;
    const [x, y] = this.pointer,
      wide = brush.radius_mm * this.zoom,
      [right, low] = [x, y].map((value) => value + 0.71 * wide + 9);
    for (const [colour, width] of [
      ["#000", 3],
      [brush.tissue ? onBlack.add : onBlack.take, 1.5],
    ]) {
      pen.strokeStyle = colour;
      pen.lineWidth = width;
      pen.beginPath();
      pen.arc(x, y, wide, 0, 2 * Math.PI);
      pen.stroke();
    }
    this.word(pen, brush.tissue ? "+" : "−", right, low, "center");
  }

  /** The box where the slice cuts it, with a handle in the middle of each side; faint where it lies before or behind. */
  drawBox(pen) {
    this.handles = [];
    const {box, isBoxShown} = this.model;
    if (!box || !isBoxShown) return;
    const plane = this.plane();
    const cut = boxOutline(box, this.cross(), plane.right, plane.down);
    const outline = cut.length ? cut : boxOutline(box, this.shadowPoint(box, plane), plane.right, plane.down);
    pen.setLineDash(cut.length ? [] : [3, 4]);
    this.strokeLine(
      pen,
      outline.map((corner) => corner.point),
      true,
      onBlack.box,
      1.5,
    );
    pen.setLineDash([]);
    if (cut.length) this.drawHandles(pen, outline);
  }

  shadowPoint(box, plane) {
    const middle = plus(box[0], minus(box[1], box[0]), 0.5);
    const at = plane.toPixel(this.cross());
    return plane.toPoint([at[0], at[1], plane.toPixel(middle)[2]]);
  }

  drawHandles(pen, outline) {
    outline.forEach((corner, k) => {
      const next = outline[(k + 1) % outline.length];
      if (corner.face < 0) return;
      const at = this.toScreen(plus(corner.point, minus(next.point, corner.point), 0.5));
      this.handles.push({face: corner.face, at});
      pen.fillStyle = this.drag && this.drag.face === corner.face ? "#fff" : onBlack.box;
      pen.fillRect(at[0] - 4.5, at[1] - 4.5, 9, 9);
      pen.strokeStyle = "#000";
      pen.strokeRect(at[0] - 4.5, at[1] - 4.5, 9, 9);
    });
  }

  strokeLine(pen, points, isClosed, colour, width) {
    if (points.length < 2) return;
    pen.beginPath();
    for (const point of points) pen.lineTo(...this.toScreen(point));
    if (isClosed) pen.closePath();
    pen.strokeStyle = colour;
    pen.lineWidth = width;
    pen.stroke();
  }

  /** Points of the tumour's edge within half a slice of this one. */
  drawEdge(pen) {
    const plane = this.plane(),
      slice = plane.toPixel(this.cross())[2];
    pen.fillStyle = onBlack.tumour;
    for (const point of this.model.edge || []) {
      if (Math.abs(plane.toPixel(point)[2] - slice) <= 0.5) this.dot(pen, this.toScreen(point), 3);
    }
  }

  dot(pen, [x, y], radius) {
    pen.beginPath();
    pen.arc(x, y, radius, 0, 2 * Math.PI);
    pen.fill();
  }

  drawSeed(pen) {
    const {seed, isBoxShown} = this.model;
    if (!seed || !isBoxShown) return;
    const plane = this.plane();
    const isHere = Math.abs(plane.toPixel(seed)[2] - plane.toPixel(this.cross())[2]) <= 0.5;
    const [x, y] = this.toScreen(seed);
    pen.globalAlpha = isHere ? 1 : 0.45;
    pen.strokeStyle = pen.fillStyle = onBlack.seed;
    pen.lineWidth = 2;
    pen.beginPath();
    pen.arc(x, y, 7, 0, 2 * Math.PI);
    pen.stroke();
    this.dot(pen, [x, y], 2);
    pen.globalAlpha = 1;
  }

  drawCross(pen) {
    const [x, y] = this.toScreen(this.cross()),
      gap = 9;
    const width = this.host.clientWidth,
      height = this.host.clientHeight;
    pen.beginPath();
    for (const [ax, ay, bx, by] of [
      [0, y, x - gap, y],
      [x + gap, y, width, y],
      [x, 0, x, y - gap],
      [x, y + gap, x, height],
    ]) {
      pen.moveTo(ax, ay);
      pen.lineTo(bx, by);
    }
    pen.strokeStyle = onBlack.cross;
    pen.globalAlpha = 0.55;
    pen.lineWidth = 1;
    pen.stroke();
    pen.globalAlpha = 1;
  }

  /** Letters at the four sides, the slice's place, and a scale bar. */
  drawFrame(pen) {
    const plane = this.plane(),
      width = this.host.clientWidth,
      height = this.host.clientHeight;
    const away = (vector) => letterOf(plus([0, 0, 0], vector, -1));
    this.word(pen, away(plane.right), 10, height / 2, "left");
    this.word(pen, letterOf(plane.right), width - 10, height / 2, "right");
    this.word(pen, away(plane.down), width / 2, 14, "center");
    this.word(pen, letterOf(plane.down), width / 2, height - 14, "center");
    const world = {axial: 2, coronal: 1, sagittal: 0}[this.name];
    this.word(pen, `${"xyz"[world]} = ${place(this.cross()[world])} mm`, width - 10, 15, "right");
    this.drawScaleBar(pen, width - 12, height - 12);
  }

  drawScaleBar(pen, right, bottom) {
    const bar = roundedDown(Math.max(60, 0.22 * this.host.clientWidth) / this.zoom);
    const left = right - bar * this.zoom;
    pen.strokeStyle = onBlack.words;
    pen.lineWidth = 2;
    barPath(pen, left, right, bottom);
    pen.stroke();
    this.word(pen, `${Number(bar.toPrecision(2))} mm`, 0.5 * (left + right), bottom - 12, "center");
  }

  word(pen, text, x, y, align) {
    writeWord(pen, text, x, y, {colour: onBlack.words, border: "#000c", align});
  }

  // --- Mouse, touch and keyboard. ---

  leave() {
    super.leave();
    this.pointer = null;
    if (this.model.brush) this.render();
  }

  handleAt(x, y, reach) {
    const away = (handle) => Math.hypot(handle.at[0] - x, handle.at[1] - y);
    const near = (this.handles || []).filter((handle) => away(handle) <= reach);
    return near.sort((a, b) => away(a) - away(b))[0] || null;
  }

  press(event) {
    if (!this.plane()) return;
    this.canvas.focus({preventScroll: true});
    this.canvas.setPointerCapture(event.pointerId);
    const {offsetX: x, offsetY: y} = event;
    this.fingers.set(event.pointerId, [x, y]);
    this.breakOff();
    if (this.fingers.size > 1) this.drag = {kind: "pinch"};
    else this.drag = this.dragFor(event, x, y);
    if (this.drag.kind === "cross") this.point(x, y);
    if (this.drag.kind === "brush") this.paint(x, y);
  }

  dragFor(event, x, y) {
    if (event.button === 2) return {kind: "window", x, y};
    if (event.button === 1 || event.shiftKey) return {kind: "pan", x, y};
    if (this.model.brush) return {kind: "brush"};
    const handle = this.handleAt(x, y, event.pointerType === "touch" ? kTouchReach : kReach);
    return handle ? {kind: "box", face: handle.face} : {kind: "cross", x, y};
  }

  point(x, y) {
    const point = this.toPoint(x, y);
    if (this.model.isPlacing) this.on.seed(point);
    this.on.cross(point);
  }

  paint(x, y) {
    this.model.stroke.push(this.toPoint(x, y));
    this.on.painting();
  }

  move(event) {
    if (!this.plane() || !(this.zoom > 0)) return;
    const {offsetX: x, offsetY: y} = event;
    this.pointer = [x, y];
    this.tell(x, y);
    const last = this.fingers.get(event.pointerId);
    if (!last || !this.drag) return this.hover(x, y);
    const spread = this.spread();
    this.fingers.set(event.pointerId, [x, y]);
    const by = [x - last[0], y - last[1]];
    if (this.drag.kind === "pinch") this.pinch(spread, by);
    else if (this.drag.kind === "pan") this.pan(by);
    else if (this.drag.kind === "window") this.shade(by);
    else if (this.drag.kind === "box") this.dragFace(x, y);
    else if (this.drag.kind === "brush") this.paint(x, y);
    else this.point(x, y);
  }

  hover(x, y) {
    if (this.model.brush) {
      this.canvas.style.cursor = "none";
      return this.render();
    }
    const handle = this.handleAt(x, y, kReach);
    const isAcross = handle && Math.abs(this.plane().right[handle.face >> 1]) > 0.7;
    this.canvas.style.cursor = handle ? (isAcross ? "ew-resize" : "ns-resize") : "crosshair";
    return undefined;
  }

  release(event) {
    if (!this.fingers.delete(event.pointerId) || this.fingers.size) return;
    const {stroke} = this.model,
      {box} = this.drag || {};
    this.breakOff();
    if (event.type !== "pointerup") return;
    if (stroke.length) this.on.stroke(stroke, this.plane().through);
    if (box) this.on.box(box);
  }

  /** Ends a drag without effect: the box goes back, and nothing is painted. */
  breakOff() {
    this.model.stroke = [];
    if (this.drag && this.drag.box) this.on.face(null);
    this.drag = null;
    this.render();
  }

  pinch(before, by) {
    const now = this.spread();
    if (before > 0 && now > 0) this.zoomBy(now / before);
    this.pan([by[0] / 2, by[1] / 2]);
  }

  /** Right drag: across changes the window's width, up and down its level. */
  shade(by) {
    const {width, level} = this.model.window;
    const rate = Math.max(0.5, width / 300);
    this.on.window(clamp(width + rate * by[0], 1, 65535), clamp(level + rate * by[1], -32768, 32767));
  }

  dragFace(x, y) {
    const axis = this.drag.face >> 1,
      side = this.drag.face & 1;
    const box = this.model.box.map((corner) => [...corner]);
    const value = Math.round(10 * this.toPoint(x, y)[axis]) / 10;
    box[side][axis] = side ? Math.max(value, box[0][axis] + 1) : Math.min(value, box[1][axis] - 1);
    this.drag.box = box;
    this.on.face(box);
  }

  roll(event) {
    if (!this.plane()) return;
    event.preventDefault();
    if (event.ctrlKey || event.metaKey)
      return this.zoomBy(Math.exp(-0.002 * event.deltaY), event.offsetX, event.offsetY);
    this.stepBy([0, 0, Math.sign(event.deltaY)]);
  }

  /** Moves the crosshair by so many columns, rows and slices. */
  stepBy(steps) {
    const plane = this.plane();
    const size = [plane.columns, plane.rows, plane.slices];
    const at = plane.toPixel(this.cross()).map((value, k) => clamp(value + steps[k], 0, size[k] - 1));
    this.on.cross(plane.toPoint(at));
  }

  key(event) {
    if (!this.plane()) return;
    const steps = {
      ArrowLeft: [-1, 0, 0],
      ArrowRight: [1, 0, 0],
      ArrowUp: [0, -1, 0],
      ArrowDown: [0, 1, 0],
      PageUp: [0, 0, 1],
      PageDown: [0, 0, -1],
    }[event.key];
    if (steps) this.stepBy(steps.map((step) => step * (event.shiftKey ? 5 : 1)));
    else if (event.key === "+" || event.key === "=") this.zoomBy(1.2);
    else if (event.key === "-") this.zoomBy(1 / 1.2);
    else if (event.key === "Home") this.fit();
    else if (event.key === "Enter" && this.model.isPlacing) this.on.seed(this.cross());
    else if (event.key === "Enter" && this.model.brush) this.on.stroke([this.cross()], this.plane().through);
    else if (event.key === "Escape" && this.drag) this.breakOff();
    else if (event.key === "Escape" && this.model.brush) this.on.putAway();
    else return;
    event.preventDefault();
  }

  /** Millimetres and HU under the pointer. */
  tell(x, y) {
    const point = this.toPoint(x, y),
      {scan} = this.model;
    const at = scan ? voxelAt(scan.grid, point) : -1;
    const grey = at >= 0 ? ` · ${scan.voxels[at]} HU` : "";
    this.readout.textContent = `${point.map(place).join(", ")} mm${grey}`;
  }

  /** Share of the canvas that is not black: proof that something is to be seen. */
  coverage() {
    this.draw();
    const {width, height} = this.canvas;
    const bytes = this.canvas.getContext("2d").getImageData(0, 0, width, height).data;
    let drawn = 0;
    for (let i = 0; i < bytes.length; i += 4) if (bytes[i] + bytes[i + 1] + bytes[i + 2] > 24) ++drawn;
    return drawn / (width * height);
  }
}
