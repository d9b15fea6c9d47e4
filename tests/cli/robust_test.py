"""The path of least expected error by a calibration: what it leaves, how it goes on, what is refused."""

import json
import unittest

import small_calibration
import small_case
from command import BAD_CASE, BAD_DATA, INTERRUPTED, NOT_ACCEPTABLE, CommandTest, SharedStart, files_below

RISK = {"expected_abs_error_mm", "abs_error_80_mm", "abs_error_95_mm", "p_close_margin", "unmeasured_weight"}
CUTS = "tissue of the calibration: 1 cut along a path, "


class RobustTest(SharedStart, CommandTest):
    def setUp(self):
        super().setUp()
        # The mesh of 3 mm leaves more than the electrode's radius of error, so no correction of it is accepted (status 4).
        small_case.write_case(self.folder / "case", {"compensation": {"observable": "inner_edge", "bias_mm": 0.2}})
        self.calibration = small_calibration.write(self.folder / "calibration.json")

    def compensate(self, *options, status=None):
        return self.incise("compensate", "case", "-o", self.out, "--robust", "--calibration", self.calibration, *options, status=status)

    def begin_robust(self, *options):
        """As robust, from the shared start."""
        found, said = self.begin("compensate", "case", "-o", self.out, "--robust", "--calibration", self.calibration, *options, status=NOT_ACCEPTABLE)
        return found["robust"], said

    def robust(self, *options):
        done = self.compensate("--json", *options, status=NOT_ACCEPTABLE)
        return json.loads(done.stdout)["robust"], done.stderr

    def test_three_paths_and_none_is_cut_twice(self):
        found, said = self.begin_robust("--stretch-force-n", 27)
        for path in ("intended", "corrected", "robust"):
            self.assertEqual(set(found[path]), RISK)
            self.assertEqual(found[path]["unmeasured_weight"], 0.0)
        self.assertLess(found["corrected"]["expected_abs_error_mm"], found["intended"]["expected_abs_error_mm"])
        self.assertIn(found["simulations"], (3, 4))
        tissues = found["scenarios"]["tissues"]
        self.assertEqual(len(tissues), 1)
        self.assertAlmostEqual(tissues[0]["drag_length_mm"], 1.3, delta=1e-9)
        self.assertEqual(found["scenarios"]["own_stiffness_sd"], 0.0)
        kpa = 70.0 * 27.0 / found["scenarios"]["simulated_force_n"]
        self.assertAlmostEqual(found["scenarios"]["reference_kpa"], kpa, delta=1e-9 * kpa)
        self.assertEqual(said.count(CUTS + "0 finished"), found["simulations"])

        self.assertLessEqual({"robust/path.json", "robust/path.vtp", "robust/robust.json", "robust/manifest.json",
                              "correction/path.json", "figures/compensation_robust.svg"}, set(files_below(self.out)))
        path = json.loads((self.out / "robust" / "path.json").read_text())
        self.assertEqual(path["frame"], "sim_stretched")
        self.assertEqual(len(path["waypoints"]), 24)
        written = json.loads((self.out / "robust" / "robust.json").read_text())
        self.assertEqual(written["robust"], found["robust"])
        self.assertEqual(len(written["offset_mm"]), 24)

        again, said = self.robust("--stretch-force-n", 27)
        self.assertEqual(said.count(CUTS + "1 finished"), found["simulations"], said)
        self.assertEqual({key: again[key] for key in again if key != "wall_s"}, {key: found[key] for key in found if key != "wall_s"})

    def test_a_virtual_calibration_for_a_real_specimen_is_told(self):
        _, said = self.begin_robust("--stretch-force-n", 27)
        self.assertNotIn("virtual specimens", said)
        small_case.write_case(self.folder / "case", {"compensation": {"observable": "inner_edge", "bias_mm": 0.2}, "specimen_is": "real"})
        _, said = self.robust("--stretch-force-n", 27)
        self.assertIn("robust path: the calibration is of virtual specimens and this one is real", said)

    def test_a_smaller_probability_is_bought_with_error_and_what_cannot_be_had_is_said(self):
        # Real cuts lie 2 mm farther out than simulated ones, and the case's correction takes 0.2 mm of it for granted.
        small_calibration.write(self.calibration, lambda c: c["posterior"].update(samples=small_calibration.samples(bias_mm=(1.6, 2.4))))
        free, _ = self.robust("--stretch-force-n", 27, "--max-probability", 0.999)
        held, _ = self.robust("--stretch-force-n", 27, "--max-probability", 0.3)
        for found in (free, held):
            self.assertEqual(found["outcome"], "met")
            self.assertLess(found["robust"]["expected_abs_error_mm"], 0.8 * found["corrected"]["expected_abs_error_mm"])
        self.assertGreater(free["robust"]["p_close_margin"], 0.3)
        self.assertLessEqual(held["robust"]["p_close_margin"], 0.3)
        self.assertGreater(held["robust"]["expected_abs_error_mm"], free["robust"]["expected_abs_error_mm"])

        hopeless, said = self.robust("--stretch-force-n", 27, "--max-probability", 0.0001)
        self.assertEqual(hopeless["outcome"], "not_met")
        self.assertLessEqual(hopeless["robust"]["p_close_margin"], hopeless["corrected"]["p_close_margin"])
        self.assertIn("warning: robust path: not_met", said)

    def test_without_the_pull_stiffness_is_less_sure(self):
        without, _ = self.begin_robust()
        self.assertEqual(without["scenarios"]["own_stiffness_sd"], 0.5)
        self.assertEqual(without["scenarios"]["reference_kpa"], 70.0)
        factors = [tissue["stiffness_factor"] for tissue in without["scenarios"]["tissues"]]
        self.assertGreater(max(factors) / min(factors), 5.0)

    def test_an_interrupted_choice_keeps_its_cuts_and_goes_on(self):
        stopped = self.interrupted("compensate", "case", "-o", self.out, "--robust", "--calibration", self.calibration, "--threads", 1,
                                   after="tissue of the calibration: 3 cuts")
        self.assertEqual(stopped.returncode, INTERRUPTED, stopped.stderr)
        self.assertIn("Run the same command to continue", stopped.stderr)
        self.assertFalse((self.out / "robust").exists())
        self.assertTrue((self.out / "corrected").exists())
        self.robust()

    def test_another_correction_takes_the_robust_path_of_the_older_one_away(self):
        self.begin_robust()
        self.assertTrue((self.out / "robust").exists())
        small_case.write_case(self.folder / "case", {"compensation": {"observable": "inner_edge", "bias_mm": 0.5}})
        self.incise("compensate", "case", "-o", self.out)
        self.assertFalse((self.out / "robust").exists())

    def test_what_cannot_be_is_refused_before_anything_is_written(self):
        refused = self.incise("compensate", "case", "-o", self.out, "--robust")
        self.assert_refused(refused, BAD_CASE, "--robust", "--calibration")
        refused = self.incise("compensate", "case", "-o", self.out, "--calibration", self.calibration)
        self.assert_refused(refused, BAD_CASE, "--calibration", "--robust")
        small_calibration.write(self.calibration, lambda c: c.update(cut_rule="lattice"))
        self.assert_refused(self.compensate(), BAD_CASE, "cut.rule", "tets", "expected lattice")
        small_calibration.write(self.calibration)
        self.assert_refused(self.compensate("--method", "paper"), BAD_CASE, "--robust", "--method default")
        self.assert_refused(self.compensate("--no-verify"), BAD_CASE, "--no-verify", "--robust")
        for probability in (0, 1, -0.1):
            self.assert_refused(self.compensate("--max-probability", probability), BAD_CASE, "--max-probability")
        self.assert_refused(self.compensate("--stretch-force-n", 0), BAD_CASE, "--stretch-force-n")
        small_calibration.write(self.calibration, lambda c: c["specimens"][1].update(stretch_force_n=None))
        self.assert_refused(self.compensate("--stretch-force-n", 27), BAD_CASE, "--stretch-force-n", "without")
        small_calibration.write(self.calibration, lambda c: c.update(method="paper"))
        self.assert_refused(self.compensate(), BAD_DATA, "calibration.json", "method", "fit")
        self.calibration.write_text("{}")
        self.assert_refused(self.compensate(), BAD_DATA, "calibration.json", "schema")
        self.calibration.unlink()
        self.assert_refused(self.compensate(), BAD_DATA, "calibration.json")
        self.assert_nothing_written()


if __name__ == "__main__":
    unittest.main()
