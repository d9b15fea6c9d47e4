"""`incise surface` and `incise register`: results, exit statuses, messages."""

import json
import math
import random
import unittest

import small_case
from command import BAD_CASE, BAD_DATA, DONE, INTERRUPTED, NOT_ACCEPTABLE, CommandTest, files_below


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


class RegisterTest(CommandTest):
    def setUp(self):
        super().setUp()
        write_ply(self.folder / "a.ply", hill(1200, 1))
        write_ply(self.folder / "b.ply", turned(hill(1200, 2)))

    def register(self, *more, source="a.ply", target="b.ply"):
        return ("register", "--source", source, "--target", target, "-o", "out", "--threads", "2", *more)

    def test_a_turned_cloud_is_found_and_the_folder_is_complete(self):
        result = self.json_of(*self.register())
        self.assertTrue(result["converged"], result["reasons"])
        self.assertAlmostEqual(result["scale"], 0.98, delta=0.005)
        self.assertAlmostEqual(result["rotation_deg"], 170.0, delta=0.5)
        for axis, shift in enumerate((100.0, -40.0, 300.0)):
            self.assertAlmostEqual(result["T_target_source"][axis][3], shift, delta=0.6)
        self.assertEqual(result["T_target_source"][3], [0.0, 0.0, 0.0, 1.0])
        for key in ("rotation", "translation_mm", "rmse_mm", "inlier_fraction", "iterations", "wall_s", "certificate"):
            self.assertIn(key, result)
        self.assertEqual(files_below(self.out), ["manifest.json", "moved_source.ply", "registration.json", "registration.svg"])
        kept = json.loads((self.out / "registration.json").read_text())
        self.assertEqual(kept["T_target_source"], result["T_target_source"])
        self.assertEqual(kept["schema"], "incise.registration/1")
        manifest = json.loads((self.out / "manifest.json").read_text())
        self.assertEqual(len(manifest["inputs"]), 2)
        self.assertEqual(manifest["settings"]["scale"], [0.9, 1.1])

    def test_a_flat_cloud_is_ill_determined_and_the_result_is_written(self):
        numbers = random.Random(3)
        flat = [(numbers.uniform(-30, 30), numbers.uniform(-20, 20), 0.0) for _ in range(600)]
        write_ply(self.folder / "flat.ply", flat)
        result = self.json_of(*self.register(source="flat.ply", target="flat.ply"), status=NOT_ACCEPTABLE)
        self.assertFalse(result["converged"])
        self.assertTrue(any("hardly changes the residual" in reason for reason in result["reasons"]), result["reasons"])
        self.assertTrue((self.out / "registration.json").is_file())

    def test_a_line_has_no_transform(self):
        write_ply(self.folder / "line.ply", [(i, 2.0 * i, -i) for i in range(50)])
        result = self.json_of(*self.register(source="line.ply"), status=NOT_ACCEPTABLE)
        self.assertEqual(result["outcome"], "degenerate")
        self.assertIsNone(result["T_target_source"])

    def test_a_residual_above_the_limit_is_not_acceptable(self):
        result = self.json_of(*self.register("--max-rmse-mm", "0.0001"), status=NOT_ACCEPTABLE)
        self.assertFalse(result["converged"])

    def test_bending_is_reported(self):
        settled = [(x, y, z - 1.0 * math.exp(-(x * x + y * y) / 300)) for x, y, z in hill(1200, 4)]
        write_ply(self.folder / "settled.ply", settled)
        result = self.json_of(*self.register("--method", "nonrigid", target="settled.ply"))
        self.assertEqual(result["nonrigid"]["outcome"], "converged")
        # Points 1.4 mm apart: those at the border may slide by a few of these.
        self.assertLess(result["nonrigid"]["largest_move_mm"], 6.0)
        self.assertLess(result["nonrigid"]["sigma_mm"], 1.4)

    def assert_register_refused(self, status, *says, **files):
        self.assert_refused(self.incise(*self.register(**files)), status, *says)
        self.assert_nothing_written()

    def test_clouds_that_are_none_are_refused(self):
        write_ply(self.folder / "empty.ply", [])
        write_ply(self.folder / "one.ply", [(1.0, 2.0, 3.0)])
        write_ply(self.folder / "nan.ply", hill(20, 1) + [(float("nan"), 0.0, 0.0)])
        self.assert_register_refused(BAD_DATA, "one.ply", "found 1", "at least 12", source="one.ply")
        self.assert_register_refused(BAD_DATA, "empty.ply", source="empty.ply")
        self.assert_register_refused(BAD_DATA, "nan.ply", "line 28", "nan", target="nan.ply")
        self.assert_register_refused(BAD_DATA, "missing.ply", target="missing.ply")

    def test_a_scale_that_is_none_is_the_command_lines_fault(self):
        for scale in ("some", "1.1,0.9", "0,1", "0.9", "0.9,1.1,2"):
            with self.subTest(scale=scale):
                self.assert_refused(self.incise(*self.register("--scale", scale)), BAD_CASE, "--scale", scale)
                self.assert_nothing_written()

    def test_ctrl_c_leaves_nothing(self):
        done = self.interrupted(*self.register("--rotations", "2000"), after="searching poses")
        self.assertEqual(done.returncode, INTERRUPTED, done.stderr)
        self.assert_nothing_written()


class SurfaceTest(CommandTest):
    def test_the_top_of_a_tet_mesh_is_sampled(self):
        small_case.write_msh(self.folder / "block.msh", *small_case.block())
        result = self.json_of("surface", "block.msh", "-o", "top.ply", "--spacing-mm", "1")
        self.assertAlmostEqual(result["area_mm2"], 2400.0, delta=60.0)
        self.assertGreater(result["points"], 1000)
        text = (self.folder / "top.ply").read_bytes()[:400].decode("ascii", "replace")
        self.assertIn("property double nx", text)

    def test_a_scan_loses_its_table(self):
        table = [(float(i), float(j), -3.0) for i in range(-40, 41, 2) for j in range(-30, 31, 2)]
        write_ply(self.folder / "scan.ply", [p for p in hill(1500, 1) if p[2] > 0] + table)
        result = self.json_of("surface", "scan.ply", "-o", "tissue.vtp", "--planes", "1", "--plane-tolerance-mm", "0.5", "--voxel-mm", "1")
        self.assertEqual(len(result["planes"]), 1)
        self.assertEqual(result["planes"][0]["points"], len(table))
        self.assertTrue((self.folder / "tissue.vtp").is_file())

    def test_a_box_without_points_is_told(self):
        write_ply(self.folder / "scan.ply", hill(100, 1))
        done = self.incise("surface", "scan.ply", "-o", "tissue.ply", "--box", *"500 500 500 600 600 600".split())
        self.assert_refused(done, BAD_DATA, "scan.ply", "0 points left")
        self.assert_nothing_written(self.folder / "tissue.ply")

    def test_another_ending_is_the_command_lines_fault(self):
        write_ply(self.folder / "scan.ply", hill(100, 1))
        self.assert_refused(self.incise("surface", "scan.ply", "-o", "tissue.txt"), BAD_CASE, "-o", "tissue.txt")


if __name__ == "__main__":
    unittest.main()
