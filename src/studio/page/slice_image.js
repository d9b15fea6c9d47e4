// Pictures of one slice: grey values through a table, and labels with their outline.

const kLow = 32768;

/** Grey of every int16 value, as packed RGBA (little-endian), for a window of `width` about `level`, HU. */
export class GreyTable {
  constructor() {
    this.entries = new Uint32Array(65536);
    this.key = "";
  }

  set(width, level) {
    const key = `${width} ${level}`;
    if (key === this.key) return;
    this.key = key;
    const low = level - 0.5 * width,
      factor = 255 / Math.max(1, width);
    for (let value = 0; value < 65536; ++value) {
      const grey = Math.max(0, Math.min(255, (value - kLow - low) * factor)) & 255;
      this.entries[value] = 0xff000000 | (grey << 16) | (grey << 8) | grey;
    }
  }
}

/** A canvas of its own with the pixels of one slice, drawn again only when its key changes. */
export class SliceImage {
  constructor() {
    this.canvas = document.createElement("canvas");
    this.key = "";
  }

  /** @param paint  (pixels: Uint32Array, strides, columns, rows) */
  update(plane, slice, key, paint) {
    if (key === this.key) return;
    this.key = key;
    this.fit(plane.columns, plane.rows);
    paint(this.pixels, plane.strides(slice), plane.columns, plane.rows);
    this.canvas.getContext("2d").putImageData(this.data, 0, 0);
  }

  fit(columns, rows) {
    if (this.data && this.data.width === columns && this.data.height === rows) return;
    Object.assign(this.canvas, {width: columns, height: rows});
    this.data = new ImageData(columns, rows);
    this.pixels = new Uint32Array(this.data.data.buffer);
  }
}

/** Paints voxels (int16) through a table. */
export function paintGrey(voxels, table) {
  return (pixels, {first, column, row}, columns, rows) => {
    const entries = table.entries;
    let to = 0;
    for (let y = 0; y < rows; ++y) {
      let from = first + y * row;
      for (let x = 0; x < columns; ++x, from += column) pixels[to++] = entries[voxels[from] + kLow];
    }
  };
}

/** Paints labels: every label but 0 in one colour. @param rgb  three numbers in 0..255 */
export function paintLabels(labels, rgb) {
  const colour = (0xff000000 | (rgb[2] << 16) | (rgb[1] << 8) | rgb[0]) >>> 0;
  return (pixels, {first, column, row}, columns, rows) => {
    let to = 0;
    for (let y = 0; y < rows; ++y) {
      let from = first + y * row;
      for (let x = 0; x < columns; ++x, from += column) pixels[to++] = labels[from] ? colour : 0;
    }
  };
}

/** The border of the labels of one slice, in columns and rows (pixel centres at whole numbers). */
export function outlineOf(labels, plane, slice) {
  const {first, column, row} = plane.strides(slice);
  const path = new Path2D();
  const isSet = (x, y) =>
    x >= 0 && y >= 0 && x < plane.columns && y < plane.rows && labels[first + x * column + y * row] > 0;
  for (let y = 0; y <= plane.rows; ++y) {
    for (let x = 0; x <= plane.columns; ++x) {
      const here = isSet(x, y);
      if (here !== isSet(x - 1, y)) addLine(path, x - 0.5, y - 0.5, x - 0.5, y + 0.5);
      if (here !== isSet(x, y - 1)) addLine(path, x - 0.5, y - 0.5, x + 0.5, y - 0.5);
    }
  }
  return path;
}

function addLine(path, ax, ay, bx, by) {
  path.moveTo(ax, ay);
  path.lineTo(bx, by);
}
