// The world's axes in a corner of the 3D view, of the studio and of the report, with letters at their ends: anatomical
// ones, or the robot's x, y and z.

const kNamespace = "http://www.w3.org/2000/svg";
const kEnds = {anatomical: ["R", "L", "A", "P", "I", "S"], robot: ["", "x", "", "y", "", "z"]};
const kShades = {light: ["#b3383c", "#2f7d4f", "#3260a8"], dark: ["#ff8c8c", "#6fd39b", "#8fb8ff"]};

/** An element `node` (SVG) that draw() turns.
 *  @param ends  names of the ends of x, y and z, the negative one first */
export class Gizmo {
  constructor(ends = kEnds.anatomical) {
    this.node = make("svg", {viewBox: "-55 -55 110 110", "aria-hidden": "true", class: "gizmo"});
    this.marks = ends.map((name, end) => this.makeMark(name, end));
  }

  makeMark(name, end) {
    const line = make("line", {x1: 0, y1: 0, "stroke-width": 2}),
      text = make("text", {});
    text.textContent = name;
    const group = make("g", {});
    group.append(line, text);
    return {group, line, text, axis: end >> 1, sign: end & 1 ? 1 : -1};
  }

  /** Names the ends of the axes. @param frame  "anatomical" or "robot" */
  name(frame) {
    this.marks.forEach((mark, end) => {
      mark.text.textContent = kEnds[frame][end];
    });
  }

  /** @param axes  {right, up, towards}: three.js vectors */
  draw({right, up, towards}, isDark) {
    for (const mark of this.marks) this.place(mark, right, up, towards, isDark ? kShades.dark : kShades.light);
    const order = [...this.marks].sort((a, b) => a.depth - b.depth);
    this.node.append(...order.map((mark) => mark.group));
  }

  place(mark, right, up, towards, shades) {
    const along = (axis) => mark.sign * axis.getComponent(mark.axis);
    const x = 34 * along(right),
      y = -34 * along(up);
    mark.depth = along(towards);
    set(mark.group, {
      opacity: (0.65 + 0.35 * mark.depth).toFixed(2),
      stroke: shades[mark.axis],
      fill: shades[mark.axis],
    });
    set(mark.line, {x2: x.toFixed(1), y2: y.toFixed(1)});
    set(mark.text, {x: (1.32 * x).toFixed(1), y: (1.32 * y).toFixed(1), stroke: "none"});
  }
}

function make(name, attributes) {
  return set(document.createElementNS(kNamespace, name), attributes);
}

function set(node, attributes) {
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  return node;
}
