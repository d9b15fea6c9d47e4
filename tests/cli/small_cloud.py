"""A hill as a cloud of points, seen twice, for the tests of `incise register`."""

import math
import random

from command import CommandTest


def height(u, v):
    """A hill with a ridge to one side: no symmetry."""
    return (14 * math.exp(-(u * u / 500 + v * v / 220)) + 5 * math.exp(-((u - 14) ** 2 / 60 + (v - 7) ** 2 / 25)) + 0.04 * u)


def hill(count, seed):
    numbers = random.Random(seed)
    places = [(numbers.uniform(-30, 30), numbers.uniform(-20, 20)) for _ in range(count)]
    return [(u, v, height(u, v)) for u, v in places]


def turned(points, degrees=170.0, scale=0.98, shift=(100.0, -40.0, 300.0)):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return [(scale * x + shift[0], scale * (c * y - s * z) + shift[1], scale * (s * y + c * z) + shift[2]) for x, y, z in points]


def write_ply(path, points):
    lines = ["ply", "format ascii 1.0", f"element vertex {len(points)}", "property double x", "property double y", "property double z", "end_header"]
    path.write_text("\n".join(lines + [" ".join(map(repr, p)) for p in points]) + "\n")


class RegisterCase(CommandTest):
    def setUp(self):
        super().setUp()
        write_ply(self.folder / "a.ply", hill(1200, 1))
        write_ply(self.folder / "b.ply", turned(hill(1200, 2)))

    def register(self, *more, source="a.ply", target="b.ply", starts=("--rotations", "60")):
        # 60 rotations are enough for this hill; the default of 160 would only take longer.
        return ("register", "--source", source, "--target", target, "-o", "out", "--threads", "2", *starts, *more)
