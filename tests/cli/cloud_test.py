"""`incise surface` and `incise register`: results, exit statuses, messages."""

import json
import math
import random
import unittest

import small_case
from command import BAD_CASE, BAD_DATA, DONE, INTERRUPTED, NOT_ACCEPTABLE, CommandTest, files_below
from small_cloud import RegisterCase, hill, turned, write_ply


class RegisterTest(RegisterCase):
    def test_a_turned_cloud_is_found_and_the_folder_is_complete(self):
        result = self.json_of(*self.register(starts=()))
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

    def test_a_scale_at_the_end_of_its_range_is_not_acceptable(self):
        result = self.json_of(*self.register("--scale", "0.99,1.2"), status=NOT_ACCEPTABLE)
        self.assertEqual((result["outcome"], result["converged"], result["scale_at_limit"]), ("scale_at_limit", False, True))
        self.assertTrue(any("is at the end of its range, 0.99" in reason for reason in result["reasons"]), result["reasons"])
        self.assert_chain_ends("/converged", "false")

    def test_an_input_is_never_the_output(self):
        before = (self.folder / "b.ply").read_bytes()
        self.assert_refused(self.incise("surface", "b.ply", "-o", "b.ply"), BAD_CASE, "-o: found b.ply, which is an input")
        (self.folder / "same.ply").symlink_to("b.ply")
        self.assert_refused(self.incise("surface", "b.ply", "-o", "same.ply"), BAD_CASE, "-o: found same.ply, which is an input")
        self.assertEqual((self.folder / "b.ply").read_bytes(), before)
        self.json_of(*self.register("--from-identity", source="b.ply"))
        for arguments in (
            self.register(source="out/moved_source.ply"),
            ("project", "a.ply", "--transform", "out/registration.json", "--surface", "b.ply", "-o", "out"),
        ):
            self.assert_refused(self.incise(*arguments), BAD_CASE, "-o: found out, which holds the input out/")
        self.assertTrue((self.out / "registration.json").is_file())

    def test_a_flat_cloud_is_ill_determined_and_the_result_is_written(self):
        numbers = random.Random(3)
        flat = [(numbers.uniform(-30, 30), numbers.uniform(-20, 20), 0.0) for _ in range(600)]
        write_ply(self.folder / "flat.ply", flat)
        result = self.json_of(*self.register(source="flat.ply", target="flat.ply"), status=NOT_ACCEPTABLE)
        self.assertFalse(result["converged"])
        self.assertTrue(any("hardly changes the residual" in reason for reason in result["reasons"]), result["reasons"])
        self.assertTrue((self.out / "registration.json").is_file())
        self.json_of(*self.register(source="flat.ply"), status=NOT_ACCEPTABLE)
        self.assert_chain_ends("/converged", "false")

    def test_a_line_has_no_transform(self):
        write_ply(self.folder / "line.ply", [(i, 2.0 * i, -i) for i in range(50)])
        result = self.json_of(*self.register(source="line.ply"), status=NOT_ACCEPTABLE)
        self.assertEqual(result["outcome"], "degenerate")
        self.assertIsNone(result["T_target_source"])

    def test_a_stray_point_is_named_for_what_it_is(self):
        write_ply(self.folder / "stray.ply", [*hill(200, 1), (1e12, 0.0, 0.0)])
        self.assert_refused(self.incise(*self.register(source="stray.ply")), BAD_DATA, "stray.ply: point 200: found a coordinate of 1e+12")
        self.assert_refused(self.incise(*self.register(target="stray.ply")), BAD_DATA, "stray.ply: point 200: found a coordinate of 1e+12")
        write_ply(self.folder / "stray.ply", [*hill(200, 1), (1e8, 0.0, 0.0)])
        self.assert_refused(self.incise(*self.register(source="stray.ply")), BAD_DATA, "stray.ply: points: found a cloud 1e+08 wide")
        self.assert_nothing_written()

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

    def assert_chain_ends(self, *says):
        """No path, and so no program, follows from a registration that failed."""
        path = small_case.path([[8 * math.cos(a), 8 * math.sin(a), 10] for a in range(6)], "sim_stretched", tumor_edge=[])
        (self.folder / "path.json").write_text(json.dumps(path))
        done = self.incise("project", "path.json", "--transform", self.out / "registration.json", "--surface", "b.ply", "-o", "projected")
        self.assert_refused(done, BAD_DATA, "registration.json", "a registration that converged", *says)
        self.assert_nothing_written(self.folder / "projected")

    def test_no_path_follows_from_points_in_one_place(self):
        write_ply(self.folder / "place.ply", [(1.0, 2.0, 3.0)] * 50)
        result = self.json_of(*self.register(source="place.ply"), status=NOT_ACCEPTABLE)
        self.assertEqual(result["outcome"], "degenerate")
        self.assert_chain_ends("/T_target_source", "null")

    def test_a_mirror_image_is_no_registration(self):
        write_ply(self.folder / "mirror.ply", turned([(-x, y, z) for x, y, z in hill(1200, 2)]))
        result = self.json_of(*self.register(target="mirror.ply"), status=NOT_ACCEPTABLE)
        self.assertEqual((result["outcome"], result["converged"]), ("mirrored", False))
        self.assertGreater(result["mirror_score"], result["score"])
        self.assertLess(result["mirror_rmse_mm"], result["shape_rmse_mm"])
        self.assertTrue(any("mirror image" in reason and f"{result['mirror_rmse_mm']:.3g} mm" in reason for reason in result["reasons"]), result["reasons"])
        self.assert_chain_ends("/converged", "false")

    def test_identical_clouds_stay_where_they_are(self):
        result = self.json_of(*self.register(target="a.ply"))
        self.assertAlmostEqual(result["scale"], 1.0, places=4)
        self.assertLess(result["rotation_deg"], 0.01)
        self.assertLess(result["rmse_mm"], 0.001)

    def test_a_scale_that_is_none_is_the_command_lines_fault(self):
        for scale in ("some", "1.1,0.9", "0,1", "0.9", "0.9,1.1,2"):
            with self.subTest(scale=scale):
                self.assert_refused(self.incise(*self.register("--scale", scale)), BAD_CASE, "--scale", scale)
                self.assert_nothing_written()

    def test_a_number_that_is_none_is_told_by_its_option(self):
        for option in ("--settling-mm", "--outlier-weight", "--max-rmse-mm", "--smoothness", "--stiffness"):
            with self.subTest(option=option):
                self.assert_refused(self.incise(*self.register(option, "nan")), BAD_CASE, f"command line: {option}: found", "nan", "expected ")
                self.assert_nothing_written()

    def test_ctrl_c_leaves_nothing(self):
        done = self.interrupted(*self.register(starts=("--rotations", "2000")), after="searching poses")
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

    def test_a_vertex_far_away_and_a_spacing_far_too_fine_take_no_memory(self):
        vertices, tets = small_case.block(cells=(4, 6, 2))
        for far in (2147483647.0, 1e300):
            small_case.write_msh(self.folder / "far.msh", [(20.0, far, 0.0), *vertices[1:]], tets)
            self.assert_refused(self.incise("surface", "far.msh", "-o", "top.ply", cpu_s=60), BAD_DATA, "far.msh")
        small_case.write_msh(self.folder / "block.msh", vertices, tets)
        self.assert_refused(self.incise("surface", "block.msh", "--spacing-mm", 0.01, "-o", "top.ply", cpu_s=60), BAD_DATA, "block.msh", "--spacing-mm")
        self.assert_nothing_written(self.folder / "top.ply")

    def test_a_scan_loses_its_table(self):
        table = [(float(i), float(j), -3.0) for i in range(-40, 41, 2) for j in range(-30, 31, 2)]
        write_ply(self.folder / "scan.ply", [p for p in hill(1500, 1) if p[2] > 0] + table)
        result = self.json_of("surface", "scan.ply", "-o", "tissue.vtp", "--planes", "1", "--plane-tolerance-mm", "0.5", "--voxel-mm", "1")
        self.assertEqual(len(result["planes"]), 1)
        self.assertEqual(result["planes"][0]["points"], len(table))
        self.assertTrue((self.folder / "tissue.vtp").is_file())

    def test_a_plane_of_known_height_gives_the_cameras_scale(self):
        scale = 1.02
        table = [(float(i), float(j), 300.0) for i in range(-40, 41, 2) for j in range(-30, 31, 2)]
        scan = [(scale * x, scale * y, scale * z) for x, y, z in [(x, y, 297.0 - z) for x, y, z in hill(1500, 1) if z > 0] + table]
        write_ply(self.folder / "scan.ply", scan)
        (self.folder / "camera.json").write_text(json.dumps({"T_robot_camera": [[1, 0, 0, 500], [0, -1, 0, 0], [0, 0, -1, 310], [0, 0, 0, 1]]}))
        arguments = ("surface", "scan.ply", "-o", "tissue.ply", "--planes", "1", "--plane-tolerance-mm", "0.5", "--approach", 0, 0, 1)
        result = self.json_of(*arguments, "--camera", "camera.json", "--plane-z-mm", 10)
        self.assertAlmostEqual(result["camera_scale"], scale, places=5)
        self.assertLess(result["plane_tilt_deg"], 0.01)
        # What was taken out is not forgotten: a registration on that cloud knows of it.
        write_ply(self.folder / "a.ply", [(x + 500, -y, z) for x, y, z in hill(1500, 1)])
        found = self.json_of("register", "--source", "tissue.ply", "--target", "tissue.ply", "--scale", "fixed", "--from-identity", "-o", "out")
        self.assertAlmostEqual(found["camera_scale"], scale, places=5)
        self.assertEqual(self.json_of("register", "--source", "a.ply", "--target", "a.ply", "--from-identity", "-o", "plain")["camera_scale"], 1)
        (self.folder / "tissue.ply").unlink()
        doubtful = self.incise(*arguments, "--camera", "camera.json", "--plane-z-mm", 31, "--json", status=DONE)
        self.assertAlmostEqual(json.loads(doubtful.stdout)["camera_scale"], scale * 300 / 279, places=4)
        self.assertIn("the camera's scale is 1.09", doubtful.stderr)
        (self.folder / "tissue.ply").unlink()
        vtp = [a if a != "tissue.ply" else "tissue.vtp" for a in arguments]
        self.assert_refused(self.incise(*vtp, "--camera", "camera.json", "--plane-z-mm", 10), BAD_CASE, "-o", "tissue.vtp", ".ply")
        for more, status, says in (
            (("--camera", "camera.json", "--plane-z-mm", 100), BAD_DATA, "the largest plane"),
            (("--camera", "camera.json"), BAD_CASE, "--plane-z-mm"),
            (("--plane-z-mm", 10), BAD_CASE, "--camera"),
        ):
            self.assert_refused(self.incise(*arguments, *more), status, says)
            self.assert_nothing_written(self.folder / "tissue.ply")

    def test_points_that_are_no_surface_are_refused(self):
        wide = [(x * 1e30, y, z) for x, y, z in hill(100, 1)]
        for name, points, says in (
            ("place", [(1.0, 2.0, 3.0)] * 2000, "found all 2000 in one place"),
            ("line", [(0.1 * i, 0.2 * i, 0.3 * i) for i in range(1000)], "found all 1000 on a line"),
            ("wide", wide, "e+31"),
            ("metres", [(1e3 * x, 1e4 * y, z) for x, y, z in hill(100, 1)], "wide, expected at most 100000 mm of tissue"),
            ("one", [(1.0, 2.0, 3.0)], "1 "),
        ):
            with self.subTest(cloud=name):
                write_ply(self.folder / f"{name}.ply", points)
                self.assert_refused(self.incise("surface", f"{name}.ply", "-o", "tissue.ply"), BAD_DATA, f"{name}.ply", says)
                self.assert_nothing_written(self.folder / "tissue.ply")

    def test_a_box_without_points_is_told(self):
        write_ply(self.folder / "scan.ply", hill(100, 1))
        done = self.incise("surface", "scan.ply", "-o", "tissue.ply", "--box", *"500 500 500 600 600 600".split())
        self.assert_refused(done, BAD_DATA, "scan.ply", "0 points left")
        self.assert_nothing_written(self.folder / "tissue.ply")
        done = self.incise("surface", "scan.ply", "-o", "tissue.ply", "--box", *"5 5 5 1 1 1".split())
        self.assert_refused(done, BAD_CASE, "command line: --box: found", "expected the low corner below the high one")
        self.assertEqual(done.stderr.count("expected"), 1)

    def test_another_ending_is_the_command_lines_fault(self):
        write_ply(self.folder / "scan.ply", hill(100, 1))
        self.assert_refused(self.incise("surface", "scan.ply", "-o", "tissue.txt"), BAD_CASE, "-o", "tissue.txt")


if __name__ == "__main__":
    unittest.main()
