#!/usr/bin/env python3
"""Draws comparison_box_plot.svg beside this script from four drawn (virtual) incisions.

  comparison_box_plot.py COMMAND

COMMAND is the incise program.
"""

import math
import subprocess
import sys
import tempfile
from pathlib import Path

POINTS = 720
# Shift along x and y and size of a three-sided wave, mm, of a ring that should lie 4.5 mm outside the tumour's edge.
BEFORE = {"s1": (-1.2, 1.6, 0.5), "s2": (-3.4, 0.8, 0.6)}
AFTER = {"s3": (-0.9, 0.5, 0.3), "s4": (0.8, -1.2, 0.6)}


def write_ring(path, half_length, half_width, shift=(0.0, 0.0), wave=0.0):
    lines = ["x_mm,y_mm,z_mm"]
    for k in range(POINTS):
        angle = 2.0 * math.pi * k / POINTS
        out = wave * math.cos(3.0 * angle)
        x = (half_length + out) * math.cos(angle) + shift[0]
        y = (half_width + out) * math.sin(angle) + shift[1]
        lines.append(f"{x:.4f},{y:.4f},0")
    path.write_text("\n".join(lines) + "\n")


def main():
    command = Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)

        def incise(*arguments):
            subprocess.run([command, *arguments], cwd=folder, check=True, stdout=subprocess.DEVNULL)

        write_ring(folder / "tumor.csv", 11.0, 9.0)
        for specimen, (x, y, wave) in {**BEFORE, **AFTER}.items():
            write_ring(folder / f"{specimen}.csv", 15.5, 13.5, (x, y), wave)
            incise("evaluate", "--incision", f"{specimen}.csv", "--tumor", "tumor.csv", "--contour", "inner_edge", "-o", f"{specimen}.json")
        incise("compare", "--before", *(f"{s}.json" for s in BEFORE), "--after", *(f"{s}.json" for s in AFTER), "-o", "comparison")
        (Path(__file__).parent / "comparison_box_plot.svg").write_text((folder / "comparison" / "box_plot.svg").read_text())


if __name__ == "__main__":
    main()
