#!/usr/bin/env python3
"""A virtual specimen under a virtual depth camera: everything here is simulated.

  make_scene.py FOLDER [--seed N] [--scale K] [--settling-mm A] [--noise-mm S]

writes what a laboratory would have before it lays a simulated path onto measured tissue:

  simulated.obj   the surface that the simulation ends with (triangles of 2 mm, the simulation's frame)
  path.json       tumour edge and ring on it, frame sim_stretched
  scan.ply        the camera's cloud: tissue, the plate that it lies on, stray points; the camera's frame, mm
  camera.json     T_robot_camera

and what no laboratory has, to compare with:

  wanted.json     the path that the tool should take: the ring's places on the simulated tissue, carried along by the
                  settling, in the robot's frame
  truth.json      the camera's scale, the pose and the rest that the scene was made with

The tissue is a tongue of 100 x 52 x 30 mm. It settles by at most A mm, up and down. All lengths that the camera sees are
K times too long.
"""

import argparse
import json
import math
import random
from pathlib import Path

LENGTH_MM, WIDTH_MM, BACK_MM = 100.0, 52.0, 24.0
PLATE_Z_MM = -6.0
PLATE_HALF_MM = (45.0, 70.0)  # x, y
EDGE_MM, MARGIN_MM, DEPTH_MM, SPEED_MM_S = 9.0, 5.0, 5.0, 7.0
CAMERA_MM = 350.0  # above the tissue's foot
PIXEL_MM = 0.6  # between rays of the picture, at the height of the foot


class Tongue:
    """z(x, y) of the back over an outline that is rounder at the root; a groove along the middle and long bumps."""

    def __init__(self, numbers):
        self.bumps = []
        for _ in range(6):
            wave, angle = 2.0 * math.pi / numbers.uniform(18.0, 45.0), numbers.uniform(0.0, 2.0 * math.pi)
            self.bumps.append((0.35, wave * math.cos(angle), wave * math.sin(angle), numbers.uniform(0.0, 2.0 * math.pi)))
        self.bend = numbers.uniform(-3.0, 3.0)

    def inside(self, x, y):
        """1 - (distance from the middle, in outlines)^2.5; below 0 outside."""
        u = y / (0.5 * LENGTH_MM)
        half = 0.5 * WIDTH_MM * (1.0 + 0.15 * u)  # the tip, at negative y, is narrower
        across = (x - self.bend * (1.0 - u * u)) / half
        return 1.0 - abs(across) ** 2.5 - abs(u) ** 2.5

    def height(self, x, y):
        inside = self.inside(x, y)
        if inside <= 0.0:
            return None
        u = y / (0.5 * LENGTH_MM)
        groove = -1.2 * math.exp(-((x - self.bend * (1.0 - u * u)) ** 2) / 18.0)
        bumps = sum(a * math.cos(p * x + q * y + r) for a, p, q, r in self.bumps)
        return BACK_MM * inside**0.45 * (1.0 + 0.12 * u) + min(1.0, 3.0 * inside) * (groove + bumps)


class Settling:
    """Smooth displacement along z, at most `largest` over the tissue."""

    def __init__(self, numbers, largest):
        self.waves = []
        for _ in range(4):
            wave, angle = 2.0 * math.pi / numbers.uniform(50.0, 120.0), numbers.uniform(0.0, 2.0 * math.pi)
            self.waves.append((numbers.gauss(0.0, 1.0), wave * math.cos(angle), wave * math.sin(angle), numbers.uniform(0.0, 2.0 * math.pi)))
        self.share = 1.0
        most = max(abs(self(x, y)) for x in range(-26, 27, 2) for y in range(-50, 51, 2))
        self.share = largest / most

    def __call__(self, x, y):
        return self.share * sum(a * math.cos(p * x + q * y + r) for a, p, q, r in self.waves)


def turned(axis, angle):
    """Rotation by `angle` about an axis, rows (Rodrigues)."""
    length = math.sqrt(sum(c * c for c in axis))
    x, y, z = (c / length for c in axis)
    c, s = math.cos(angle), math.sin(angle)
    return [
        [c + x * x * (1 - c), x * y * (1 - c) - z * s, x * z * (1 - c) + y * s],
        [y * x * (1 - c) + z * s, c + y * y * (1 - c), y * z * (1 - c) - x * s],
        [z * x * (1 - c) - y * s, z * y * (1 - c) + x * s, c + z * z * (1 - c)],
    ]


def times(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def transposed(a):
    return [list(column) for column in zip(*a)]


def moved(rotation, shift, p):
    return [sum(rotation[i][k] * p[k] for k in range(3)) + shift[i] for i in range(3)]


def rows_of(rotation, shift):
    return [[*rotation[i], shift[i]] for i in range(3)] + [[0, 0, 0, 1]]


def write_simulated(path, tongue):
    """A mesh of another pattern than the camera's: triangles over a staggered grid."""
    step = 2.0
    at, lines, faces = {}, [], []
    rows = int(LENGTH_MM / (0.866 * step)) + 2
    columns = int(1.2 * WIDTH_MM / step) + 2
    for j in range(rows):
        for i in range(columns):
            x = -0.6 * WIDTH_MM + step * (i + 0.5 * (j % 2)) + 0.3
            y = -0.5 * LENGTH_MM + 0.866 * step * j - 0.7
            z = tongue.height(x, y)
            if z is not None:
                at[i, j] = len(at) + 1
                lines.append(f"v {x:.4f} {y:.4f} {z:.4f}")
    for j in range(rows - 1):
        for i in range(columns - 1):
            a, b, c, d = (i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)
            pairs = [(a, b, d), (a, d, c)] if j % 2 else [(a, b, c), (b, d, c)]
            faces += [f"f {at[p]} {at[q]} {at[r]}" for p, q, r in pairs if p in at and q in at and r in at]
    path.write_text("\n".join(lines + faces) + "\n")


def ring(tongue, center, radius, count):
    """Counter-clockwise seen from above, a little out of round."""
    points = []
    for n in range(count):
        angle = 2.0 * math.pi * n / count - 0.5 * math.pi
        r = radius + 0.8 * math.cos(2.0 * angle) + 0.5 * math.sin(3.0 * angle)
        x, y = center[0] + r * math.cos(angle), center[1] + r * math.sin(angle)
        points.append([x, y, tongue.height(x, y)])
    return points


def path_of(frame, points, edge, axis):
    return {
        "frame": frame,
        "kind": "incise",
        "closed": True,
        "waypoints": [{"position_mm": p, "axis": axis, "depth_mm": DEPTH_MM, "speed_mm_s": SPEED_MM_S} for p in points],
        "tumor_edge": edge,
    }


def visible_points(tongue, settling, numbers):
    """Tissue and plate where the camera's rays meet them, in the simulation's frame; some tissue is not seen."""
    holes = [(numbers.uniform(-20, 20), numbers.uniform(-40, 40), numbers.uniform(0.8, 1.8)) for _ in range(10)]
    points = []
    across, along = (int(half / PIXEL_MM) for half in PLATE_HALF_MM)
    for i in range(-across, across + 1):
        for j in range(-along, along + 1):
            x, y = PIXEL_MM * (i + numbers.uniform(-0.3, 0.3)), PIXEL_MM * (j + numbers.uniform(-0.3, 0.3))
            z = tongue.height(x, y)
            if z is None:
                if (i + j) % 4 == 0 and tongue.inside(x, y) < -0.15:
                    points.append([x, y, PLATE_Z_MM])
            elif y < 0.42 * LENGTH_MM and not any((x - u) ** 2 + (y - v) ** 2 < r * r for u, v, r in holes):
                points.append([x, y, z + settling(x, y)])
    return points


def write_ply(path, points):
    head = ["ply", "format ascii 1.0", f"element vertex {len(points)}", "property float x", "property float y", "property float z", "end_header"]
    path.write_text("\n".join(head + ["%.3f %.3f %.3f" % tuple(p) for p in points]) + "\n")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--scale", type=float, default=1.02, help="of the camera's lengths, about its origin")
    parser.add_argument("--settling-mm", type=float, default=1.0)
    parser.add_argument("--noise-mm", type=float, default=0.3, help="of each coordinate")
    options = parser.parse_args()
    numbers = random.Random(options.seed)
    folder = options.folder
    folder.mkdir(parents=True, exist_ok=True)
    tongue, settling = Tongue(numbers), Settling(numbers, options.settling_mm)

    write_simulated(folder / "simulated.obj", tongue)
    center = (numbers.uniform(-4.0, 4.0), numbers.uniform(-15.0, 10.0))
    planned, edge = ring(tongue, center, EDGE_MM + MARGIN_MM, 48), ring(tongue, center, EDGE_MM, 90)
    (folder / "path.json").write_text(json.dumps(path_of("sim_stretched", planned, edge, [0, 0, -1])))

    # The camera looks down, a little askew, at tissue that lies anyhow; the robot stands beside both.
    down = times(turned((1, 0, 0), math.pi), turned((0, 0, 1), numbers.uniform(-math.pi, math.pi)))
    R_camera_sim = times(turned((1, 0, 0), numbers.uniform(-0.15, 0.15)), times(turned((0, 1, 0), numbers.uniform(-0.15, 0.15)), down))
    t_camera_sim = [numbers.uniform(-20, 20), numbers.uniform(-20, 20), CAMERA_MM]
    R_robot_sim = turned((0, 0, 1), numbers.uniform(-math.pi, math.pi))
    t_robot_sim = [numbers.uniform(550, 650), numbers.uniform(-100, 100), 80.0]
    R_robot_camera = times(R_robot_sim, transposed(R_camera_sim))
    t_robot_camera = [t_robot_sim[i] - moved(R_robot_camera, (0, 0, 0), t_camera_sim)[i] for i in range(3)]
    (folder / "camera.json").write_text(json.dumps({"T_robot_camera": rows_of(R_robot_camera, t_robot_camera)}))

    seen = []
    for p in visible_points(tongue, settling, numbers):
        exact = moved(R_camera_sim, t_camera_sim, p)
        seen.append([options.scale * (c + numbers.gauss(0.0, options.noise_mm)) for c in exact])
    for _ in range(60):
        p = [numbers.uniform(-60, 60), numbers.uniform(-40, 40), numbers.uniform(-5, 60)]
        seen.append([options.scale * c for c in moved(R_camera_sim, t_camera_sim, p)])
    write_ply(folder / "scan.ply", seen)

    def in_robot(points):
        return [moved(R_robot_sim, t_robot_sim, [x, y, z + settling(x, y)]) for x, y, z in points]

    (folder / "wanted.json").write_text(json.dumps(path_of("robot", in_robot(planned), in_robot(edge), [0, 0, -1])))
    truth = {
        "virtual": True,
        "seed": options.seed,
        "camera_scale": options.scale,
        "plate_z_mm": t_robot_sim[2] + PLATE_Z_MM,
        "T_camera_sim": rows_of(R_camera_sim, t_camera_sim),
        "T_robot_sim": rows_of(R_robot_sim, t_robot_sim),
    }
    (folder / "truth.json").write_text(json.dumps(truth, indent=2) + "\n")


if __name__ == "__main__":
    main()
