"""`incise calibrate`: bad input, interruption, damage, and what it leaves."""

import csv
import json
import math
import unittest

import small_case
from command import BAD_CASE, BAD_DATA, DONE, INTERRUPTED, CommandTest, files_below

FEW = ("--drag-lengths-mm", 0.26, 1.3, 2.6, "--second-drag-lengths-mm", 1.3, "--threads", 1)
KEYS = ("chosen", "score_percent", "rows", "baseline_mm")


def photographed(radius_mm=8.6, shift_mm=0.3, corners=120):
    """An inner edge round the tumour of the small case, farther out on one side."""
    angles = [2.0 * math.pi * n / corners for n in range(corners)]
    x, y = small_case.TUMOR_CENTER_MM
    return [
        (x + (radius_mm + shift_mm * math.cos(a)) * math.cos(a), y + (radius_mm + shift_mm * math.cos(a)) * math.sin(a), small_case.BLOCK_MM[2])
        for a in angles
    ]


class CalibrateTest(CommandTest):
    def setUp(self):
        super().setUp()
        self.case = small_case.write_case(self.folder / "case")
        self.observed = self.evaluated("cut", photographed())

    def evaluated(self, name, points, *options):
        small_case.write_contour(self.folder / f"{name}.csv", points)
        small_case.write_contour(self.folder / "edge.csv", small_case.ring())
        evaluation = self.folder / f"{name}.json"
        self.incise("evaluate", "--incision", f"{name}.csv", "--tumor", "edge.csv", "--contour", "inner_edge", *options, "-o", evaluation)
        return evaluation

    def calibrate(self, *options, observed=None):
        return self.incise("calibrate", self.case, "--observed", observed or self.observed, "-o", self.out, *options)

    def test_a_fit_leaves_everything_and_the_same_command_makes_no_run_again(self):
        result = self.json_of("calibrate", self.case, "--observed", self.observed, "-o", self.out, *FEW)
        for key in KEYS:
            self.assertIn(key, result)
        self.assertEqual(set(result["chosen"]) & {"speed_mm_s", "dullness"}, {"speed_mm_s", "dullness"})
        self.assertTrue(result["virtual"])
        self.assertEqual(len(result["identifiability"]), 3)
        files = files_below(self.out)
        for name in ("calibration.json", "simulations.csv", "simulations.tex", "fit.svg", "manifest.json"):
            self.assertIn(name, files)
        runs = [name for name in files if name.startswith("cache/calibration_run/") and name.endswith(".bin")]
        self.assertEqual(len(runs), result["simulations"])
        self.assertLess(len(runs), 10)
        with open(self.out / "simulations.csv", newline="") as file:
            self.assertEqual(len(list(csv.DictReader(file))), len(result["rows"]))

        before = (self.out / "calibration.json").read_bytes()
        again = self.calibrate(*FEW)
        self.assertEqual(again.returncode, DONE, again.stderr)
        self.assertIn("4 simulations, 4 of them finished already", again.stderr)
        self.assertIn("x stiffness", again.stdout)  # one run is with the second stiffness
        self.assertIn("the table's scores are of mid-lines", again.stdout)
        self.assertRegex(again.stdout, r"chosen: .* % of the baseline by the inner edges of 1 of 1 specimen\n")
        self.assertEqual((self.out / "calibration.json").read_bytes(), before)

        # A run that was damaged is told and made anew, to the same bits.
        damaged = self.out / runs[0]
        data = damaged.read_bytes()
        damaged.write_bytes(data[: len(data) // 2])
        mended = self.calibrate(*FEW)
        self.assertEqual(mended.returncode, DONE, mended.stderr)
        self.assertIn(damaged.name, mended.stderr)
        self.assertIn("It is computed again", mended.stderr)
        self.assertEqual(damaged.read_bytes()[:1], data[:1])

        # So is one of which a single byte was changed afterwards.
        damaged.write_bytes(data[:-9] + bytes([data[-9] ^ 1]) + data[-8:])
        mended = self.calibrate(*FEW)
        self.assertEqual(mended.returncode, DONE, mended.stderr)
        self.assertIn(f"{damaged.name}: byte", mended.stderr)

        def without_times(value):
            if isinstance(value, dict):
                return {key: without_times(item) for key, item in value.items() if key != "wall_s"}
            return [without_times(item) for item in value] if isinstance(value, list) else value

        self.assertEqual(without_times(json.loads((self.out / "calibration.json").read_text())), without_times(json.loads(before)))

    def test_the_papers_grid_is_a_table_and_a_heat_map(self):
        grid = ("--method", "paper", "--speeds-mm-s", 1, 13, "--dullnesses", 1, 9)
        result = self.json_of("calibrate", self.case, "--observed", self.observed, "-o", self.out, *grid)
        self.assertEqual(len(result["rows"]), 4)
        for name in ("table_1.csv", "table_1.tex", "table_1.svg"):
            self.assertIn(name, files_below(self.out))
        self.assertNotIn("fit.svg", files_below(self.out))
        self.assertGreater(result["score_percent"], 0)

    def test_an_interrupted_calibration_keeps_its_runs_and_goes_on(self):
        stopped = self.interrupted("calibrate", self.case, "--observed", self.observed, "-o", self.out, *FEW, after="calibration: 4 simulations")
        self.assertEqual(stopped.returncode, INTERRUPTED, stopped.stderr)
        self.assertIn("Run the same command to continue", stopped.stderr)
        self.assertFalse((self.out / "calibration.json").exists())
        self.assertEqual(self.calibrate(*FEW).returncode, DONE)

    def test_as_many_evaluations_and_forces_as_cases(self):
        done = self.incise("calibrate", self.case, "--observed", self.observed, self.observed, "-o", self.out)
        self.assert_refused(done, BAD_CASE, "--observed", "2 for 1 case")
        done = self.calibrate("--stretch-force-n", 4.2, 4.3)
        self.assert_refused(done, BAD_CASE, "--stretch-force-n", "2 for 1 case")
        self.assert_refused(self.calibrate("--stretch-force-n", -1), BAD_CASE, "--stretch-force-n")
        self.assert_refused(self.calibrate("--speeds-mm-s", 5, 5, "--method", "paper"), BAD_CASE, "--speeds-mm-s", "twice")
        self.assert_refused(self.calibrate("--drag-lengths-mm", 1, 2), BAD_CASE, "--second-drag-lengths-mm")
        self.assert_nothing_written()

    def test_an_evaluation_that_cannot_be_compared_all_round_is_refused_before_anything_runs(self):
        self.assert_refused(self.calibrate(observed=self.evaluated("open", photographed(), "--open")), BAD_DATA, "open.json", "closed_loop")
        older = json.loads(self.observed.read_text())
        del older["tumor_edge"]
        (self.folder / "older.json").write_text(json.dumps(older))
        self.assert_refused(self.calibrate(observed=self.folder / "older.json"), BAD_DATA, "older.json", "tumor_edge", "incise evaluate")
        self.assert_refused(self.calibrate(observed=self.folder / "nowhere.json"), BAD_DATA, "nowhere.json")
        self.assert_nothing_written()

    def test_an_evaluation_that_no_photograph_shows_is_refused_before_anything_runs(self):
        good = json.loads(self.observed.read_text())
        far = self.folder / "far.json"
        for group, axis, value, says in (("points", "x_mm", 1e300, "/points/x_mm/3: found 1e+300"), ("points", "z_mm", -1e9, "/points/z_mm/3: found -1e+09"),
                                         ("tumor_edge", "y_mm", 1e300, "/tumor_edge/y_mm/3: found 1e+300"), ("points", "y_mm", 900.0, "/points: found an incision")):
            changed = json.loads(json.dumps(good))
            changed[group][axis][3] = value
            far.write_text(json.dumps(changed))
            self.assert_refused(self.calibrate(observed=far), BAD_DATA, f"far.json: {says}")
        far.write_text(json.dumps({**good, "approach": [1e300, 0, 0]}))
        self.assert_refused(self.calibrate(observed=far), BAD_DATA, "far.json: /approach: found a vector of length inf, expected a direction")
        self.assert_nothing_written()

    def test_a_case_without_a_ring_or_a_tumour_is_refused(self):
        small_case.write_case(self.case, {"tumor": None})
        self.assert_refused(self.calibrate(), BAD_CASE, "tumor")
        self.assert_nothing_written()


if __name__ == "__main__":
    unittest.main()
