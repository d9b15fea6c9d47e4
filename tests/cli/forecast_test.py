"""What photographs of earlier cuts say of the next one."""

import json
import math
import unittest

import small_calibration
import small_case
from command import BAD_CASE, BAD_DATA, CommandTest

SECTORS = small_calibration.SECTORS
HAND_EYE_MM = (0.6, -0.4)


def photographed(start_deg, level_mm):
    """Signed errors from the start on: a level, and the same offset in the view wherever the cut starts."""
    view = [math.radians(start_deg + 360.0 * i / SECTORS) for i in range(SECTORS)]
    return [level_mm + HAND_EYE_MM[0] * math.cos(a) + HAND_EYE_MM[1] * math.sin(a) for a in view]


def with_rings(found):
    found["specimens"], found["fitted"] = [], []
    for k, start_deg in enumerate((-90.0, 20.0, 110.0, 200.0)):
        name = f"s{k + 1}"
        specimen = {**small_calibration.SPECIMENS[k % 2], "name": name}
        specimen["ring"] = {**small_calibration.ring(8.0 + 0.1 * k, 60.0 + k), "outline": 1.02, "aside_mm": 1.0, "start_deg": start_deg, "pull_deg": 90.0}
        found["specimens"].append(specimen)
        own = [0.15 * math.sin(3.0 * k + 2.0 * math.pi * (k + 1) * i / SECTORS) for i in range(SECTORS)]
        observed = [a + b for a, b in zip(photographed(start_deg, -1.2 + 0.02 * k), own)]
        found["fitted"].append({"name": name, "observed_mm": observed, "fitted_mm": [-1.0] * SECTORS})


class ForecastTest(CommandTest):
    def setUp(self):
        super().setUp()
        small_case.write_case(self.folder / "case")

    def test_the_offset_in_the_view_is_expected_of_this_ring_too(self):
        calibration = small_calibration.write(self.folder / "calibration.json", with_rings)
        found = self.json_of("forecast", "case", "--calibration", calibration, "-o", self.out)
        self.assertEqual(found["photographs"], 4)
        joined = found["with_simulation"]
        for axis in (0, 1):
            self.assertAlmostEqual(joined["hand_eye"]["offset_mm"][axis], HAND_EYE_MM[axis], delta=0.25)
            self.assertLess(joined["hand_eye"]["low_mm"][axis], HAND_EYE_MM[axis])
            self.assertGreater(joined["hand_eye"]["high_mm"][axis], HAND_EYE_MM[axis])
        start_deg = found["ring"]["start_deg"]
        for kind, expected in (("with_simulation", photographed(start_deg, -0.17)), ("without_simulation", photographed(start_deg, -1.17))):
            residual = found[kind]["residual_mm"]
            self.assertLess(max(abs(a - b) for a, b in zip(residual, expected)), 0.3, kind)
        self.assertLess(max(abs(a - b) for a, b in zip(found["in_view_mm"], photographed(start_deg, -1.17))), 0.12)
        self.assertIn("radius", joined["unlike"])  # the block's ring is another
        kept = json.loads((self.out / "forecast" / "forecast.json").read_text())
        self.assertEqual(kept["with_simulation"], joined)
        self.assertEqual(len(kept["calibration_sha256"]), 64)

        # Both blocks can be used as they are.
        self.assertEqual(joined["compensation"]["observable"], "inner_edge")
        self.assertAlmostEqual(joined["compensation"]["bias_mm"], 0.2)
        for kind in ("with_simulation", "without_simulation"):
            small_case.write_case(self.folder / kind, {"compensation": found[kind]["compensation"]})
            self.json_of("plan", kind, "-o", self.folder / f"{kind}_out")
        said = self.incise("forecast", "case", "--calibration", calibration, "-o", self.out).stdout
        self.assertIn("from 4 of 4 photographs", said)
        self.assertIn("outside most photographed rings in: radius", said)

    def test_damaged_profiles_are_named(self):
        def damaged(change):
            def both(found):
                with_rings(found)
                change(found["fitted"])
            return small_calibration.write(self.folder / "calibration.json", both)

        def shorter(fitted):
            fitted[1].update(observed_mm=fitted[1]["observed_mm"][:18], fitted_mm=fitted[1]["fitted_mm"][:18])

        def few(fitted):
            for one in fitted:
                one.update(observed_mm=one["observed_mm"][:3], fitted_mm=one["fitted_mm"][:3])

        def huge(fitted):
            fitted[2]["observed_mm"][0:2] = [1e200, -1e200]

        for change, words in ((shorter, ("18", "36")), (few, ("3 numbers", "9 to 360")), (huge, ("1e+200", "at most 10 mm"))):
            with self.subTest(change=change.__name__):
                done = self.incise("forecast", "case", "--calibration", damaged(change), "-o", self.out)
                self.assert_refused(done, BAD_DATA, "calibration.json", "fitted", *words)
                self.assert_nothing_written()

    def test_a_case_of_another_rule_is_refused(self):
        small_case.write_case(self.folder / "case", {"cut": {"rule": "lattice"}})
        calibration = small_calibration.write(self.folder / "calibration.json", with_rings)
        done = self.incise("forecast", "case", "--calibration", calibration, "-o", self.out)
        self.assert_refused(done, BAD_CASE, "cut.rule", "lattice")

    def test_a_calibration_without_rings_is_refused(self):
        calibration = small_calibration.write(self.folder / "calibration.json", lambda c: [s.pop("ring") for s in c["specimens"]])
        done = self.incise("forecast", "case", "--calibration", calibration, "-o", self.out)
        self.assert_refused(done, BAD_DATA, "calibration.json", "specimens", "Calibrate again")
        self.assert_nothing_written()
        done = self.incise("forecast", "case", "--calibration", "none.json", "-o", self.out)
        self.assert_refused(done, BAD_DATA, "none.json")


if __name__ == "__main__":
    unittest.main()
