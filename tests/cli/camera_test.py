"""Photographs and camera pictures: evaluate PHOTO, track, project."""

import csv
import hashlib
import json
import math
import unittest

import small_case
import small_photo
from command import BAD_CASE, BAD_DATA, DONE, NOT_ACCEPTABLE, CommandTest, files_below
from sealed_json import sealed
from small_photo import GREEN, RED

SCALE = 0.06  # mm per pixel
TUMOR = (6.0 / SCALE, 4.0, GREEN, 0.0)


class PhotoTest(CommandTest):
    def photo(self, *rings, name="cut.png", **more):
        return small_photo.ring_photo(self.folder / name, rings=rings, **more)

    def ring(self, radius_mm, opening_deg=0.0, width_px=4.0):
        return (radius_mm / SCALE, width_px, RED, opening_deg)

    def refused(self, photo, status, *says, scale=SCALE):
        self.assert_refused(self.incise("evaluate", photo, "--mm-per-pixel", scale), status, *says)

    def test_a_good_cut_is_measured_and_drawn(self):
        photo = self.photo(TUMOR, self.ring(10.0))
        result = self.json_of("evaluate", photo, "--mm-per-pixel", SCALE, "--figure", "found.png", "-o", "evaluation.json")
        self.assertEqual(result["outcome"], "success")
        self.assertEqual(result["contour"], "inner_edge")
        self.assertAlmostEqual(result["target_mm"], 4.5)
        self.assertAlmostEqual(result["abs_error_mm"]["mean"], 0.5, delta=0.02)
        self.assertAlmostEqual(result["signed_error_mm"]["mean"], -0.5, delta=0.02)
        self.assertAlmostEqual(result["centroid_shift_mm"], 0.0, delta=0.02)
        self.assertTrue(result["closed_loop"])
        self.assertTrue((self.folder / "found.png").is_file())
        self.assertEqual(json.loads((self.folder / "evaluation.json").read_text()), result)

    def test_16_bits_and_alpha_give_the_same_answer(self):
        rings = (TUMOR, self.ring(10.0))
        plain = self.json_of("evaluate", self.photo(*rings), "--mm-per-pixel", SCALE)
        for more in ({"bits": 16}, {"channels": 4}):
            other = self.json_of("evaluate", self.photo(*rings, name="other.png", **more), "--mm-per-pixel", SCALE)
            self.assertEqual(other["abs_error_mm"], plain["abs_error_mm"])

    def test_the_inner_border_of_a_painted_kerf_is_measured(self):
        width_px = 20.0
        photo = self.photo(TUMOR, self.ring(10.5 + 0.5 * width_px * SCALE, width_px=width_px))
        result = self.json_of("evaluate", photo, "--mm-per-pixel", SCALE, "--red", "kerf")
        self.assertAlmostEqual(result["signed_error_mm"]["mean"], 0.0, delta=0.02)
        middle = self.json_of("evaluate", photo, "--mm-per-pixel", SCALE, "--red", "kerf", "--contour", "centerline")
        self.assertAlmostEqual(middle["signed_error_mm"]["mean"], -0.5 + 0.5 * width_px * SCALE, delta=0.02)

    def test_an_open_ring_and_a_positive_margin_are_results(self):
        opened = self.json_of("evaluate", self.photo(TUMOR, self.ring(10.0, opening_deg=15.0)), "--mm-per-pixel", SCALE, status=NOT_ACCEPTABLE)
        self.assertEqual(opened["outcome"], "open_loop")
        self.assertFalse(opened["closed_loop"])
        self.assertAlmostEqual(opened["red_line"]["max_gap_mm"], 10.0 * math.radians(15.0), delta=0.3)
        inside = self.json_of("evaluate", self.photo(TUMOR, self.ring(4.0)), "--mm-per-pixel", SCALE, status=NOT_ACCEPTABLE)
        self.assertEqual(inside["outcome"], "positive_margin")
        self.assertFalse(inside["negative_margin"])

    def test_two_points_give_the_scale(self):
        photo = self.photo(TUMOR, self.ring(10.0))
        result = self.json_of("evaluate", photo, "--two-points", 0, 0, 300, 400, 30)
        self.assertAlmostEqual(result["mm_per_pixel"], SCALE, places=9)

    def test_a_photograph_that_cannot_be_measured_is_refused(self):
        self.refused(self.photo(TUMOR), BAD_DATA, "cut.png", "no red line")
        self.refused(self.photo(self.ring(10.0)), BAD_DATA, "no green line")
        self.refused(self.photo((100.0, 4.0, GREEN, 20.0), self.ring(10.0)), BAD_DATA, "open tumour edge", "gap of")
        self.refused(self.photo(TUMOR, self.ring(10.0)), BAD_DATA, "Is the scale right?", scale=1.0)

    def test_files_that_are_no_colour_photograph_are_refused(self):
        self.refused(self.photo(TUMOR, channels=1), BAD_DATA, "greyscale")
        whole = self.photo(TUMOR, self.ring(10.0))
        cut = self.folder / "short.png"
        cut.write_bytes(whole.read_bytes()[:5000])
        self.refused(cut, BAD_DATA, "short.png", "byte 5000", "the end of the file")
        self.refused(self.folder / "nowhere.png", BAD_DATA, "nowhere.png")
        text = self.folder / "letter.jpg"
        text.write_text("Dear colleague,")
        self.refused(text, BAD_DATA, "another kind of file")

    def test_damage_within_a_file_is_refused(self):
        whole = self.photo(TUMOR, self.ring(10.0)).read_bytes()
        broken = self.folder / "broken.png"
        for place in (40, len(whole) // 2, len(whole) - 20):
            with self.subTest(place=place):
                broken.write_bytes(whole[:place] + bytes([whole[place] ^ 0xFF]) + whole[place + 1 :])
                done = self.incise("evaluate", broken, "--mm-per-pixel", SCALE, "-o", "out")
                self.assert_refused(done, BAD_DATA, "broken.png", "a picture that cannot be read (")
                self.assert_nothing_written()
        broken.write_bytes(b"")
        self.refused(broken, BAD_DATA, "an empty file")
        self.refused(self.folder, BAD_DATA, "a folder")

    def test_a_ring_that_runs_out_of_the_picture_is_not_called_open(self):
        self.refused(self.photo(TUMOR, self.ring(10.0), center=(250.0, 130.0)), BAD_DATA, "cut.png", "runs out of the picture")

    def test_a_straight_cut_beside_the_tumour_is_an_open_ring(self):
        # A band of a very wide circle is as good as a line.
        photo = small_photo.ring_photo(self.folder / "cut.png", rings=(TUMOR, (170.0, 4.0, RED, 290.0)))
        result = self.json_of("evaluate", photo, "--mm-per-pixel", SCALE, status=NOT_ACCEPTABLE)
        self.assertEqual(result["outcome"], "open_loop")
        self.assertLess(result["coverage"], 0.25)
        self.assertIsNone(result["hu_score"])

    def test_red_in_the_tumour_is_told(self):
        plain = self.json_of("evaluate", self.photo(TUMOR, self.ring(10.0)), "--mm-per-pixel", SCALE)
        self.assertEqual((plain["red_in_tumor"], plain["warnings"]), ([], []))
        photo = self.photo(TUMOR, self.ring(10.0), (0.0, 9.0, RED, 0.0))  # a spot of 10 pixels in the middle
        done = self.incise("evaluate", photo, "--mm-per-pixel", SCALE, "--json", "--quiet")
        result = json.loads(done.stdout)
        self.assertEqual(result["outcome"], "success")
        (spot,) = result["red_in_tumor"]
        self.assertAlmostEqual(spot["u_px"], 250.0, delta=1.0)
        self.assertAlmostEqual(spot["longest_mm"], 10.0 * SCALE, delta=3.0 * SCALE)
        self.assertIn("1 red spot inside the tumour's edge", result["warnings"][0])
        said = self.incise("evaluate", photo, "--mm-per-pixel", SCALE)
        for stderr in (done.stderr, said.stderr):
            self.assertEqual(stderr.count("warning: 1 red spot inside"), 1)
        self.assertNotIn("red spot", said.stdout)

    def test_gaps_as_large_as_the_picture_are_refused(self):
        photo = self.photo(TUMOR, self.ring(10.0))
        done = self.incise("evaluate", photo, "--mm-per-pixel", SCALE, "--max-gap-mm", 1000, status=BAD_CASE)
        self.assertIn("--max-gap-mm", done.stderr)

    def test_a_figure_over_a_photograph_is_a_png(self):
        photo = self.photo(TUMOR, self.ring(10.0))
        done = self.incise("evaluate", photo, "--mm-per-pixel", SCALE, "--figure", "found.svg")
        self.assert_refused(done, BAD_CASE, "--figure", ".png")
        self.assertFalse((self.folder / "found.svg").exists())

    def test_a_scale_is_asked_for_once(self):
        photo = self.photo(TUMOR, self.ring(10.0))
        self.assert_refused(self.incise("evaluate", photo), BAD_CASE, "no scale", "--mm-per-pixel")
        self.assert_refused(self.incise("evaluate", photo, "--mm-per-pixel", SCALE, "--ruler", "ticks"), BAD_CASE, "2 scales")
        self.assert_refused(self.incise("evaluate", photo, "--ruler", "ticks"), BAD_DATA, "no ruler")
        self.assert_refused(self.incise("evaluate", photo, "--ruler", "bar"), BAD_CASE, "--ruler-mm")
        one = self.folder / "one.png"
        done = self.incise("evaluate", photo, "--mm-per-pixel", SCALE, "-o", one, "--figure", one)
        self.assert_refused(done, BAD_CASE, "--figure", "-o", "one.png")
        self.assertFalse(one.exists())
        self.assert_refused(self.incise("evaluate"), BAD_CASE, "no input")


CAMERA = {"width": 320, "height": 240, "fx": 500.0, "fy": 500.0, "cx": 160.0, "cy": 120.0, "depth_scale": 0.0001}
Z_MM = 150.0
PIXEL_MM = Z_MM / 500.0
T_ROBOT_CAMERA = [[1, 0, 0, 500], [0, -1, 0, 100], [0, 0, -1, 300], [0, 0, 0, 1]]


class TrackTest(CommandTest):
    def setUp(self):
        super().setUp()
        (self.folder / "camera.json").write_text(json.dumps(CAMERA))
        (self.folder / "mount.json").write_text(json.dumps({"T_robot_camera": T_ROBOT_CAMERA}))

    def scene(self, opening_deg=0.0, hole=None, center=(160.0, 120.0)):
        """A ring of 10 mm radius on a flat plate 150 mm away."""
        small_photo.ring_photo(
            self.folder / "color.png", 320, 240, center, [(10.0 / PIXEL_MM, 4.0, GREEN, opening_deg)]
        )

        def counts(u, v):
            return 0 if hole and abs(u - hole[0]) <= hole[2] and abs(v - hole[1]) <= hole[2] else round(Z_MM * 10)

        small_photo.depth_picture(self.folder / "depth.png", 320, 240, counts)
        return ["track", "color.png", "depth.png", "--intrinsics", "camera.json", "-o", "out"]

    def test_a_ring_becomes_a_contour_in_space(self):
        result = self.json_of(*self.scene())
        self.assertTrue(result["closed_loop"])
        self.assertEqual(result["frame"], "camera")
        self.assertAlmostEqual(result["length_mm"], 2 * math.pi * 10.0, delta=0.3)
        with open(self.out / "contour.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), result["points"])
        for row in rows:
            self.assertAlmostEqual(math.hypot(float(row["x_mm"]), float(row["y_mm"])), 10.0, delta=0.08)
            self.assertAlmostEqual(float(row["z_mm"]), Z_MM, delta=0.06)
        for name in ("cloud.ply", "found.png", "manifest.json"):
            self.assertTrue((self.out / name).is_file(), name)
        self.assertFalse((self.out / "path.json").exists())

    def test_a_plan_is_made_in_the_robots_frame(self):
        result = self.json_of(*self.scene(), "--camera", "mount.json", "--plan", "--margin-mm", 5)
        path = json.loads((self.out / "path.json").read_text())
        self.assertEqual((path["frame"], path["kind"], path["closed"]), ("robot", "incise", True))
        self.assertEqual(result["waypoints"], len(path["waypoints"]))
        for w in path["waypoints"]:
            x, y, z = w["position_mm"]
            self.assertAlmostEqual(math.hypot(x - 500, y - 100), 15.0, delta=0.15)
            self.assertAlmostEqual(z, 300 - Z_MM, delta=0.1)
            self.assertEqual((w["depth_mm"], w["speed_mm_s"]), (5, 7))
            for found, expected in zip(w["axis"], (0, 0, -1)):
                self.assertAlmostEqual(found, expected, places=9)

    def test_path_and_cloud_carry_the_specimens_id(self):
        (self.folder / "mount.json").write_text(json.dumps({"T_robot_camera": T_ROBOT_CAMERA, "specimen_id": "tongue-07"}))
        self.json_of(*self.scene(), "--camera", "mount.json", "--plan", "--margin-mm", 5)
        self.assertEqual(json.loads((self.out / "path.json").read_text())["specimen_id"], "tongue-07")
        self.assertIn(b"comment incise.specimen_id tongue-07\n", (self.out / "cloud.ply").read_bytes())

    def test_a_mark_with_a_gap_is_no_ring(self):
        done = self.incise(*self.scene(opening_deg=25.0), "--camera", "mount.json", "--plan", "--json", status=NOT_ACCEPTABLE)
        self.assertIn("the mark is not closed: it has a gap of", done.stderr)
        result = json.loads(done.stdout)
        self.assertFalse(result["closed_loop"])
        self.assertEqual(result["outcome"], "open_loop")
        self.assertIsNone(result["path"])
        self.assertTrue((self.out / "contour.csv").is_file())
        self.assertFalse((self.out / "path.json").exists())

    def test_a_mark_that_leaves_the_picture_is_not_called_open(self):
        done = self.incise(*self.scene(center=(20.0, 120.0)), "--camera", "mount.json", "--plan", "--json", status=NOT_ACCEPTABLE)
        self.assertIn("the mark leaves the picture at pixel", done.stderr)
        self.assertNotIn("not closed", done.stderr)
        self.assertTrue(json.loads(done.stdout)["leaves_picture"])
        self.assertFalse((self.out / "path.json").exists())

    def test_an_open_mark_can_be_asked_for(self):
        result = self.json_of(*self.scene(opening_deg=90.0), "--open", "--margin-mm", 0, "--camera", "mount.json", "--plan")
        self.assertFalse(result["closed_loop"])
        self.assertFalse(json.loads((self.out / "path.json").read_text())["closed"])
        self.assertAlmostEqual(result["length_mm"], 1.5 * math.pi * 10.0, delta=1.0)

    def test_a_frame_without_a_mark_gives_its_cloud(self):
        marked = self.json_of(*self.scene())
        result = self.json_of(*self.scene(), "--mark", "none")
        self.assertEqual((result["mark"], result["cloud_points"]), ("none", marked["cloud_points"]))
        self.assertEqual(sorted(path.name for path in self.out.iterdir()), ["cloud.ply", "manifest.json"])
        done = self.incise(*self.scene(), "--mark", "none", "--camera", "mount.json", "--plan")
        self.assert_refused(done, BAD_CASE, "--plan: found an option about the mark, with --mark none")
        for option in (("--open",), ("--edge", "inner"), ("--margin-mm", 4), ("--max-gap-mm", 2), ("--depth-mm", 3)):
            self.assert_refused(self.incise(*self.scene(), "--mark", "none", *option), BAD_CASE, f"{option[0]}: found an option about the mark")

    def test_a_hole_in_the_depth_is_bridged_or_told(self):
        ring_px = round(10.0 / PIXEL_MM)
        result = self.json_of(*self.scene(hole=(160 + ring_px, 120, 4)), "--max-hole-mm", 3)
        self.assertGreater(result["max_hole_mm"], 0.3)
        self.assertAlmostEqual(result["length_mm"], 2 * math.pi * 10.0, delta=0.3)
        done = self.incise(*self.scene(hole=(160 + ring_px, 120, 16))[:-1], "other")
        self.assert_refused(done, BAD_DATA, "depth.png", "a hole in the depth under the mark", "mm wide")
        self.assert_nothing_written(self.folder / "other")

    def test_bad_input_is_told(self):
        arguments = self.scene()
        self.assert_refused(self.incise(*arguments, "--plan"), BAD_CASE, "--camera")
        self.assert_refused(self.incise(*arguments, "--mark", "red"), BAD_DATA, "no red line")
        self.assert_refused(self.incise(*arguments, "--camera", "mount.json", "--plan", "--margin-mm", 1000), BAD_CASE, "--margin-mm: found 1000, expected a number from 0 to 50")
        self.assert_refused(self.incise(*arguments[:-1], "."), BAD_CASE, "-o: found ., which holds the input color.png")
        for change, says in (
            ({"width": 320.7}, "/width: found 320.7, expected a whole number of pixels"),
            ({"cx": 1e9}, "/cx: found 1000000000.0, expected a place from -320 to 640"),
            ({"colour": {}}, "/colour: found an unknown key"),
            ({"depth": {**{k: v for k, v in CAMERA.items() if k != "depth_scale"}, "fz": 1}}, "/depth/fz: found an unknown key"),
        ):
            (self.folder / "camera.json").write_text(json.dumps({**CAMERA, **change}))
            self.assert_refused(self.incise(*arguments), BAD_DATA, "camera.json: " + says)
        (self.folder / "camera.json").write_text(json.dumps({**CAMERA, "fx": -1}))
        self.assert_refused(self.incise(*arguments), BAD_DATA, "camera.json", "/fx")
        (self.folder / "camera.json").write_text(json.dumps({**CAMERA, "width": 640}))
        self.assert_refused(self.incise(*arguments), BAD_DATA, "color.png", "320 x 240")
        (self.folder / "camera.json").write_text(json.dumps({**CAMERA, "depth_scale": 1.0}))
        self.assert_refused(self.incise(*arguments), BAD_DATA, "depth_scale")
        self.assert_nothing_written()

    def organised(self, none=None, grid=False, holes=(), size=("num_cols 320", "num_rows 240"), name="scan.ply", by=(1, 1, 1)):
        """The flat plate as a cloud in metres, row by row; `holes` are rectangles u0, v0, u1, v1, `none` what stands for their z, `by` scales its axes."""
        points, places = [], []
        for v in range(240):
            for u in range(320):
                color = GREEN if abs(math.hypot(u - 160, v - 120) - 10.0 / PIXEL_MM) <= 2.0 else small_photo.TISSUE
                is_hole = any(u0 <= u < u1 and v0 <= v < v1 for u0, v0, u1, v1 in holes)
                places.append("0" if is_hole else f"1 {len(points)}")
                if not (is_hole and grid):
                    x, y, z = by[0] * (u - 160) * PIXEL_MM / 1000, by[1] * (v - 120) * PIXEL_MM / 1000, by[2] * Z_MM / 1000
                    place = f"{none} {none} {none}" if is_hole else "%.4f %.4f %.4f" % (x, y, z)
                    points.append("%s %d %d %d" % (place, *color))
        lines = ["ply", "format ascii 1.0"] + [f"obj_info {words}" for words in size] + [f"element vertex {len(points)}"]
        lines += [f"property float {c}" for c in "xyz"] + [f"property uchar {c}" for c in ("red", "green", "blue")]
        lines += ["element range_grid 76800", "property list uchar int vertex_indices"] if grid else []
        (self.folder / name).write_text("\n".join(lines + ["end_header"] + points + (places if grid else [])) + "\n")
        return name

    def track(self, scan, *more):
        return ("track", scan, "--ply-unit-mm", 1000, "-o", "out", *more)

    def test_an_organised_cloud_is_tracked_too(self):
        holes = [(0, 0, 40, 240), (100, 200, 320, 240)]  # a strip to the left, and one below
        for case in ({}, {"none": "nan", "holes": holes}, {"grid": True, "holes": holes}):
            with self.subTest(case=case):
                result = self.json_of(*self.track(self.organised(**case)))
                self.assertTrue(result["closed_loop"])
                self.assertAlmostEqual(result["length_mm"], 2 * math.pi * 10.0, delta=0.3)
                with open(self.out / "contour.csv", newline="") as file:
                    radii = [math.hypot(float(row["x_mm"]), float(row["y_mm"])) for row in csv.DictReader(file)]
                self.assertLess(max(abs(r - 10.0) for r in radii), 0.1)  # a row that is shifted would show
                measured = 320 * 240 - sum((u1 - u0) * (v1 - v0) for u0, v0, u1, v1 in case.get("holes", ()))
                self.assertEqual(result["cloud_points"], measured)

    def test_a_cloud_in_other_rows_is_refused(self):
        self.assert_refused(self.incise(*self.track(self.organised(size=("num_cols 160", "num_rows 240")))), BAD_DATA, "scan.ply: vertices: found 480 rows of 160 places, expected 240 rows")
        self.assert_refused(self.incise(*self.track(self.organised(size=("num_cols 319",)))), BAD_DATA, "scan.ply: vertices: found 76800 places in rows of 319, expected whole rows")
        self.assert_refused(self.incise(*self.track(self.organised(size=("num_cols x",)))), BAD_DATA, "num_cols: found 'x'")
        self.assert_refused(self.incise(*self.track(self.organised(size=()))), BAD_DATA, "scan.ply", "no obj_info num_cols")
        self.assert_refused(self.incise(*self.track(self.organised(), "--ply-width", 240)), BAD_CASE, "--ply-width: found 240, expected 320")
        self.assert_refused(self.incise(*self.track(self.organised(none="inf", holes=[(0, 0, 2, 2)]))), BAD_DATA, "'inf'", "or nan")
        self.assert_nothing_written()

    def test_a_cloud_that_no_camera_sees_is_refused(self):
        for by in ((-1, 1, 1), (1, -1, 1)):
            self.assert_refused(self.incise(*self.track(self.organised(by=by))), BAD_DATA, "scan.ply: vertices: found mirrored columns and rows", "as the camera sees them")
        for by in ((1, 1, -1), (1, -1, -1)):
            self.assert_refused(self.incise(*self.track(self.organised(by=by))), BAD_DATA, "scan.ply: pixel (0, 0): found a point behind the camera", "z above 0")
        self.assert_nothing_written()

    def test_a_gap_that_may_be_too_long_is_told(self):
        closed = self.incise(*self.scene(), "--json")
        self.assertNotIn("taken as closed", closed.stderr)
        self.assertAlmostEqual(json.loads(closed.stdout)["gap_tolerance_mm"], 0.18 + 2 * PIXEL_MM, delta=0.01)
        for gap_mm in (1.05, 1.4):
            done = self.incise(*self.scene(opening_deg=math.degrees(gap_mm / 10.0))[:-1], f"gap{gap_mm}", "--json")
            result = json.loads(done.stdout)
            told = "not closed" if not result["closed_loop"] else "the mark is taken as closed, with a gap of"
            self.assertIn(told, done.stderr)
            self.assertLess(abs(result["max_gap_mm"] - gap_mm), result["gap_tolerance_mm"])


class ProjectTest(CommandTest):
    def setUp(self):
        super().setUp()
        self.write_transform()
        self.write_path()
        self.write_cloud()

    def write_transform(self, scale=1.0, **more):
        matrix = [[0, -scale, 0, 400], [scale, 0, 0, 50], [0, 0, scale, 100], [0, 0, 0, 1]]
        (self.folder / "registration.json").write_text(json.dumps(sealed({"T_target_source": matrix, "scale": scale, "converged": True, **more})))

    def write_path(self, frame="sim_stretched"):
        def circle(radius, count):
            return [[radius * math.cos(2 * math.pi * i / count), radius * math.sin(2 * math.pi * i / count), 0.0] for i in range(count)]

        (self.folder / "path.json").write_text(json.dumps(small_case.path(circle(15.0, 48), frame, tumor_edge=circle(10.0, 60))))

    def write_cloud(self, half_mm=25, hole_mm=0.0):
        """A slope through the sim's origin, 0.5 mm above it, in the robot's frame."""
        points = []
        for i in range(-2 * half_mm, 2 * half_mm + 1):
            for j in range(-2 * half_mm, 2 * half_mm + 1):
                x, y = 0.5 * i, 0.5 * j
                if math.hypot(x - 15.0, y) >= hole_mm:
                    points.append((400 + x, 50 + y, 100.5 + 0.1 * x))
        lines = ["ply", "format ascii 1.0", f"element vertex {len(points)}"] + [f"property double {c}" for c in "xyz"] + ["end_header"]
        (self.folder / "cloud.ply").write_text("\n".join(lines + ["%r %r %r" % p for p in points]) + "\n")

    ARGUMENTS = ["project", "path.json", "--transform", "registration.json", "--surface", "cloud.ply", "-o", "robot.json"]

    def test_the_incision_lies_on_the_measured_surface(self):
        result = self.json_of(*self.ARGUMENTS)
        path = json.loads((self.folder / "robot.json").read_text())
        self.assertEqual((path["frame"], path["kind"]), ("robot", "incise"))
        self.assertEqual(result["waypoints"], 48)
        self.assertLess(result["max_gap_mm"], 0.5)
        self.assertAlmostEqual(result["mean_shift_mm"], 0.5, delta=0.01)
        for w in path["waypoints"]:
            x, y, z = w["position_mm"]
            self.assertAlmostEqual(math.hypot(x - 400, y - 50), 15.0, places=6)
            self.assertAlmostEqual(z, 100.5 + 0.1 * (x - 400), places=4)
            self.assertEqual((w["depth_mm"], w["speed_mm_s"]), (5, 7))

    def held_against(self, *options):
        """Ids of what the projected path carries against itself, but for the cut that nobody simulated."""
        verdict = self.json_of(*self.ARGUMENTS, *options)["verdict"]
        self.assertEqual(json.loads((self.folder / "robot.json").read_text())["verdict"]["reasons"], verdict["reasons"])
        return [reason["id"] for reason in verdict["reasons"] if "no simulated cut along it is known" not in reason["message"]]

    def test_what_speaks_against_a_registration_travels_with_the_path(self):
        self.assertEqual(self.held_against(), [])
        self.write_transform(reasons=["the source's mirror image fits about as well"], handedness_determined=False)
        self.assertEqual(self.held_against(), ["registration"])
        self.assertEqual(self.held_against("--kind", "mark"), ["registration"])
        done = self.incise("export", "robot.json", "--kind", "mark", "-o", "mark.script", status=NOT_ACCEPTABLE)
        self.assertIn("no program: caution: registration", done.stderr)

    def test_a_transform_that_register_did_not_find_is_a_typed_one(self):
        document = json.loads((self.folder / "registration.json").read_text())
        del document["digest_sha256"]
        (self.folder / "registration.json").write_text(json.dumps(document))
        self.assertEqual(self.held_against(), ["typed_transform"])
        self.assertEqual(self.held_against("--kind", "mark"), ["typed_transform"])
        self.take_away()
        document["T_target_source"][2][3] = 97.0
        (self.folder / "registration.json").write_text(json.dumps({**document, "digest_sha256": "0" * 64}))
        self.refused("registration.json", "/digest_sha256", "register again")

    def test_another_axis_or_size_than_the_simulated_one_is_not_the_simulated_cut(self):
        self.assertEqual(self.held_against("--axis", "normal"), ["not_simulated"])
        self.assertEqual(self.held_against("--metric", "camera"), [])
        self.write_transform(scale=1.02)
        self.assertEqual(self.held_against(), [])
        self.assertEqual(self.held_against("--metric", "camera"), ["not_simulated"])

    def test_a_registration_is_held_to_the_cloud_that_it_moved(self):
        (self.folder / "simulated.ply").write_text("a cloud")
        digest = hashlib.sha256(b"a cloud").hexdigest()
        self.write_transform(source="simulated.ply", source_sha256=digest)
        self.json_of(*self.ARGUMENTS)
        self.take_away()
        (self.folder / "simulated.ply").write_text("another cloud")
        self.refused("registration.json", "source_sha256", "simulated.ply", "register again")

    def test_a_mark_of_a_hundred_thousand_waypoints_is_refused(self):
        self.assert_refused(self.incise(*self.ARGUMENTS, "--kind", "mark", "--waypoints", 100000), BAD_CASE, "--waypoints")
        self.assert_refused(self.incise(*self.ARGUMENTS, "--kind", "mark", "--waypoints", "010"), BAD_CASE, "--waypoints: found 010")
        self.assert_refused(self.incise(*self.ARGUMENTS, "--depth-mm", "1e300"), BAD_CASE, "--depth-mm")

    def test_what_export_would_refuse_is_told(self):
        path = json.loads((self.folder / "path.json").read_text())
        self.assertLess(self.json_of(*self.ARGUMENTS)["max_step_mm"], 2.2)
        (self.folder / "path.json").write_text(json.dumps({**path, "waypoints": path["waypoints"][:38]}))
        done = self.incise(*self.ARGUMENTS, "--json", status=DONE)
        self.assertIn("the ring has a gap: 19.84 mm", done.stderr)
        self.assertIn("from waypoint 37 to the next", done.stderr)
        self.assertGreater(json.loads(done.stdout)["max_step_mm"], 18.0)
        upwards = [{**w, "axis": [0, 0, 1]} for w in path["waypoints"]]
        (self.folder / "path.json").write_text(json.dumps({**path, "waypoints": upwards}))
        done = self.incise(*self.ARGUMENTS, "--json", status=DONE)
        self.assertIn("the tool leans 180 degrees from straight down at waypoint 0", done.stderr)
        self.assertAlmostEqual(json.loads(done.stdout)["max_tilt_deg"], 180.0)

    def test_a_refusal_says_that_an_older_path_was_left(self):
        self.json_of(*self.ARGUMENTS)
        older = (self.folder / "robot.json").read_bytes()
        self.write_transform(converged=False)
        done = self.incise(*self.ARGUMENTS)
        self.assert_refused(done, BAD_DATA, "registration.json")
        self.assertIn("robot.json is from an earlier run and was not changed", done.stderr)
        self.assertEqual((self.folder / "robot.json").read_bytes(), older)

    def test_a_mark_follows_the_edge_a_millimetre_deep(self):
        result = self.json_of(*self.ARGUMENTS, "--kind", "mark")
        path = json.loads((self.folder / "robot.json").read_text())
        self.assertEqual(path["kind"], "mark")
        self.assertEqual(result["waypoints"], len(path["waypoints"]))
        for w in path["waypoints"]:
            self.assertEqual((w["depth_mm"], w["speed_mm_s"]), (1, 2))
            self.assertAlmostEqual(math.hypot(w["position_mm"][0] - 400, w["position_mm"][1] - 50), 10.0, delta=0.06)

    def test_a_folder_holds_path_tissue_and_manifest_and_a_file_has_its_manifest_beside_it(self):
        result = self.json_of(*self.ARGUMENTS[:-1], "projected")
        self.assertEqual(files_below(self.folder / "projected"), ["manifest.json", "path.json", "surface.ply"])
        self.assertEqual(result["path"], "projected/path.json")
        self.json_of(*self.ARGUMENTS)
        for manifest in (self.folder / "projected" / "manifest.json", self.folder / "robot.json.manifest.json"):
            kept = json.loads(manifest.read_text())
            self.assertEqual(kept["settings"]["metric"], "ct")
            self.assertEqual([entry["path"] for entry in kept["inputs"]], ["path.json", "registration.json", "cloud.ply"])
        self.assertEqual((self.folder / "projected" / "path.json").read_text(), (self.folder / "robot.json").read_text())

    def radii(self):
        path = json.loads((self.folder / "robot.json").read_text())
        points = [w["position_mm"] for w in path["waypoints"]]
        middle = [sum(p[i] for p in points) / len(points) for i in range(3)]
        determinant = path["T_robot_sim"][0][1] * -path["T_robot_sim"][1][0] * path["T_robot_sim"][2][2]
        return middle, [math.hypot(p[0] - middle[0], p[1] - middle[1]) for p in points], determinant

    def test_the_simulation_keeps_its_size_and_the_path_its_middle(self):
        self.write_transform(scale=1.02)
        result = self.json_of(*self.ARGUMENTS)
        middle, radii, determinant = self.radii()
        self.assertEqual((result["metric"], result["scale_center"]), ("ct", "path"))
        self.assertAlmostEqual(determinant, 1.0, places=9)
        for radius in radii:
            self.assertAlmostEqual(radius, 15.0, places=6)
        self.assertAlmostEqual(middle[0], 400.0, places=6)
        self.json_of(*self.ARGUMENTS, "--metric", "camera")
        _, radii, determinant = self.radii()
        self.assertAlmostEqual(determinant, 1.02**3, places=9)
        for radius in radii:
            self.assertAlmostEqual(radius, 15.3, places=6)

    def test_the_cameras_lengths_are_shortened_about_its_origin_or_a_given_place(self):
        self.write_transform(scale=1.02)
        # A camera whose frame is the robot's, but for a shift.
        (self.folder / "camera.json").write_text(json.dumps({"T_robot_camera": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 400], [0, 0, 0, 1]]}))
        result = self.json_of(*self.ARGUMENTS, "--camera", "camera.json")
        self.assertEqual(result["scale_center"], "camera")
        self.assertEqual(result["scale_center_mm"], [0, 0, 400])
        middle, radii, _ = self.radii()
        self.assertAlmostEqual(middle[0], 400.0 / 1.02, places=6)
        self.assertAlmostEqual(middle[1], 50.0 / 1.02, places=6)
        self.assertAlmostEqual(middle[2], 400.0 + 100.5 / 1.02, delta=0.01)
        self.assertAlmostEqual(result["scale_shift_mm"], (1 - 1 / 1.02) * math.hypot(400, 50, 100), places=6)
        self.assertAlmostEqual(max(radii), 15.0, places=6)
        result = self.json_of(*self.ARGUMENTS, "--scale-center", 400, 50, 100.5)
        self.assertEqual(result["scale_center"], "given")
        self.assertLess(result["scale_shift_mm"], 0.02)
        self.assert_refused(self.incise(*self.ARGUMENTS, "--metric", "camera", "--scale-center", 0, 0, 0), BAD_CASE, "--scale-center")

    def test_an_uncertain_scale_far_from_its_center_is_told(self):
        self.write_transform(scale=1.02, certificate={"scale_sd": 0.003})
        (self.folder / "camera.json").write_text(json.dumps({"T_robot_camera": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 400], [0, 0, 0, 1]]}))
        done = self.incise(*self.ARGUMENTS, "--camera", "camera.json", status=DONE)
        self.assertIn("is uncertain by 0.0030", done.stderr)
        self.take_away()
        self.write_transform(scale=1.02, certificate={"scale_sd": 0.03})
        self.assert_refused(self.incise(*self.ARGUMENTS, "--camera", "camera.json"), BAD_DATA, "registration.json: /certificate/scale_sd: found 0.0300, which is 1", "at most 2.2 mm")
        self.assert_nothing_written(self.folder / "robot.json")
        for lost in ("NaN", -1, []):  # its scale_sd would be, too, and with it this refusal
            self.write_transform(scale=1.02, certificate=lost)
            self.assert_refused(self.incise(*self.ARGUMENTS, "--camera", "camera.json"), BAD_DATA, "registration.json: /certificate: found")

    def take_away(self):
        for name in ("robot.json", "robot.json.manifest.json"):
            (self.folder / name).unlink()

    def refused(self, *says, status=BAD_DATA):
        self.assert_refused(self.incise(*self.ARGUMENTS), status, *says)
        self.assert_nothing_written(self.folder / "robot.json")

    def test_gaps_are_reported_and_large_ones_refused(self):
        self.write_cloud(hole_mm=1.4)
        self.assertAlmostEqual(self.json_of(*self.ARGUMENTS)["max_gap_mm"], 1.4, delta=0.3)
        self.take_away()
        self.write_cloud(hole_mm=4.0)
        self.refused("cloud.ply", "waypoint", "a gap")

    def test_a_surface_that_ends_is_refused(self):
        self.write_cloud(half_mm=12)
        self.refused("cloud.ply", "waypoint")

    def test_registrations_that_cannot_be_trusted_are_refused_or_told(self):
        self.write_transform(converged=False)
        self.refused("registration.json", "converged")
        self.write_transform(outcome="mirrored")
        self.refused("registration.json", "/outcome", "mirrored")
        kept = json.loads((self.folder / "registration.json").read_text())
        (self.folder / "registration.json").write_text(json.dumps({"T_target_source": kept["T_target_source"]}))
        self.refused("registration.json", "/converged: found nothing, expected a registration that converged")
        self.write_transform(scale=1.08)
        done = self.incise(*self.ARGUMENTS, status=DONE)
        self.assertIn("the scale is 1.0800", done.stderr)
        self.take_away()
        (self.folder / "registration.json").write_text(json.dumps({"T_target_source": [[1, 0], [0, 1]]}))
        self.refused("registration.json", "T_target_source", "4 rows")

    def test_paths_of_other_frames_are_refused(self):
        for frame in ("sim_rest", "robot"):
            self.write_path(frame)
            self.refused("path.json", frame, "sim_stretched")


if __name__ == "__main__":
    unittest.main()
