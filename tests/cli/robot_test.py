"""A path in the robot's frame becomes a program, or a clear refusal; programs are played."""

import csv
import json
import math
import pathlib
import struct
import unittest

from command import BAD_CASE, BAD_DATA, DONE, NOT_ACCEPTABLE, CommandTest

EXAMPLE = pathlib.Path(__file__).parents[2] / "examples" / "04_ur10e" / "path.json"


def ring(center=(600.0, 0.0, 100.0), radius=15.0, edge=10.0, depth=5.0, speed=7.0, kind="incise", count=48):
    angles = [2.0 * math.pi * n / count for n in range(count)]

    def circle(r):
        return [[center[0] + r * math.cos(a), center[1] + r * math.sin(a), center[2]] for a in angles]

    waypoints = [{"position_mm": p, "axis": [0, 0, -1], "depth_mm": depth, "speed_mm_s": speed} for p in circle(radius)]
    return {"frame": "robot", "kind": kind, "closed": True, "waypoints": waypoints, "tumor_edge": circle(edge)}


class RobotTest(CommandTest):
    def write(self, path, name="path.json"):
        (self.folder / name).write_text(json.dumps(path))
        return name

    def assert_unsafe(self, path, check, *says, options=()):
        """Exit status 4, a message that names check, waypoint and value, and no file."""
        done = self.incise("export", self.write(path), "-o", "cut.script", "--json", *options)
        self.assertEqual(done.returncode, NOT_ACCEPTABLE, done.stderr)
        failed = [c["name"] for c in json.loads(done.stdout)["checks"] if not c["passed"]]
        self.assertIn(check, failed)
        lines = [line for line in done.stderr.splitlines() if f"not exported: {check}: " in line]
        self.assertEqual(len(lines), 1, done.stderr)
        for words in says:
            self.assertIn(words, lines[0])
        self.assert_nothing_written(self.folder / "cut.script")


class ExportTest(RobotTest):
    def test_the_example_is_exported_and_played_in_every_form(self):
        forms = {"cut.script": ["urscript"], "stream.script": ["urscript", "--motion", "servoj"], "cut.csv": ["joint-csv"], "cut.json": ["json"]}
        for name, options in forms.items():
            with self.subTest(form=name):
                made = self.json_of("export", EXAMPLE, "--robot", "ur10e", "--format", *options, "-o", name)
                for key in ("duration_s", "max_tip_speed_mm_s", "min_singular_value", "checks", "joint_travel_deg"):
                    self.assertIn(key, made)
                played = self.json_of("replay", name, "-o", "replay_" + name)
                self.assertLess(played["max_deviation_mm"], 0.3)
                self.assertAlmostEqual(played["tip_speed_mm_s"]["mean"], 7.0, delta=0.07)
                folder = self.folder / ("replay_" + name)
                for product in ("replay.svg", "true_path.csv", "replay.json", "manifest.json"):
                    self.assertTrue((folder / product).is_file(), product)

    def test_ros_forms_are_chosen_by_their_ending(self):
        self.json_of("export", EXAMPLE, "--format", "ros-trajectory", "-o", "cut.yaml")
        self.assertIn("joint_names:", (self.folder / "cut.yaml").read_text())
        self.json_of("export", EXAMPLE, "--format", "ros-trajectory", "-o", "cut.bag")
        bag = (self.folder / "cut.bag").read_bytes()
        self.assertTrue(bag.startswith(b"#ROSBAG V2.0\n"))
        length = struct.unpack("<I", bag[13:17])[0]
        self.assertIn(b"index_pos=", bag[17 : 17 + length])
        self.assert_refused(self.incise("export", EXAMPLE, "--format", "ros-trajectory", "-o", "cut.txt"), BAD_CASE, "cut.txt", ".bag")

    def test_another_frame_is_refused(self):
        path = ring()
        path["frame"] = "sim_stretched"
        self.assert_refused(self.incise("export", self.write(path), "-o", "cut.script"), BAD_DATA, "path.json", "sim_stretched", "expected robot")
        self.assert_nothing_written(self.folder / "cut.script")

    def test_a_path_through_the_tumour_is_unsafe(self):
        path = ring()
        path["waypoints"][12]["position_mm"] = [600.0, 8.0, 100.0]
        self.assert_unsafe(path, "margin", "at waypoint 12", "has to be >= 2.2 mm")

    def test_an_unreachable_path_is_unsafe(self):
        self.assert_unsafe(ring(center=(1600.0, 0.0, 100.0)), "reach", "at waypoint 0", "too_far")
        self.assert_unsafe(ring(center=(0.0, 0.0, 900.0)), "reach", "inside_shoulder")

    def test_a_stretched_arm_is_unsafe(self):
        waypoints = [{"position_mm": [1474.0, -200.0 + 5.0 * n, 250.0], "axis": [1, 0, 0], "depth_mm": 5, "speed_mm_s": 4} for n in range(5)]
        for x in range(1440, 1560, 4):
            path = {"frame": "robot", "kind": "incise", "closed": False, "waypoints": [{**w, "position_mm": [x, *w["position_mm"][1:]]} for w in waypoints]}
            done = self.incise("export", self.write(path), "--open", "-o", "cut.script", "--json")
            if done.returncode != DONE:
                break
            (self.folder / "cut.script").unlink()
        self.assert_unsafe(path, "singularity", "at waypoint", "has to be >= 0.03", options=["--open"])

    def test_a_mark_has_a_list_of_its_own(self):
        mark = ring(radius=10.0, depth=1.0, speed=2.0, kind="mark")
        self.json_of("export", self.write(mark), "--kind", "mark", "-o", "mark.script")
        self.assert_unsafe(ring(radius=10.5, depth=1.0, speed=2.0, kind="mark"), "edge_distance", "has to be <= 0.3 mm")
        self.assert_unsafe(ring(radius=10.0, depth=2.0, speed=2.0, kind="mark"), "depth", "1 mm")
        self.assert_unsafe(ring(radius=10.0, depth=1.0, speed=7.0, kind="mark"), "speed_max")

    def test_an_override_is_typed_for_each_check_and_stands_in_the_program(self):
        path = ring(radius=11.0, depth=6.0)
        self.assert_unsafe(path, "margin", options=["--override", "depth"])
        done = self.incise("export", self.write(path), "--override", "depth", "--override", "margin", "-o", "cut.script")
        self.assertEqual(done.returncode, DONE, done.stderr)
        text = (self.folder / "cut.script").read_text()
        self.assertIn("# incise.override: depth: 1 mm at waypoint", text)
        self.assertIn("# incise.override: margin: ", text)

    def test_an_override_that_is_no_check_or_may_not_be_is_refused(self):
        path = self.write(ring())
        self.assert_refused(self.incise("export", path, "--override", "margn", "-o", "cut.script"), BAD_CASE, "--override", "'margn'", "Did you mean 'margin'?")
        for name in ("finite", "frame", "reach"):
            self.assert_refused(self.incise("export", path, "--override", name, "-o", "cut.script"), BAD_CASE, f"'{name}'", "this one cannot")
        self.assert_nothing_written(self.folder / "cut.script")

    def test_a_bad_registration_is_unsafe_and_a_damaged_one_is_refused(self):
        good = {"T_target_source": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], "scale": 1.01, "rmse_mm": 0.3, "inlier_fraction": 0.9, "converged": True}
        for change, check in (({"scale": 0.9}, "scale"), ({"rmse_mm": 3.0}, "rmse"), ({"inlier_fraction": 0.1}, "inliers"), ({"converged": False}, "converged")):
            self.write({**good, **change}, "registration.json")
            self.assert_unsafe(ring(), "registration_" + check, options=["--registration", "registration.json"])
        del good["rmse_mm"]
        self.write(good, "registration.json")
        done = self.incise("export", self.write(ring()), "--registration", "registration.json", "-o", "cut.script")
        self.assert_refused(done, BAD_DATA, "registration.json", "rmse_mm")

    def test_heat_that_reaches_the_tumour_edge_is_not_exported(self):
        slow = ring(speed=0.6)  # 5 mm outside the edge
        self.json_of("export", self.write(slow), "-o", "slow.script")  # nobody knows its power
        options = ["--power-w", "35"]
        self.assert_unsafe(slow, "heat", "5 mm at waypoint", "has to be >= 32.", options=options)
        self.json_of("export", self.write(ring(speed=7.0)), *options, "-o", "fast.script")
        done = self.incise("export", self.write(slow), *options, "--override", "heat", "-o", "slow.script")
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assertIn("overridden: heat", done.stderr)

    def test_waypoints_that_no_tool_can_follow_are_refused(self):
        path = ring()
        path["waypoints"][6] = path["waypoints"][5]
        done = self.incise("export", self.write(path), "-o", "cut.script")
        self.assert_refused(done, BAD_DATA, "path.json: waypoints: found 0 mm after waypoint 5, expected tips more than 0.001 mm apart")
        self.assertEqual(done.stderr.count("expected"), 1)
        path = ring()
        path["waypoints"][6]["position_mm"][0] = 1e200
        done = self.incise("export", self.write(path), "-o", "cut.script")
        self.assert_refused(done, BAD_DATA, "path.json: waypoints: found 1e+200 mm at waypoint 6, expected places within 1e+05 mm")
        tiny = ring(radius=1.0, edge=0.5)
        self.assert_refused(self.incise("export", self.write(tiny), "-o", "cut.script"), BAD_DATA, "found 8 mm, expected an overlap below the path's 6.28")
        self.assert_nothing_written(self.folder / "cut.script")


    def test_a_refusal_says_that_an_older_program_was_left(self):
        self.assertEqual(self.incise("export", self.write(ring()), "-o", "cut.script").returncode, DONE)
        older = (self.folder / "cut.script").read_bytes()
        says = "cut.script is of an earlier run and was left as it is"
        unsafe = self.incise("export", self.write(ring(radius=11.0)), "-o", "cut.script", "--json")
        self.assertEqual(unsafe.returncode, NOT_ACCEPTABLE)
        self.assertEqual(json.loads(unsafe.stdout)["stale_output"], "cut.script")
        bad = self.incise("export", "nowhere.json", "-o", "cut.script")
        self.assert_refused(bad, BAD_DATA, "nowhere.json")
        wrong = self.incise("export", "path.json", "--override", "margn", "-o", "cut.script")
        self.assert_refused(wrong, BAD_CASE, "margn")
        for done in (unsafe, bad, wrong):
            self.assertEqual(done.stderr.count(says), 1, done.stderr)
        self.assertEqual((self.folder / "cut.script").read_bytes(), older)
        again = self.incise("export", self.write(ring(speed=6.0)), "-o", "cut.script")
        self.assertEqual(again.returncode, DONE, again.stderr)
        self.assertNotIn("earlier run", again.stderr)
        (self.folder / "cut.script").unlink()
        fresh = self.json_of("export", self.write(ring(radius=11.0)), "-o", "cut.script", status=NOT_ACCEPTABLE)
        self.assertIsNone(fresh["stale_output"])

    def test_an_output_needs_a_name_with_an_ending(self):
        path = self.write(ring())
        for output, says in (("d", "a name that ends in .script"), ("", "-o: found an empty name")):
            self.assert_refused(self.incise("export", path, "-o", output), BAD_CASE, "-o", says)
        self.assertFalse((self.folder / "d").exists())


class ReplayTest(RobotTest):
    def setUp(self):
        super().setUp()
        self.assertEqual(self.incise("export", self.write(ring()), "-o", "cut.script").returncode, DONE)
        self.text = (self.folder / "cut.script").read_text()

    def test_the_slider_halves_the_speed(self):
        played = self.json_of("replay", "cut.script", "--speed-slider", "50")
        self.assertAlmostEqual(played["tip_speed_mm_s"]["mean"], 3.5, delta=0.035)
        self.assertLess(played["max_deviation_mm"], 0.025)

    def test_the_true_path_is_a_table(self):
        self.json_of("replay", "cut.script", "-o", "replay")
        with open(self.folder / "replay" / "true_path.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertGreater(len(rows), 1000)
        self.assertLess(max(float(row["deviation_mm"]) for row in rows), 0.025)

    def assert_line_refused(self, old, new, *says):
        self.assertIn(old, self.text)
        (self.folder / "bad.script").write_text(self.text.replace(old, new, 1))
        self.assert_refused(self.incise("replay", "bad.script", "-o", self.out), BAD_DATA, "bad.script: line ", "expected", *says)
        self.assert_nothing_written()

    def test_a_foreign_or_damaged_line_is_named(self):
        self.assert_line_refused("  movep(", "  popup(", "found 'popup'")
        self.assert_line_refused("  movep(p[", "  movep(p[x", "a number")
        self.assert_line_refused("end\n\nincise_cut()\n", "", "cut short")

    def test_a_foreign_script_and_a_missing_file_are_refused(self):
        (self.folder / "other.script").write_text("movej([0, 0, 0, 0, 0, 0])\n")
        self.assert_refused(self.incise("replay", "other.script"), BAD_DATA, "other.script: line 1", "def NAME():")
        self.assert_refused(self.incise("replay", "nowhere.script"), BAD_DATA, "nowhere.script")

    def test_joints_beyond_their_limits_end_the_replay(self):
        start = next(line for line in self.text.splitlines() if line.startswith("  movej(["))
        (self.folder / "far.script").write_text(self.text.replace(start, "  movej([7.0," + start.split(",", 1)[1], 1))
        done = self.incise("replay", "far.script", "-o", "replay", "--json")
        self.assertEqual(done.returncode, NOT_ACCEPTABLE, done.stderr)
        result = json.loads(done.stdout)
        self.assertEqual((result["outcome"], result["line"]), ("joint_limits", self.text[: self.text.index(start)].count("\n") + 1))
        self.assertIn("shoulder_pan_joint at 401.1 degrees", done.stderr)
        self.assertTrue((self.folder / "replay" / "replay.json").is_file())

    def test_programs_that_end_or_begin_in_the_tissue_are_not_acceptable(self):
        self.assertEqual(self.incise("export", "path.json", "--format", "joint-csv", "-o", "cut.csv").returncode, DONE)
        lines = (self.folder / "cut.csv").read_text().splitlines(keepends=True)
        head = next(i for i, line in enumerate(lines) if line.startswith("time_s,")) + 1
        cut = [i for i, line in enumerate(lines) if line.rstrip().endswith(",cut")]
        middle = cut[len(cut) // 2]
        for name, text, outcome in (("short.csv", lines[:middle], "ends_in_tissue"), ("late.csv", lines[:head] + lines[middle:], "starts_in_tissue")):
            with self.subTest(program=name):
                (self.folder / name).write_text("".join(text))
                done = self.incise("replay", name, "--json")
                self.assertEqual(done.returncode, NOT_ACCEPTABLE, done.stderr)
                self.assertEqual(json.loads(done.stdout)["outcome"], outcome)
                self.assertIn("5.00 mm below the surface", done.stderr)
        exit_at = self.text.index("  # phase: exit")
        (self.folder / "stays.script").write_text(self.text[:exit_at] + self.text[self.text.index("end\n"):])
        self.assertEqual(self.json_of("replay", "stays.script", status=NOT_ACCEPTABLE)["outcome"], "ends_in_tissue")

    def test_numbers_in_the_header_that_no_program_has_are_refused(self):
        for key, value in (("overlap_mm", "1e9"), ("overlap_mm", "-8"), ("overlap_mm", "500"), ("clearance_mm", "-5"), ("approach_height_mm", "1e9")):
            with self.subTest(key=key, value=value):
                old = next(line for line in self.text.splitlines() if line.startswith(f"# incise.{key}: "))
                (self.folder / "bad.script").write_text(self.text.replace(old, f"# incise.{key}: {value}", 1))
                self.assert_refused(self.incise("replay", "bad.script", "-o", self.out), BAD_DATA, f"bad.script: header {key}: found {value}", "expected")
                self.assert_nothing_written()
        self.assertEqual(self.incise("export", "path.json", "--format", "ros-trajectory", "-o", "cut.yaml").returncode, DONE)
        self.assert_refused(self.incise("replay", "cut.yaml"), BAD_DATA, "found a .yaml program", "--format joint-csv")

    def test_a_program_that_leaves_the_arms_reach_ends_with_its_line(self):
        first = next(line for line in self.text.splitlines() if line.startswith("  movep("))
        (self.folder / "far.script").write_text(self.text.replace(first, first.replace("p[0.", "p[3.", 1), 1))
        done = self.incise("replay", "far.script", "--json")
        self.assertEqual(done.returncode, NOT_ACCEPTABLE, done.stderr)
        self.assertIn(json.loads(done.stdout)["outcome"], ("unreachable", "blends_overlap"))


if __name__ == "__main__":
    unittest.main()
