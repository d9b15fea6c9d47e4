"""Should this specimen be corrected? The verdict, its numbers, and what is refused."""

import json
import math
import unittest

import small_calibration
import small_case
from command import BAD_CASE, BAD_DATA, DONE, INTERRUPTED, NOT_ACCEPTABLE, CommandTest, SharedStart, files_below
from sealed_json import sealed

KEYS = ("advice", "reasons", "expected_gain_mm", "p_worse", "p_worse_if_alike", "p_worse_if_unlike", "p_unlike", "p_close_margin", "registration", "distances", "scenarios", "rules", "notes")
SCALE = 1.001
T_TARGET_SOURCE = [[SCALE, 0, 0, 0], [0, SCALE, 0, 0], [0, 0, SCALE, 0], [0, 0, 0, 1]]
PULL_N = 27.0  # about what the block pulls at the case's modulus


class AssessTest(SharedStart, CommandTest):
    def setUp(self):
        super().setUp()
        small_case.write_case(self.folder / "case", {"compensation": {"observable": "inner_edge", "bias_mm": 0.2}})
        self.calibration = small_calibration.write(self.folder / "calibration.json")
        self.registered()

    def registered(self, by=sealed, **changes):
        record = {"T_target_source": T_TARGET_SOURCE, "converged": True, "scale": SCALE, "rmse_mm": 0.34, "inlier_fraction": 0.97}
        record.update(changes)
        (self.folder / "registration.json").write_text(json.dumps(by({key: value for key, value in record.items() if value != "absent"})))

    def arguments(self, *options):
        return ("assess", "case", "--calibration", self.calibration, "--registration", "registration.json", "-o", self.out, *options)

    def begin_assessed(self):
        """As assessed with the pull, of what setUp writes."""
        return self.begin(*self.arguments("--stretch-force-n", PULL_N))[0]

    def assessed(self, *options, status=DONE):
        return self.json_of(*self.arguments(*options), status=status)

    def test_a_specimen_like_the_calibrations_is_judged_by_its_gain(self):
        found = self.begin_assessed()
        for key in KEYS:
            self.assertIn(key, found)
        # The block's mesh is too coarse for a correction below the electrode's radius; nothing else speaks against it.
        self.assertEqual(found["advice"], "cut_as_planned", found["reasons"])
        self.assertEqual(len(found["reasons"]), 1, found["reasons"])
        self.assertIn("not accepted", found["reasons"][0])
        gain = found["expected_gain_mm"]
        self.assertGreater(gain["mean"], gain["sd"])
        self.assertEqual([entry["name"] for entry in found["distances"]],
                         ["registration_rmse_mm", "registration_scale", "youngs_modulus_kpa", "compliance_mm_n"])
        self.assertLess(max(abs(entry["in_sd"]) for entry in found["distances"]), 3.0)
        for middle, whole in ((gain["middle_80"], gain["middle_95"]), (found["corrected"]["abs_error_80_mm"], found["corrected"]["abs_error_95_mm"])):
            self.assertTrue(whole[0] < middle[0] < middle[1] < whole[1], (middle, whole))
        expected = found["scenarios"]
        self.assertEqual((expected["photographs"], expected["degrees"], expected["own_stiffness_sd"]), (2, 5, 0.0))
        self.assertEqual((len(expected["residual_mm"]), len(expected["sd_mm"]), len(expected["tissues"])), (36, 36, 1))
        self.assertGreater(min(expected["sd_mm"]), 0.05)
        self.assertEqual(found["notes"], [])
        self.assertTrue(0.0 < found["p_worse_if_unlike"] < 0.5, "cuts err inwards, the correction moves them outwards")
        mixed = (1.0 - found["p_unlike"]) * found["p_worse_if_alike"] + found["p_unlike"] * found["p_worse_if_unlike"]
        self.assertAlmostEqual(found["p_worse"], mixed, places=12)
        written = json.loads((self.out / "assessment" / "assess.json").read_text())
        self.assertEqual(written["advice"], found["advice"])
        self.assertIn("assessment/manifest.json", files_below(self.out))

        # What was cut for it serves the robust path, and the other way round.
        done = self.incise("compensate", "case", "-o", self.out, "--robust", "--calibration", self.calibration, "--stretch-force-n", PULL_N)
        self.assertIn("1 cut along a path, 1 finished already", done.stderr)

        # A correction that the tissue does not need: the bias undoes what was foreseen.
        small_calibration.write(self.calibration, lambda c: c["posterior"].update(samples=small_calibration.samples(bias_mm=(3.4, 3.8))))
        found = self.assessed("--stretch-force-n", PULL_N)
        self.assertEqual(found["advice"], "cut_as_planned", found)
        self.assertTrue(any("gain" in reason for reason in found["reasons"]), found["reasons"])

    def test_what_is_held_against_its_registration_is_held_against_the_specimen(self):
        found = self.begin_assessed()
        self.assertNotIn("typed_transform", [reason["id"] for reason in found["verdict"]["reasons"]])
        self.registered(by=dict)
        done = self.incise(*self.arguments("--stretch-force-n", PULL_N, "--json"))
        self.assertIn("caution: typed_transform: registration.json", done.stderr)
        self.assertIn("typed_transform", [reason["id"] for reason in json.loads(done.stdout)["verdict"]["reasons"]])
        self.registered(reasons=["the mirror image fits as well"])
        found = self.assessed("--stretch-force-n", PULL_N)
        self.assertIn({"id": "registration", "message": "the mirror image fits as well"},
                      [{key: reason[key] for key in ("id", "message")} for reason in found["verdict"]["reasons"]])

    def test_advice_against_a_path_takes_its_program_away_and_no_doubt_from_it(self):
        small_case.write_case(self.folder / "case", small_case.SOUND)
        small_case.write_tumor_surface(self.folder / "case" / "tumor.stl")
        doubts = lambda: [reason["id"] for reason in json.loads((self.out / "correction" / "path.json").read_text())["verdict"]["reasons"]]
        done = self.incise("run", "case", "-o", self.out, *small_case.ACCEPTED, status=DONE)
        script = self.out / "program" / "program.script"
        self.assertTrue(script.exists())
        before = doubts()
        self.assertIn("not_corrected", before)
        self.registered(rmse_mm=1.8)
        done = self.incise(*self.arguments("--stretch-force-n", PULL_N), status=NOT_ACCEPTABLE)
        self.assertFalse(script.exists(), "it was written before the advice")
        self.assertIn("removed, because it was written before this advice", done.stderr)
        self.assertIn("eligibility", doubts())
        self.assertLessEqual(set(before), set(doubts()), "a rejected correction stays one")

    def test_outside_the_calibrated_range_or_badly_registered_is_not_to_be_used(self):
        found = self.assessed("--stretch-force-n", 5.0 * PULL_N, status=NOT_ACCEPTABLE)
        self.assertEqual(found["advice"], "do_not_use")
        self.assertTrue(any(reason.startswith("youngs_modulus_kpa") for reason in found["reasons"]), found["reasons"])
        self.registered(rmse_mm=1.8)
        found = self.assessed("--stretch-force-n", PULL_N, status=NOT_ACCEPTABLE)
        self.assertTrue(any("1.80 mm (rms)" in reason for reason in found["reasons"]), found["reasons"])
        self.registered(T_target_source=None, rmse_mm=None, scale=None, converged=False)
        found = self.assessed("--stretch-force-n", PULL_N, status=NOT_ACCEPTABLE)
        self.assertTrue(any("refused" in reason for reason in found["reasons"]), found["reasons"])

    def test_a_pull_that_is_withheld_is_said_and_widens_what_is_believed(self):
        known = self.begin_assessed()
        withheld = self.assessed()
        self.assertTrue(any("pull was not measured" in note for note in withheld["notes"]), withheld["notes"])
        self.assertEqual((len(known["scenarios"]["tissues"]), len(withheld["scenarios"]["tissues"])), (1, 3))
        self.assertEqual(withheld["scenarios"]["own_stiffness_sd"], 0.5)
        width = lambda found: found["intended"]["abs_error_80_mm"][1] - found["intended"]["abs_error_80_mm"][0]
        self.assertGreater(width(withheld), width(known))
        self.assertEqual([entry["name"] for entry in withheld["distances"]], ["registration_rmse_mm", "registration_scale"])
        self.assertGreaterEqual(withheld["p_unlike"], 0.05, "not surer than before anything was measured")
        # A calibration of an earlier version does not say how its cuts erred.
        small_calibration.write(self.calibration, lambda c: [s.pop("photographed_mean_signed_mm") for s in c["specimens"]])
        older = self.assessed("--stretch-force-n", PULL_N)
        self.assertEqual(older["p_worse_if_unlike"], 0.5)
        self.assertTrue(any("does not state the mean errors" in note for note in older["notes"]), older["notes"])

    def test_a_virtual_calibration_never_advises_to_correct_a_real_specimen(self):
        small_case.write_case(self.folder / "case", {"compensation": {"observable": "inner_edge", "bias_mm": 0.2}, "specimen_is": "real"})
        found = self.assessed("--stretch-force-n", PULL_N)
        self.assertEqual((found["specimen_is"], found["calibration_is"]), ("real", "virtual"))
        self.assertEqual(found["advice"], "cut_as_planned", found["reasons"])
        self.assertTrue(any("the calibration is of virtual specimens and this one is real" in reason for reason in found["reasons"]), found["reasons"])
        small_calibration.write(self.calibration, lambda c: c.update(virtual=False))
        found = self.assessed("--stretch-force-n", PULL_N)
        self.assertEqual((found["specimen_is"], found["calibration_is"]), ("real", "real"))
        self.assertFalse(any("virtual" in reason for reason in found["reasons"]), found["reasons"])

    def test_what_photographs_show_beyond_the_simulation_is_expected_of_this_cut(self):
        plain = self.begin_assessed()

        def farther_out(found):
            for one in found["fitted"]:
                one["observed_mm"] = [error + 1.5 for error in one["observed_mm"]]

        small_calibration.write(self.calibration, farther_out)
        out = self.assessed("--stretch-force-n", PULL_N)
        mean = lambda found: sum(found["scenarios"]["residual_mm"]) / 36
        self.assertGreater(mean(out) - mean(plain), 0.8)
        self.assertLess(out["intended"]["expected_abs_error_mm"], plain["intended"]["expected_abs_error_mm"] - 0.8)
        # Profiles of another calibration may have other sectors.
        def coarser(found):
            farther_out(found)
            for one in found["fitted"]:
                one.update(observed_mm=one["observed_mm"][::2], fitted_mm=one["fitted_mm"][::2])

        small_calibration.write(self.calibration, coarser)
        coarse = self.assessed("--stretch-force-n", PULL_N)
        self.assertEqual(len(coarse["scenarios"]["residual_mm"]), 18)
        self.assertAlmostEqual(coarse["intended"]["expected_abs_error_mm"], out["intended"]["expected_abs_error_mm"], delta=0.1)
        small_calibration.write(self.calibration, farther_out)
        # Of two photographs one is not used, which is said.
        small_calibration.write(self.calibration, lambda c: c["specimens"][0].pop("ring"))
        done = self.incise(*self.arguments("--stretch-force-n", PULL_N))
        self.assertIn("1 of the calibration's 2 specimens have a ring", done.stderr)

        # Photographs that lie inside where simulations lie outside: the simulation says nothing.
        def contrary(found):
            for one, size in zip(found["fitted"], (1.5, -1.5)):
                wave = [size * math.cos(4.0 * math.pi * i / 36) for i in range(36)]
                one.update(fitted_mm=[-3.5 + w for w in wave], observed_mm=[-3.5 - 3.0 * w for w in wave])

        small_calibration.write(self.calibration, contrary)
        done = self.incise(*self.arguments("--stretch-force-n", PULL_N), status=BAD_DATA)
        self.assertRegex(done.stderr, "calibration.json: fitted: found a simulated share of -[0-9.]+ .photographed "
                                      "differences per simulated difference.")
        small_calibration.write(self.calibration, farther_out)
        # A correction that expects it itself is assessed, too.
        small_case.write_case(self.folder / "case", {"compensation": {"observable": "inner_edge", "bias_mm": 0.2, "residual_mm": [1.5]}})
        knowing = self.assessed("--stretch-force-n", PULL_N)
        self.assertAlmostEqual(knowing["intended"]["expected_abs_error_mm"], out["intended"]["expected_abs_error_mm"], delta=1e-9)
        self.assertLess(knowing["corrected"]["expected_abs_error_mm"], out["corrected"]["expected_abs_error_mm"])

    def test_a_ring_that_stays_open_cannot_be_foretold(self):
        small_case.write_case(self.folder / "case", {"cut": {"dullness": 900}})
        found = self.assessed(status=NOT_ACCEPTABLE)
        self.assertEqual(found["advice"], "do_not_use")
        self.assertIsNone(found["expected_gain_mm"])
        self.assertTrue(any("stays open" in reason for reason in found["reasons"]), found["reasons"])
        self.assertTrue(any("is 234.00 mm, that of the calibration's choice 1.30 mm" in note for note in found["notes"]), found["notes"])

    def test_what_cannot_be_is_refused_before_anything_is_written(self):
        self.assert_refused(self.incise(*self.arguments("--stretch-force-n", -1)), BAD_CASE, "--stretch-force-n")
        self.registered(rmse_mm="absent")
        self.assert_refused(self.incise(*self.arguments()), BAD_DATA, "registration.json", "rmse_mm")
        self.registered(converged="absent")
        self.assert_refused(self.incise(*self.arguments()), BAD_DATA, "registration.json", "converged")
        self.registered(T_target_source="absent")
        self.assert_refused(self.incise(*self.arguments()), BAD_DATA, "registration.json", "T_target_source")
        self.registered()
        small_calibration.write(self.calibration, lambda c: c.update(method="paper"))
        self.assert_refused(self.incise(*self.arguments()), BAD_DATA, "calibration.json", "method")
        small_calibration.write(self.calibration, lambda c: c["specimens"][0].update(registration={"rmse_mm": -1, "scale": 1}))
        self.assert_refused(self.incise(*self.arguments()), BAD_DATA, "calibration.json", "/specimens/0/registration/rmse_mm")
        small_calibration.write(self.calibration, lambda c: c["posterior"]["samples"][3].update(drag_length_mm=1e300))
        self.assert_refused(self.incise(*self.arguments()), BAD_DATA, "calibration.json: /posterior/samples/3/drag_length_mm: found 1e+300")
        small_calibration.write(self.calibration, lambda c: c["posterior"]["samples"][3].update(bias_mm=-1e9))
        self.assert_refused(self.incise(*self.arguments()), BAD_DATA, "calibration.json: /posterior/samples/3/bias_mm: found -1000000000")
        small_calibration.write(self.calibration)
        small_case.write_case(self.folder / "case", {"compensation": {"method": "paper"}})
        self.assert_refused(self.incise(*self.arguments()), BAD_CASE, "compensation.method", "paper")
        small_case.write_case(self.folder / "case", {"path": "other.json"})
        (self.folder / "case" / "other.json").write_text("{}")
        self.assert_refused(self.incise(*self.arguments()), BAD_CASE, "case.yaml", "path", "a path of its own")
        small_case.write_case(self.folder / "case")
        small_calibration.write(self.calibration, lambda c: [s.pop("ring") for s in c["specimens"]])
        self.assert_refused(self.incise(*self.arguments()), BAD_DATA, "calibration.json", "specimens",
                            "Calibrate again")
        small_calibration.write(self.calibration)
        small_case.write_case(self.folder / "case", {"cut": {"rule": "lattice"}})
        self.assert_refused(self.incise(*self.arguments()), BAD_CASE, "case.yaml", "cut.rule", "lattice", "expected tets")
        small_calibration.write(self.calibration, lambda c: c.update(cut_rule="paper"))
        self.assert_refused(self.incise(*self.arguments()), BAD_CASE, "cut.rule", "lattice", "expected paper")
        small_calibration.write(self.calibration, lambda c: c.update(cut_rule="lettuce"))
        self.assert_refused(self.incise(*self.arguments()), BAD_DATA, "calibration.json", "cut_rule", "lettuce")
        self.assert_nothing_written()

    def test_an_interrupted_assessment_goes_on(self):
        stopped = self.interrupted(*self.arguments("--threads", 1), after="tissue of the calibration: 3 cuts")
        self.assertEqual(stopped.returncode, INTERRUPTED, stopped.stderr)
        self.assertFalse((self.out / "assessment").exists())
        self.incise(*self.arguments())
        self.assertTrue((self.out / "assessment").exists())


if __name__ == "__main__":
    unittest.main()
