// Painting a patch on the skin in the 3D view: a drag that begins on the skin paints, one beside it turns the view.

import {length, minus} from "./geometry.js";

/** The 3D view's tool for a patch. `get()` gives the patch, or null where none can be painted; `query()` the skin, or
 *  null; it calls `on.painting(path)` for each new point, `on.stroke(path)`, `on.grow(steps)` and `on.end()`. */
export class PatchTool {
  constructor(scene, {get, query, on}) {
    Object.assign(this, {scene, get, query, on, path: [], end: null});
    this.ring = document.createElement("div");
    this.ring.className = "brush-ring";
    this.ring.hidden = true;
    scene.host.append(this.ring);
    scene.renderer.domElement.addEventListener("pointerleave", () => this.hide());
  }

  press(event) {
    const hit = event.shiftKey ? null : this.hit(event);
    if (!hit) return false;
    this.end = hit;
    this.put([hit]);
    return true;
  }

  drag(event) {
    this.hover(event);
    const hit = this.hit(event);
    if (!hit) return;
    this.end = hit;
    if (length(minus(hit, this.path.at(-1))) > 0.5 * this.get().radius_mm) this.put([...this.path, hit]);
  }

  drop() {
    const {path, end} = this;
    this.put([]);
    if (path.length) this.on.stroke([...path, end]);
  }

  /** A second finger: it was no stroke. */
  cancel() {
    this.put([]);
  }

  click() {}

  put(path) {
    this.path = path;
    this.on.painting(path);
  }

  hit({offsetX, offsetY}) {
    const query = this.get() && this.query();
    return query ? query.first(this.scene.rayAt(offsetX, offsetY)) : null;
  }

  /** Shows the brush under the pointer in its true size. */
  hover({offsetX, offsetY}) {
    const patch = this.get();
    this.ring.hidden = !patch;
    if (!patch) return;
    const size = 2 * patch.radius_mm * this.scene.pixelsPerMm();
    Object.assign(this.ring.style, {
      left: `${offsetX}px`,
      top: `${offsetY}px`,
      width: `${size}px`,
      height: `${size}px`,
    });
  }

  hide() {
    this.ring.hidden = true;
  }

  key(event) {
    if (event.key === "Escape") this.on.end();
    else if (event.key === "[") this.on.grow(-1);
    else if (event.key === "]") this.on.grow(1);
    else return false;
    return true;
  }
}
