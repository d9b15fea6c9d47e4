"""The virtual bench: readings, a cut by a program, and what is refused."""

import csv
import json
import math
import struct
import unittest

import small_case
from command import BAD_CASE, BAD_DATA, DONE, CommandTest, HandMadePaths, files_below


def specimen_file(path, **given):
    path.write_text(json.dumps({"schema": "incise.specimen/1", "seed": 5, **given}))
    return path


def path_round(edge_csv, T_robot_specimen, moved_mm=0.0):
    """A path 5 mm outside a contour and 5 mm deep, straight down: a plan without any finesse."""
    with open(edge_csv, newline="") as file:
        points = [tuple(float(row[key]) for key in ("x_mm", "y_mm", "z_mm")) for row in csv.DictReader(file)]
    middle = [sum(p[i] for p in points) / len(points) for i in range(3)]

    def in_robot(point):
        place = [sum(row[i] * (*point, 1.0)[i] for i in range(4)) for row in T_robot_specimen[:3]]
        return [place[0] + moved_mm, place[1], place[2]]

    def outside(p):
        out = math.hypot(p[0] - middle[0], p[1] - middle[1])
        return (p[0] + 5 * (p[0] - middle[0]) / out, p[1] + 5 * (p[1] - middle[1]) / out, p[2] - 1.0)

    points = points[:: max(1, len(points) // 40)]
    return small_case.path([in_robot(outside(p)) for p in points], tumor_edge=[in_robot(p) for p in points])


class SchemaTest(CommandTest):
    def test_the_schema_lists_every_hidden_parameter_with_source_and_reading(self):
        schema = json.loads(self.incise("schema", "bench").stdout)
        self.assertEqual(schema["title"], "incise.specimen/1")
        parameters = {k: v for k, v in schema["properties"].items() if k not in ("schema", "seed")}
        self.assertGreater(len(parameters), 30)
        for name, parameter in parameters.items():
            for key in ("default", "description", "x-spread", "x-source", "x-shows-in"):
                self.assertTrue(parameter[key] or parameter[key] == 0, f"{name}.{key}")
        self.assertEqual(parameters["youngs_modulus_kpa"]["x-shows-in"], "stretch_force_n")

    def test_the_defaults_are_a_specimen_file(self):
        defaults = json.loads(self.incise("schema", "bench", "--defaults").stdout)
        self.assertEqual(defaults["schema"], "incise.specimen/1")


class SecondLaboratoryTest(CommandTest):
    def make(self, *arguments, **where):
        return self.incise("bench", "make", *arguments, "-o", self.out, "--json", **where)

    def test_the_schema_says_the_factor_of_each_parameter(self):
        schema = json.loads(self.incise("schema", "bench2").stdout)
        self.assertEqual(schema["title"], "incise.specimen/2")
        self.assertEqual(schema["required"], ["schema", "seed", "series"])
        self.assertEqual(schema["properties"]["shrinking"]["x-factor"], "heat")
        self.assertIsNone(schema["properties"]["youngs_modulus_kpa"]["x-factor"])

    def test_a_specimen_is_read_with_its_prescription_and_nothing_hidden(self):
        truth = self.folder / "truth"
        done = self.make("--bench", "2", "--seed", "4", "--series", "2", "--factors", "ring,heat", "--truth", truth)
        self.assertEqual(done.returncode, DONE, done.stderr)
        hidden = json.loads((truth / "specimen.json").read_text())
        self.assertEqual((hidden["schema"], hidden["seed"], hidden["series"]), ("incise.specimen/2", 4, 2))
        self.assertNotEqual(hidden["shrinking"], 0)
        self.assertEqual((hidden["margin_mm"], hidden["fibre_ratio"]), (5, 1))
        readings = json.loads((self.out / "readings.json").read_text())
        self.assertEqual(readings["prescription"]["power_w"], 35)
        for key in hidden:
            if key not in ("schema", "depth_mm", "speed_mm_s"):
                self.assertNotIn(f'"{key}"', json.dumps(readings))
        # The truth is a specimen file: it makes the same readings.
        again = self.incise("bench", "make", truth / "specimen.json", "-o", self.folder / "again", status=DONE)
        self.assertEqual((self.folder / "again/scan.ply").read_bytes(), (self.out / "scan.ply").read_bytes())

    def test_what_does_not_go_together_is_refused(self):
        first = specimen_file(self.folder / "first.json")
        second = self.folder / "second.json"
        second.write_text(json.dumps({"schema": "incise.specimen/2", "seed": 5, "series": 1}))
        for arguments, says in (
            (("--factors", "heat"), "--factors"),
            (("--series", "3"), "--series"),
            ((first, "--bench", "2"), "--bench"),
            ((second, "--factors", "heat"), "--factors"),
            ((second, "--elasticity"), "--elasticity"),
            (("--bench", "2", "--factors", "none,ring"), "--factors"),
        ):
            self.assert_refused(self.make(*arguments), BAD_CASE, says)
            self.assert_nothing_written(self.out)
        second.write_text(json.dumps({"schema": "incise.specimen/2", "seed": 5}))
        self.assert_refused(self.make(second), BAD_DATA, "second.json", "series")
        second.write_text(json.dumps({"schema": "incise.specimen/2", "seed": 5, "series": 1, "friction": 7}))
        self.assert_refused(self.make(second), BAD_DATA, "friction", "[0, 1]")


class AcceptanceTest(CommandTest):
    def accept(self, *arguments):
        return self.incise("bench", "accept", "--specimens", "1", "--factors", "none", "--no-paper-pass", *arguments, "-o", self.out, "--json")

    def test_a_specimen_is_cut_as_planned_and_kept(self):
        first = self.accept("--seed", "3")
        self.assertEqual(first.returncode, DONE, first.stderr)
        result = json.loads(first.stdout)
        row = result["rows"][0]
        self.assertEqual((row["seed"], row["prescription"]["power_w"], row["paper_pass_mm"]), (3, 35, None))
        self.assertEqual(result["summary"]["closed_as_planned"], 1)
        self.assertAlmostEqual(result["summary"]["planned_mean_mm"], row["planned_mm"])
        self.assertGreater(row["planned_mm"], 0.3)
        photo = (self.out / "S1/planned_cut/photo.png").stat().st_mtime_ns
        again = self.accept("--seed", "3")
        self.assertEqual(json.loads(again.stdout)["rows"], result["rows"])
        self.assertEqual((self.out / "S1/planned_cut/photo.png").stat().st_mtime_ns, photo)  # not cut again
        other = self.accept("--seed", "4")
        self.assert_refused(other, BAD_DATA, "bench.json", "seed", "3")
        self.assertEqual(json.loads((self.out / "acceptance.json").read_text())["rows"], result["rows"])

    def test_only_checks_that_can_be_taken_on_are(self):
        self.assert_refused(self.accept("--override", "reach"), BAD_CASE, "--override", "heat")

    def test_a_foreign_folder_is_left_alone(self):
        (self.out / "truth").mkdir(parents=True)
        (self.out / "truth/thesis.txt").write_text("mine")
        self.assert_refused(self.accept(), BAD_DATA, str(self.out))
        self.assertEqual(files_below(self.out), ["truth", "truth/thesis.txt"])


class PoolTest(CommandTest):
    """Finished experiments, written by hand."""

    def series(self, name, seed, incise_mm):
        def cut(path, error_mm):
            return {"path": path, "end": "measured", "mean_abs_error_mm": error_mm, "least_margin_mm": 2.5}

        folder = self.folder / name
        folder.mkdir()
        (folder / "experiment.json").write_text(json.dumps({"seed": seed, "bench": 2}))
        tested = [{"specimen": "S3", "unlike": 2, "learning": [],
                   "cuts": [cut("as_planned", 1.5), cut("photographs", 0.5), cut("incise", incise_mm), cut("robust", 0.6)]}]
        (folder / "study.json").write_text(json.dumps({"specimens": 4, "tested_specimens": tested, "table_2": [], "advice": None}))
        return folder

    def test_series_are_taken_together_and_stay_as_they_are(self):
        first, second = self.series("first", 1, 0.4), self.series("second", 5, 0.8)
        before = [(folder / file).read_bytes() for folder in (first, second) for file in files_below(folder)]
        found = self.json_of("bench", "pool", first, second, "-o", self.folder / "pooled")
        self.assertAlmostEqual(found["rivals"]["incise"]["difference_mm"], 0.1)
        self.assertTrue((self.folder / "pooled" / "paths.svg").is_file())
        said = self.incise("bench", "pool", first, second, "-o", self.folder / "pooled").stdout
        self.assertIn("unlike the calibration's", said)
        self.assertIn("+0.10", said)
        self.assertEqual(before, [(folder / file).read_bytes() for folder in (first, second) for file in files_below(folder)])

    def test_what_cannot_be_taken_together_is_refused(self):
        first, second = self.series("first", 1, 0.4), self.series("second", 3, 0.8)
        out = self.folder / "pooled"
        self.assert_refused(self.incise("bench", "pool", first, second, "-o", out), BAD_DATA, "seeds other than those of")
        self.assert_refused(self.incise("bench", "pool", first, first / ".." / "first", "-o", out), BAD_DATA, "seeds other")
        self.assert_refused(self.incise("bench", "pool", first, "-o", out), BAD_CASE, "experiments")
        self.assert_refused(self.incise("bench", "pool", first, second, "-o", first / "pooled"), BAD_CASE, "input")
        self.assert_refused(self.incise("bench", "pool", first, self.folder / "none", "-o", out), BAD_DATA, "no such file")
        self.assertFalse(out.exists())


class BadInputTest(CommandTest):
    def refused(self, *says, **given):
        done = self.incise("bench", "make", specimen_file(self.folder / "specimen.json", **given), "-o", self.out)
        self.assert_refused(done, BAD_DATA, "specimen.json", *says)
        self.assert_nothing_written(self.out)

    def test_an_unknown_parameter_names_the_nearest(self):
        self.refused("youngs_modulus", "Did you mean 'youngs_modulus_kpa'?", youngs_modulus=12)

    def test_a_parameter_out_of_range_says_the_range(self):
        self.refused("poissons_ratio", "0.7", "[0.3, 0.49]", poissons_ratio=0.7)

    def test_a_parameter_that_is_no_number_is_refused(self):
        self.refused("clamp_slip_mm", "a finite number", clamp_slip_mm="much")

    def test_a_seed_is_needed(self):
        self.refused("seed", "a whole number", seed=None)

    def test_a_missing_specimen_file_is_named(self):
        self.assert_refused(self.incise("bench", "make", "nowhere.json", "-o", self.out), BAD_DATA, "nowhere.json")

    def test_the_floor_needs_a_specimen_and_a_place_for_its_file(self):
        done = self.incise("bench", "floor", "none.json", "-o", "floor.json", status=BAD_DATA)
        self.assertIn("none.json", done.stderr)
        file = specimen_file(self.folder / "specimen.json")
        done = self.incise("bench", "floor", file, status=BAD_CASE)
        before = file.read_bytes()
        self.incise("bench", "floor", file, "-o", file, status=BAD_CASE)
        self.assertEqual(file.read_bytes(), before)
        self.assert_nothing_written(self.folder / "floor.json")

    def test_the_truth_may_not_lie_in_the_output(self):
        done = self.incise("bench", "make", "--seed", 5, "-o", self.out, "--truth", self.out / "truth")
        self.assert_refused(done, BAD_CASE, "--truth", "apart from the output")
        self.assert_nothing_written(self.out)

    def test_a_program_that_is_none_is_refused_before_any_computing(self):
        program = self.folder / "program.json"
        program.write_text(json.dumps({"schema": "incise.program/9"}))
        done = self.incise("bench", "cut", specimen_file(self.folder / "specimen.json"), program, "-o", self.out)
        self.assert_refused(done, BAD_DATA, "program.json", "schema", "incise.program/1")
        self.assert_nothing_written(self.out)
        program = self.folder / "cut.script"
        program.write_text("def incise_cut():\n  dance()\nend\n")
        done = self.incise("bench", "cut", specimen_file(self.folder / "specimen.json"), program, "-o", self.out)
        self.assert_refused(done, BAD_DATA, "cut.script", "dance")
        self.assert_nothing_written(self.out)


class LoopTest(HandMadePaths, CommandTest):
    def test_readings_tell_no_hidden_parameter_and_a_program_becomes_a_photograph(self):
        truth = self.folder / "hidden"
        made = self.json_of("bench", "make", "--seed", 5, "-o", self.out, "--truth", truth)
        self.assertTrue(made["virtual"])
        for name in ("scan.ply", "rgb.png", "depth.png", "camera.json", "readings.json", "manifest.json", "ct"):
            self.assertIn(name, files_below(self.out))
        told = "".join((self.out / name).read_text() for name in ("readings.json", "camera.json", "manifest.json"))
        for hidden in ("youngs_modulus", "toughness", "adhesion", "T_robot_specimen", "--seed"):
            self.assertNotIn(hidden, told)
        depth = (self.out / "depth.png").read_bytes()
        self.assertEqual(struct.unpack(">IIBB", depth[16:26]), (1280, 720, 16, 0))

        transform = json.loads((truth / "truth.json").read_text())["T_robot_specimen"]
        path = self.folder / "path.json"
        path.write_text(json.dumps(path_round(truth / "tumor_edge_stretched.csv", transform)))
        self.json_of("export", path, "-o", self.folder / "cut.script")
        cut = self.json_of("bench", "cut", truth / "specimen.json", self.folder / "cut.script", "-o", self.folder / "cut", "--truth", self.folder / "cut_truth")
        self.assertEqual(files_below(self.folder / "cut"), ["manifest.json", "photo.json", "photo.png"])
        self.assertEqual(cut["mm_per_pixel"], 0.03)
        width, height = struct.unpack(">II", (self.folder / "cut" / "photo.png").read_bytes()[16:24])
        self.assertGreater(min(width, height), 1000)
        # What the photograph shows is what happened.
        true_mean = json.loads((self.folder / "cut_truth" / "cut_truth.json").read_text())["mean_abs_error_mm"]
        seen = self.json_of("evaluate", self.folder / "cut" / "photo.png", "--mm-per-pixel", 0.03)
        self.assertAlmostEqual(seen["abs_error_mm"]["mean"], true_mean, delta=0.05)

        path.write_text(json.dumps(path_round(truth / "tumor_edge_stretched.csv", transform, moved_mm=60.0)))
        self.json_of("export", path, "-o", self.folder / "other.json", "--format", "json")
        done = self.incise("bench", "cut", truth / "specimen.json", self.folder / "other.json", "-o", self.folder / "other")
        self.assert_refused(done, BAD_DATA, "other.json", "program of another specimen?")
        self.assertFalse((self.folder / "other").exists())


if __name__ == "__main__":
    unittest.main()
