"""The lowest power that fits, on a coarse and quick virtual bench; a surgeon's speed; and what is refused."""

import csv
import json
import pathlib
import struct
import unittest

from command import BAD_CASE, BAD_DATA, DONE, INTERRUPTED, NOT_ACCEPTABLE, CommandTest, files_below

COARSE = ("--specimens", 1, "--seed", 2, "--fine-mm", 4)
PAPERS_CUTS = pathlib.Path(__file__).resolve().parents[2] / "data" / "published_tables" / "timed_cuts.csv"


class BadInputTest(CommandTest):
    def refused(self, status, arguments, *says):
        self.assert_refused(self.incise("power", "-o", self.out, *COARSE, *arguments), status, *says)
        self.assert_nothing_written()

    def test_powers_that_no_generator_has_are_refused(self):
        self.refused(BAD_CASE, ("--power-w", "25,plenty"), "--power-w", "'plenty'", "1 to 120")
        self.refused(BAD_CASE, ("--power-w", "25,300"), "--power-w", "300", "1 to 120")
        self.refused(BAD_CASE, ("--power-w", "25,-30"), "--power-w", "-30")
        self.refused(BAD_CASE, ("--power-w", "35,25,35"), "--power-w", "35 twice")
        self.refused(BAD_CASE, ("--power-w", ""), "--power-w", "a number from 1 to 120")

    def test_limits_and_speeds_are_above_zero(self):
        self.refused(BAD_CASE, ("--bulge-limit-mm", -1), "--bulge-limit-mm", "above 0")
        self.refused(BAD_CASE, ("--damage-limit-mm", 0), "--damage-limit-mm", "above 0")
        self.refused(BAD_CASE, ("--speeds", "3,0"), "--speeds-mm-s", "0.5 to 50")
        self.refused(BAD_CASE, ("--speed-mm-s", "fast"), "--speed-mm-s", "'fast'")

    def test_specimens_are_files_or_a_number_each_once(self):
        specimen = self.folder / "one.json"
        specimen.write_text(json.dumps({"schema": "incise.specimen/1", "seed": 2}))
        self.refused(BAD_CASE, (specimen,), "--specimens", "either files or a number")
        self.refused(BAD_CASE, ("--specimens", 0), "--specimens", "1 to 200")
        twice = self.incise("power", specimen, specimen, "-o", self.out)
        self.assert_refused(twice, BAD_CASE, "one.json", "every specimen once")
        self.assert_refused(self.incise("power", "nowhere.json", "-o", self.out), BAD_DATA, "nowhere.json")
        specimen.write_text(json.dumps({"schema": "incise.specimen/1", "seed": 2, "toughness": 3}))
        self.assert_refused(self.incise("power", specimen, "-o", self.out), BAD_DATA, "one.json", "Did you mean 'toughness_j_m2'?")
        self.assert_nothing_written()

    def test_a_bad_row_of_timed_cuts_is_named(self):
        cuts = self.folder / "cuts.csv"
        cuts.write_text("length_mm,time_s\n100,9\n100,-15\n")
        self.refused(BAD_DATA, ("--timed-cuts", cuts), "cuts.csv", "line 3, column time_s", "-15", "above 0")
        cuts.write_text("length_mm,time_s\n100,soon\n")
        self.refused(BAD_DATA, ("--timed-cuts", cuts), "cuts.csv", "line 2, column time_s", "'soon'")
        self.refused(BAD_CASE, ("--only-speed",), "--only-speed", "--timed-cuts")
        for row, says in (("1e300,1e-300", "line 2, column length_mm: found 1e+300"), ("30,1e-9", "line 2, column time_s: found 30 mm in 1e-09 s")):
            cuts.write_text(f"length_mm,time_s\n{row}\n")
            self.refused(BAD_DATA, ("--timed-cuts", cuts, "--only-speed"), f"cuts.csv: {says}")

    def test_an_output_is_needed_and_is_no_file(self):
        self.assert_refused(self.incise("power", *COARSE), BAD_CASE, "-o")
        self.out.write_text("mine")
        self.assert_refused(self.incise("power", "-o", self.out, *COARSE), BAD_DATA, "out")
        self.assertEqual(self.out.read_text(), "mine")
        foreign = self.folder / "foreign"
        foreign.mkdir()
        (foreign / "notes.txt").write_text("mine")
        self.assert_refused(self.incise("power", "-o", foreign, *COARSE), BAD_DATA, "foreign", "files of another origin")
        self.assertEqual([file.name for file in foreign.iterdir()], ["notes.txt"])


class SpeedTest(CommandTest):
    def test_the_papers_cuts_give_the_papers_speed_without_cutting(self):
        speed = self.json_of("power", "--timed-cuts", PAPERS_CUTS, "--only-speed")["speed_estimate"]
        self.assertAlmostEqual(speed["mean_mm_s"], 7.22, delta=0.005)
        self.assertAlmostEqual(speed["population_sd_mm_s"], 1.89, delta=0.005)
        self.assertAlmostEqual(speed["sample_sd_mm_s"], 2.07, delta=0.005)
        self.assertEqual(speed["recommended_mm_s"], 7)
        self.assertIn("7.22 mm/s, sd 1.89 (n) or 2.07 (n - 1)", self.incise("power", "--timed-cuts", PAPERS_CUTS, "--only-speed").stdout)


class SeriesTest(CommandTest):
    def power(self, *arguments, status=DONE):
        return self.json_of("power", "-o", self.out, *COARSE, *arguments, status=status)

    def test_a_series_is_rows_figures_and_a_choice_and_its_cuts_are_used_again(self):
        # Limits of this coarse bench, between what it does at 28 and at 40 W.
        loose = ("--damage-limit-mm", 1.5)
        first = self.power("--power-w", "28,40", "--bulge-limit-mm", 20, *loose)
        self.assertTrue(first["virtual"])
        self.assertEqual(first["cuts_made"], 2)
        weak, strong = first["rows"]
        self.assertEqual([weak["specimen"], weak["power_w"], weak["speed_mm_s"]], ["seed 2", 28, 7])
        self.assertGreater(weak["bulge_mm"], strong["bulge_mm"])
        self.assertLess(weak["thermal_width_mm"], strong["thermal_width_mm"])
        self.assertEqual(strong["outcome"], "success")

        middle = (weak["bulge_mm"] + strong["bulge_mm"]) / 2
        chosen = self.power("--power-w", "28,40", "--bulge-limit-mm", middle, *loose, "--timed-cuts", PAPERS_CUTS, "--speeds", "7,12")
        self.assertEqual([chosen["verdict"], chosen["chosen_w"], chosen["cuts_made"]], ["chosen", 40, 1])
        self.assertFalse(chosen["powers"][0]["fits"])
        self.assertIn("skin bulges", " ".join(chosen["powers"][0]["reasons"]))
        self.assertEqual(chosen["rows"], first["rows"])
        self.assertEqual([row["speed_mm_s"] for row in chosen["speed_rows"]], [7, 12])
        self.assertEqual(chosen["speed_estimate"]["recommended_mm_s"], 7)
        written = files_below(self.out)
        for name in ("power.csv", "power.json", "manifest.json", "bulge.svg", "heat.svg", "speed.svg"):
            self.assertIn(name, written)
        with open(self.out / "power.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["series"] for row in rows], ["power", "power", "speed", "speed"])
        self.assertEqual(float(rows[0]["bulge_mm"]), weak["bulge_mm"])
        settings = json.loads((self.out / "manifest.json").read_text())["settings"]
        self.assertEqual(settings["specimens"]["seed 2"]["seed"], 2)
        self.assertIn("virtual", (self.out / "bulge.svg").read_text())

        # No power fits: a result with a reason for each, and no curve of an earlier run.
        none = self.power("--power-w", "28,40", "--bulge-limit-mm", 0.001, *loose, status=NOT_ACCEPTABLE)
        self.assertEqual([none["verdict"], none["chosen_w"], none["cuts_made"]], ["no_power_fits", None, 0])
        self.assertTrue(all(power["reasons"] for power in none["powers"]))
        self.assertNotIn("speed.svg", files_below(self.out))

        # A damaged cut is told and made anew, to the same bits; with files in place of seeds the same cuts are found.
        damaged = next(path for path in sorted((self.out / "cache" / "power_cut").glob("*.bin")) if b"seed 2" + struct.pack("<d", 28.0) in path.read_bytes())
        damaged.write_bytes(damaged.read_bytes()[:100])
        mended = self.incise("power", "-o", self.out, *COARSE, "--power-w", "28,40", "--bulge-limit-mm", 20, *loose, "--json", status=DONE)
        self.assertIn(damaged.name, mended.stderr)
        self.assertIn("It is computed again", mended.stderr)
        self.assertEqual(json.loads(mended.stdout)["rows"], first["rows"])
        self.assertEqual(json.loads(mended.stdout)["cuts_made"], 1)
        specimen = self.folder / "one.json"
        specimen.write_text(json.dumps({"schema": "incise.specimen/1", "seed": 2}))
        same = self.json_of("power", specimen, "-o", self.out, "--fine-mm", 4, "--power-w", "28,40", "--bulge-limit-mm", 20, *loose)
        self.assertEqual([same["cuts_made"], same["rows"][0]["bulge_mm"]], [0, weak["bulge_mm"]])

    def test_an_interrupted_series_keeps_its_cuts_and_goes_on(self):
        limits = ("--bulge-limit-mm", 20, "--damage-limit-mm", 1.5)
        self.power("--power-w", 40, *limits)
        before = (self.out / "power.json").read_bytes()
        stopped = self.interrupted("power", "-o", self.out, *COARSE, "--power-w", "34,37,40", *limits, after="3 virtual cuts, 1 of them finished already")
        self.assertEqual(stopped.returncode, INTERRUPTED, stopped.stderr)
        self.assertIn("Run the same command to continue", stopped.stderr)
        self.assertIn("is from an earlier run", stopped.stderr)
        self.assertEqual((self.out / "power.json").read_bytes(), before)
        went_on = self.power("--power-w", "34,37,40", *limits)
        self.assertLess(went_on["cuts_made"], 3)
        self.assertEqual(len(went_on["rows"]), 3)

    def test_interrupted_before_the_first_cut_it_leaves_nothing(self):
        stopped = self.interrupted("power", "-o", self.out, *COARSE, after="0 of them finished already")
        self.assertEqual(stopped.returncode, INTERRUPTED, stopped.stderr)
        self.assertIn("nothing was written", stopped.stderr)
        self.assert_nothing_written()


if __name__ == "__main__":
    unittest.main()
