"""A path in the robot's frame becomes a program, or a clear refusal; programs are played."""

import csv
import hashlib
import json
import math
import pathlib
import struct
import unittest

import small_case
from command import BAD_CASE, BAD_DATA, DONE, NOT_ACCEPTABLE, CommandTest, HandMadePaths
from sealed_json import sealed

EXAMPLE = pathlib.Path(__file__).parents[2] / "examples" / "04_ur10e" / "path.json"


def ring(center=(600.0, 0.0, 100.0), radius=15.0, edge=10.0, depth=5.0, speed=7.0, kind="incise", count=48):
    angles = [2.0 * math.pi * n / count for n in range(count)]

    def circle(r):
        return [[center[0] + r * math.cos(a), center[1] + r * math.sin(a), center[2]] for a in angles]

    return small_case.path(circle(radius), waypoint={"depth_mm": depth, "speed_mm_s": speed}, kind=kind, tumor_edge=circle(edge))


class RobotTest(HandMadePaths, CommandTest):
    def write(self, path, name="path.json"):
        (self.folder / name).write_text(json.dumps(path))
        return name

    def assert_unsafe(self, path, check, *says, options=()):
        """Exit status 4, a message that names check, waypoint and value, and no file."""
        done = self.incise("export", self.write(path), "-o", "cut.script", "--json", *options, status=NOT_ACCEPTABLE)
        result = json.loads(done.stdout)
        failed = [c["name"] for c in result["checks"] if not c["passed"]]
        self.assertIn(check, failed)
        self.assertEqual((result["verdict"]["status"], result["gate"]["open"]), ("refused", False))
        self.assertIn("program_check", [reason["id"] for reason in result["verdict"]["reasons"]])
        lines = [line for line in done.stderr.splitlines() if f"no program: refused: program_check: {check}: " in line]
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

    def test_a_virtual_specimen_is_said_to_be_one_in_every_form(self):
        path = self.write({**ring(), "specimen_is": "virtual"})
        for name, form in (("cut.script", "urscript"), ("cut.csv", "joint-csv"), ("cut.json", "json"), ("cut.yaml", "ros-trajectory")):
            self.json_of("export", path, "--format", form, "-o", name)
            self.assertIn("VIRTUAL SPECIMEN", (self.folder / name).read_text(), name)
        self.assert_refused(self.incise("export", self.write({**ring(), "specimen_is": "pork"}), "-o", "x.script"), BAD_DATA, "specimen_is", "pork")

    def test_another_frame_is_refused(self):
        path = ring()
        path["frame"] = "sim_stretched"
        self.assert_refused(self.incise("export", self.write(path), "-o", "cut.script"), BAD_DATA, "path.json", "sim_stretched", "expected robot")
        self.assert_nothing_written(self.folder / "cut.script")

    def test_a_path_through_the_tumour_is_unsafe(self):
        path = ring()
        path["waypoints"][12]["position_mm"] = [600.0, 8.0, 100.0]
        self.assert_unsafe(path, "margin", "at waypoint 12", "must be >= 2.2 mm")

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
        self.assert_unsafe(path, "singularity", "at waypoint", "must be >= 0.03", options=["--open"])

    def test_a_mark_has_a_list_of_its_own(self):
        mark = ring(radius=10.0, depth=1.0, speed=2.0, kind="mark")
        self.json_of("export", self.write(mark), "--kind", "mark", "-o", "mark.script")
        self.assert_unsafe(ring(radius=10.5, depth=1.0, speed=2.0, kind="mark"), "edge_distance", "must be <= 0.3 mm")
        self.assert_unsafe(ring(radius=10.0, depth=2.0, speed=2.0, kind="mark"), "depth", "1 mm")
        self.assert_unsafe(ring(radius=10.0, depth=1.0, speed=7.0, kind="mark"), "speed_max")

    def test_an_override_is_typed_for_each_check_and_stands_in_the_program(self):
        path = ring(depth=6.0, speed=31.0)
        self.assert_unsafe(path, "speed_max", options=["--override", "depth"])
        self.incise("export", self.write(path), "--override", "depth", "--override", "speed_max", "-o", "cut.script", status=DONE)
        text = (self.folder / "cut.script").read_text()
        self.assertIn("# incise.override: depth: 1 mm at waypoint", text)
        self.assertIn("# incise.override: speed_max: ", text)

    def test_a_mark_cannot_be_made_a_cut_by_overrides(self):
        path = self.write(ring(kind="mark"))
        for name in ("depth", "speed_max", "edge_distance"):
            self.assert_refused(self.incise("export", path, "--override", name, "-o", "cut.script"), BAD_CASE, "--override", f"'{name}' for a mark")
        self.assert_nothing_written(self.folder / "cut.script")

    def test_a_script_of_another_origin_is_not_replaced(self):
        arguments = ("export", self.write(ring()), "--accept", "not_simulated", "-o", "cut.script")
        (self.folder / "cut.script").write_text("def mine():\nend\n")
        self.assert_refused(self.incise(*arguments), BAD_DATA, "cut.script", "another origin")
        self.assertEqual((self.folder / "cut.script").read_text(), "def mine():\nend\n")
        (self.folder / "cut.script").unlink()
        (self.folder / "real.script").write_text("def mine():\nend\n")
        (self.folder / "cut.script").symlink_to("real.script")
        self.assert_refused(self.incise(*arguments), BAD_DATA, "cut.script", "a link")
        self.assertEqual((self.folder / "real.script").read_text(), "def mine():\nend\n")
        (self.folder / "cut.script").unlink()
        for name, form in (("cut.script", "urscript"), ("cut.csv", "joint-csv"), ("cut.json", "json"), ("cut.yaml", "ros-trajectory"), ("cut.bag", "ros-trajectory")):
            for _ in range(2):  # its own are replaced
                self.incise(*arguments[:-1], name, "--format", form, status=DONE)

    def test_lengths_that_no_instrument_or_table_has_are_refused(self):
        for option in ("--table-z-mm", "--shaft-diameter-mm", "--needle-length-mm"):
            for value in ("-1e308", "1e-300", "1e7"):
                if (option, value) == ("--table-z-mm", "1e-300"):
                    continue
                self.assert_refused(self.incise("export", self.write(ring()), option, value, "-o", "cut.script"), BAD_CASE, option)

    def test_a_power_that_no_generator_has_is_refused(self):
        self.assert_refused(self.incise("export", self.write(ring()), "--power-w", "1e308", "-o", "cut.script"), BAD_CASE, "--power-w")

    def test_an_override_that_is_no_check_or_may_not_be_is_refused(self):
        path = self.write(ring())
        self.assert_refused(self.incise("export", path, "--override", "depht", "-o", "cut.script"), BAD_CASE, "--override", "'depht'", "Did you mean 'depth'?")
        for name in ("finite", "frame", "reach", "margin"):
            self.assert_refused(self.incise("export", path, "--override", name, "-o", "cut.script"), BAD_CASE, f"'{name}'", "this one cannot")
        self.assert_nothing_written(self.folder / "cut.script")

    def test_a_bad_registration_is_unsafe_and_a_damaged_one_is_refused(self):
        def scaled(s):
            return {"T_target_source": [[s, 0, 0, 0], [0, s, 0, 0], [0, 0, s, 0], [0, 0, 0, 1]], "scale": s}

        good = {**scaled(1.01), "rmse_mm": 0.3, "inlier_fraction": 0.9, "converged": True, "outcome": "converged", "camera_scale": 1.0}
        for change, check in (
            (scaled(0.9), "scale"),
            (scaled(1.05), "scale"),  # where a search within 0.95 to 1.05 stops
            ({**scaled(1.0), "camera_scale": 1.06}, "scale"),  # what a plate took out before counts, too
            ({**scaled(1.03), "camera_scale": 1.03}, "scale"),
            ({"rmse_mm": 3.0}, "rmse"),
            ({"inlier_fraction": 0.1}, "inliers"),
            ({"converged": False, "outcome": "poor_fit"}, "converged"),
        ):
            self.write(sealed({**good, **change}), "registration.json")
            self.assert_unsafe(ring(), "registration_" + check, options=["--registration", "registration.json"])
        del good["rmse_mm"]
        self.write(sealed(good), "registration.json")
        done = self.incise("export", self.write(ring()), "--registration", "registration.json", "-o", "cut.script")
        self.assert_refused(done, BAD_DATA, "registration.json", "rmse_mm")
        self.write(sealed({**good, "rmse_mm": 0.3}), "registration.json")
        self.assertEqual(self.incise("export", self.write(ring()), "--registration", "registration.json", "-o", "cut.script").returncode, DONE)

    def test_a_registration_that_contradicts_itself_is_refused(self):
        good = {"T_target_source": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], "scale": 1.0, "rmse_mm": 0.3, "inlier_fraction": 0.9, "converged": True, "outcome": "converged"}
        for change, says in (
            ({"T_target_source": [[1.2, 0, 0, 0], [0, 1.2, 0, 0], [0, 0, 1.2, 0], [0, 0, 0, 1]]}, "/scale: found 1, expected 1.2"),
            ({"rmse_mm": -5}, "/rmse_mm: found -5, expected at least 0"),
            ({"inlier_fraction": 7}, "/inlier_fraction: found 7, expected a number from 0 to 1"),
            ({"outcome": "mirrored"}, '/outcome: found "mirrored"'),
            ({"converged": False}, '/outcome: found "converged"'),
            ({"scale_at_limit": True}, "/scale_at_limit: found true"),
            ({"T_target_source": None}, "/T_target_source: found null"),
            ({"camera_scale": 3}, "/camera_scale: found 3"),
        ):
            with self.subTest(change=change):
                self.write({**good, **change}, "registration.json")
                done = self.incise("export", self.write(ring()), "--registration", "registration.json", "-o", "cut.script")
                self.assert_refused(done, BAD_DATA, "registration.json: " + says)
                self.assert_nothing_written(self.folder / "cut.script")

    def test_open_is_for_open_paths_and_says_what_it_leaves_out(self):
        beside = ring()
        beside["tumor_edge"] = [[x + 60.0, y, z] for x, y, z in beside["tumor_edge"]]
        done = self.incise("export", self.write(beside), "--open", "-o", "cut.script")
        self.assert_refused(done, BAD_CASE, "--open: found path.json, a closed path, expected an open path")
        self.assert_nothing_written(self.folder / "cut.script")
        through = {**ring(radius=2.0), "closed": False, "tumor_edge_closed": False}
        self.assert_unsafe(through, "margin", options=["--open"])
        line = {**ring(), "closed": False, "tumor_edge": []}
        done = self.incise("export", self.write(line), "--open", "-o", "cut.script", "--json", status=DONE)
        self.assertIn("not checked with --open: closed, gap, encloses", done.stderr)
        self.assertIn("closed, gap, encloses: the path need not be a ring", json.loads(done.stdout)["checks_not_made"])

    def test_a_turned_tool_drops_no_check_of_its_shaft(self):
        (self.folder / "flat.obj").write_text("v 300 -300 100\nv 900 -300 100\nv 900 300 100\nv 300 300 100\nf 1 2 3 4\n")
        for tcp in ((0, 0, 150, 0, 1.5708, 0), (150, 0, 0, 0, 0, 0)):
            self.assert_unsafe(ring(), "shaft", options=["--surface", "flat.obj", "--tcp", *map(str, tcp)])

    def test_the_arm_is_held_clear_of_its_base_and_of_the_tissue(self):
        # A needle that leans and is led 2 mm past the base's axis.
        leaning = [{"position_mm": [2.0, y, 150.0], "axis": [-math.sin(1.2), 0, -math.cos(1.2)], "depth_mm": 5, "speed_mm_s": 7} for y in (-8.0, -3.0, 2.0, 7.0)]
        self.assert_unsafe({**ring(), "closed": False, "tumor_edge": [], "waypoints": leaning}, "base", "base and needle", options=["--open"])
        # A flange that is 0.1 mm above the tissue, and a wall beside the ring that only the arm would meet.
        (self.folder / "flat.obj").write_text("v 300 -300 100\nv 900 -300 100\nv 900 300 100\nv 300 300 100\nf 1 2 3 4\n")
        self.assert_unsafe(ring(), "surface_collision", "wrist 3", options=["--surface", "flat.obj", "--tcp", 0, 0, 25, 0, 0, 0])
        (self.folder / "wall.obj").write_text("v 300 -300 100\nv 900 -300 100\nv 900 300 100\nv 300 300 100\nv 660 -60 200\nv 660 60 200\nv 660 60 400\nv 660 -60 400\nf 1 2 3 4\nf 5 6 7 8\n")
        self.assert_unsafe(ring(), "surface_collision", options=["--surface", "wall.obj"])

    def test_a_tumour_edge_without_area_is_unsafe(self):
        line = [[600, 0, 100], [605, 0, 100], [610, 0, 100]]
        self.assert_unsafe({**ring(), "tumor_edge": line}, "margin", "lie on a line or coincide")

    def test_a_tumour_edge_that_is_no_tumour_is_refused(self):
        triangle = [[600, 0, 100], [600.2, 0, 100], [600.1, 0.1, 100]]
        for edge in ([[600, 0, 100]] * 3, triangle, [[1000 * x for x in point] for point in triangle]):
            done = self.incise("export", self.write({**ring(), "tumor_edge": edge}), "-o", "cut.script")
            self.assert_refused(done, BAD_DATA, "/tumor_edge: found a tumour", "expected 2 to 100 mm")
            self.assert_nothing_written(self.folder / "cut.script")

    def test_what_is_not_checked_or_less_strictly_is_told(self):
        path = self.write(ring())
        bare = self.incise("export", path, "-o", "cut.script").stderr
        for option in ("--surface", "--registration", "--power-w"):
            self.assertEqual(bare.count(f"not checked without {option}: "), 1, bare)
        self.assertNotIn("looser", bare)
        done = self.incise("export", path, "--close-margin-mm", 1, "--shaft-diameter-mm", 4, "--table-z-mm", -50, "--power-w", 30, "-o", "cut.script", status=DONE)
        self.assertNotIn("--power-w", done.stderr)
        for words in ("--close-margin-mm is 1 mm, by default 2.2 mm", "--shaft-diameter-mm is 4 mm", "--table-z-mm is -50 mm"):
            self.assertIn("a looser check: " + words, done.stderr)

    def test_numbers_and_options_that_mean_nothing_are_refused(self):
        path = self.write(ring())
        for options, says in (
            (("--power-w", 0), "--power-w: found 0, expected a number in (0, 400]"),
            (("--needle-length-mm", -1), "--needle-length-mm: found -1, expected a number in [0.1, 1000]"),
            (("--near-joints-deg", 0, 0, 0, 0, 0, "1e9"), "--near-joints-deg: found 1e9, expected a number from -360 to 360"),
            (("--depth-mm", "x"), "--depth-mm: found 'x'"),
            (("--format", "joint-csv", "--motion", "servoj"), "--motion: found servoj for --format joint-csv"),
        ):
            with self.subTest(options=options):
                output = "cut.csv" if "joint-csv" in options else "cut.script"
                self.assert_refused(self.incise("export", path, *options, "-o", output), BAD_CASE, says)
                self.assert_nothing_written(self.folder / output)

    def test_a_device_is_of_no_earlier_run(self):
        done = self.incise("export", self.write(ring()), "-o", "/dev/full")
        self.assertNotEqual(done.returncode, DONE)
        self.assertNotIn("earlier run", done.stderr)

    def test_a_program_of_days_is_refused_at_once(self):
        done = self.incise("export", self.write(ring(speed=1e-6)), "-o", "cut.script", cpu_s=60)
        self.assert_refused(done, BAD_DATA, "path.json: waypoints", "at most 7200 s")
        self.assert_nothing_written(self.folder / "cut.script")

    def test_an_input_is_never_the_output(self):
        path = self.write(ring())
        before = (self.folder / path).read_bytes()
        self.assert_refused(self.incise("export", path, "--format", "json", "-o", path), BAD_CASE, "-o: found path.json, which is an input")
        self.assertEqual((self.folder / path).read_bytes(), before)
        self.assertEqual(self.incise("export", path, "-o", "cut.script").returncode, DONE)
        self.json_of("replay", "cut.script", "-o", "played")
        (self.folder / "cut.script").rename(self.folder / "played" / "cut.script")
        self.assert_refused(self.incise("replay", "played/cut.script", "-o", "played"), BAD_CASE, "-o: found played, which holds the input played/cut.script")
        self.assertTrue((self.folder / "played" / "cut.script").is_file())
        done = self.incise("report", "--replay", "played", "-o", "played/replay.json")
        self.assert_refused(done, BAD_CASE, "-o: found played/replay.json, which is inside the input played")

    def test_heat_that_reaches_the_tumour_edge_is_not_exported(self):
        slow = ring(speed=0.6)  # 5 mm outside the edge
        self.json_of("export", self.write(slow), "-o", "slow.script")  # nobody knows its power
        options = ["--power-w", "35"]
        self.assert_unsafe(slow, "heat", "5 mm at waypoint", "must be >= 32.", options=options)
        self.json_of("export", self.write(ring(speed=7.0)), *options, "-o", "fast.script")
        done = self.incise("export", self.write(slow), *options, "--override", "heat", "-o", "slow.script", status=DONE)
        self.assertIn("overridden: heat", done.stderr)

    def test_waypoints_that_no_tool_can_follow_are_refused(self):
        path = ring()
        path["waypoints"][6] = path["waypoints"][5]
        done = self.incise("export", self.write(path), "-o", "cut.script")
        self.assert_refused(done, BAD_DATA, "path.json: waypoints: expected tips more than 0.001 mm apart, found 0 mm after waypoint 5")
        self.assertEqual(done.stderr.count("expected"), 1)
        path = ring()
        path["waypoints"][6]["position_mm"][0] = 1e200
        done = self.incise("export", self.write(path), "-o", "cut.script")
        self.assert_refused(done, BAD_DATA, "path.json: waypoints: expected places within 1e+05 mm of the base, found 1e+200 mm at waypoint 6")
        tiny = ring(radius=1.2, edge=1.0)
        self.assert_refused(self.incise("export", self.write(tiny), "-o", "cut.script"), BAD_DATA, "expected an overlap below the path's 7.54 mm, found 8 mm")
        self.assert_nothing_written(self.folder / "cut.script")


    def test_a_refusal_says_that_an_older_program_was_left(self):
        self.assertEqual(self.incise("export", self.write(ring()), "-o", "cut.script").returncode, DONE)
        older = (self.folder / "cut.script").read_bytes()
        says = "cut.script is from an earlier run and was not changed"
        unsafe = self.incise("export", self.write(ring(radius=11.0)), "-o", "cut.script", "--json", status=NOT_ACCEPTABLE)
        self.assertEqual(json.loads(unsafe.stdout)["stale_output"], "cut.script")
        bad = self.incise("export", "nowhere.json", "-o", "cut.script")
        self.assert_refused(bad, BAD_DATA, "nowhere.json")
        wrong = self.incise("export", "path.json", "--override", "margn", "-o", "cut.script")
        self.assert_refused(wrong, BAD_CASE, "margn")
        for done in (unsafe, bad, wrong):
            self.assertEqual(done.stderr.count(says), 1, done.stderr)
        self.assertEqual((self.folder / "cut.script").read_bytes(), older)
        again = self.incise("export", self.write(ring(speed=6.0)), "-o", "cut.script", status=DONE)
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

    def test_a_program_that_was_changed_is_not_the_one_that_was_checked(self):
        audit = self.json_of("replay", "cut.script")["program_audit"]
        self.assertTrue(audit["checked"] and audit["digest_matches"], audit)
        self.assertIn("margin", audit["recomputed"])
        lines = self.text.splitlines(keepends=True)
        first = next(i for i, line in enumerate(lines) if line.startswith("  movel("))
        start = next(i for i, line in enumerate(lines) if line.startswith("  movej("))
        dive = lines[first].replace(lines[first].split(", ")[2], "-0.05000000", 1)
        joint = lines[start].split("[")[1].split(",")[0]
        changed = {
            "a dive below the table": (lines[:first] + [dive] + lines[first:], "off_course"),
            "a start half a radian off": (lines[:start] + [lines[start].replace(joint, f"{float(joint) + 0.5:.8f}", 1)] + lines[start + 1:], "off_course"),
            "a hundredfold speed": ([line.replace("v=0.007000", "v=0.700000") for line in lines], "wrong_speed"),
            "a forged check": ([line.replace("margin passed: 5 mm", "margin passed: 9 mm") for line in lines], "altered"),
            "another title": (["# incise.title: another\n", *lines], "altered"),
        }
        for what, (text, outcome) in changed.items():
            with self.subTest(change=what):
                (self.folder / "changed.script").write_text("".join(text))
                played = self.json_of("replay", "changed.script", status=NOT_ACCEPTABLE)
                self.assertEqual(played["outcome"], outcome, played.get("reason"))
                self.assertIs(played["program_audit"]["checked"], False)
        (self.folder / "foreign.script").write_text("".join(line for line in lines if "incise.digest" not in line))
        done = self.incise("replay", "foreign.script", "--json", status=DONE)
        self.assertIn("has no digest", done.stderr)
        self.assertEqual((json.loads(done.stdout)["program_audit"]["checked"], json.loads(done.stdout)["program_audit"]["digest_matches"]), (False, None))

    def test_the_digest_is_that_of_the_file_with_zeros_in_its_place(self):
        digest = self.text.split("# incise.digest: sha256 ")[1][:64]
        self.assertEqual(hashlib.sha256(self.text.replace(digest, 64 * "0").encode()).hexdigest(), digest)

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
        done = self.incise("replay", "far.script", "-o", "replay", "--json", status=NOT_ACCEPTABLE)
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
                done = self.incise("replay", name, "--json", status=NOT_ACCEPTABLE)
                self.assertEqual(json.loads(done.stdout)["outcome"], outcome)
                self.assertIn("5.00 mm below the surface", done.stderr)
        exit_at = self.text.index("  # phase: exit")
        (self.folder / "stays.script").write_text(self.text[:exit_at] + self.text[self.text.index("end\n"):])
        self.assertEqual(self.json_of("replay", "stays.script", status=NOT_ACCEPTABLE)["outcome"], "ends_in_tissue")

    def test_a_tip_off_its_path_and_joints_too_fast_are_not_acceptable(self):
        other = ring(center=(650.0, 0.0, 100.0))
        result = self.json_of("replay", "cut.script", "--path", self.write(other, "other.json"), status=NOT_ACCEPTABLE)
        self.assertEqual((result["outcome"], result["allowed_deviation_mm"]), ("off_course", 1))
        self.assertGreater(result["max_cut_deviation_mm"], 20)
        self.json_of("replay", "cut.script", "--path", "other.json", "--max-deviation-mm", 100)
        self.assertEqual(self.incise("export", "path.json", "--format", "joint-csv", "-o", "cut.csv").returncode, DONE)
        lines = (self.folder / "cut.csv").read_text().splitlines()
        rows = [i for i, line in enumerate(lines) if line[:1].isdigit()]
        turned, fast = list(lines), list(lines)
        for i in rows:
            time, q, rest = lines[i].split(",", 2)
            turned[i] = f"{time},{float(q) + 0.3},{rest}"
            fast[i] = f"{float(time) / 100},{q},{rest}"
        for name, text, outcome in (("turned.csv", turned, "off_course"), ("fast.csv", fast, "joint_speed")):
            (self.folder / name).write_text("\n".join(text) + "\n")
            self.assertEqual(self.json_of("replay", name, status=NOT_ACCEPTABLE)["outcome"], outcome)

    def test_programs_of_days_are_refused_at_once(self):
        retreat = next(line for line in reversed(self.text.splitlines()) if line.startswith("  movel("))
        (self.folder / "slow.script").write_text(self.text.replace(retreat, retreat.split(", v=")[0] + ", v=0.000000001)"))
        done = self.incise("replay", "slow.script", "--json", cpu_s=60, status=NOT_ACCEPTABLE)
        self.assertEqual(json.loads(done.stdout)["outcome"], "too_long")
        self.assert_line_refused("end\n\n", "  sleep(1e9)\nend\n\n", "at most 7200 s")

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
        self.assertIn(self.json_of("replay", "far.script", status=NOT_ACCEPTABLE)["outcome"], ("unreachable", "blends_overlap"))


if __name__ == "__main__":
    unittest.main()
