"""`evaluate`, `compare` and `audit`: results, files, and what is refused."""

import json
import math
import pathlib
import unittest

import small_case
from command import BAD_CASE, BAD_DATA, DONE, NOT_ACCEPTABLE, CommandTest, files_below

TABLES = pathlib.Path(__file__).resolve().parents[2] / "data" / "published_tables"
PNG = b"\x89PNG\r\n\x1a\n"


class ContourTest(CommandTest):
    """A round tumour of 10 mm radius at the origin, and rings about it as inner edges at 14.5 mm."""

    def setUp(self):
        super().setUp()
        small_case.write_contour(self.folder / "tumor.csv", small_case.ring((0, 0), 10.0, 0.0, 720))

    def evaluate(self, name, shift, *more, radius=14.5, status=DONE):
        incision = self.folder / f"{name}.csv"
        small_case.write_contour(incision, small_case.ring((shift, 0.0), radius, 0.0, 720))
        return self.json_of("evaluate", "--incision", incision, "--tumor", "tumor.csv", "--contour", "inner_edge",
                            "-o", f"{name}.json", *more, status=status)


class EvaluateTest(ContourTest):
    def test_the_file_holds_what_is_printed_and_the_points(self):
        printed = self.evaluate("s1", 1.0)
        self.assertEqual(json.loads((self.folder / "s1.json").read_text()), printed)
        self.assertEqual(len(printed["points"]["signed_error_mm"]), printed["n_points"])
        self.assertEqual(len(printed["points"]["clock_h"]), printed["n_points"])
        self.assertAlmostEqual(printed["zones"]["positive_margin"]["at_or_below_mm"], -4.5)
        self.assertAlmostEqual(printed["zones"]["too_close"]["at_or_below_mm"], -2.3)
        self.assertAlmostEqual(printed["hausdorff_mm"]["symmetric"], 1.0, delta=0.01)
        self.assertGreater(printed["by_clock"][2]["mean_mm"], 0.9)   # 3 o'clock: farther
        self.assertLess(printed["by_clock"][8]["mean_mm"], -0.9)

    def test_twelve_o_clock_can_be_chosen(self):
        printed = self.evaluate("s1", 1.0, "--twelve-o-clock", "1", "0", "0")
        self.assertGreater(printed["by_clock"][11]["mean_mm"], 0.9)

    def test_a_cut_inside_the_tumour_is_a_result_with_everything_in_it(self):
        printed = self.evaluate("s1", 6.0, status=NOT_ACCEPTABLE)
        self.assertEqual(printed["outcome"], "positive_margin")
        self.assertGreater(printed["zones"]["positive_margin"]["points"], 0)
        self.assertTrue((self.folder / "s1.json").is_file())

    def test_figures_in_both_formats_and_both_maps(self):
        self.evaluate("s1", 3.0, "--figure", "safe.svg")
        self.evaluate("s1", 3.0, "--figure", "jet.svg", "--colors", "jet")
        self.evaluate("s1", 3.0, "--figure", "jet.png", "--colors", "jet")
        safe, jet = ((self.folder / name).read_text() for name in ("safe.svg", "jet.svg"))
        self.assertTrue(safe.startswith("<svg"))
        self.assertIn("5 mm", safe)
        self.assertNotEqual(safe, jet)
        self.assertTrue((self.folder / "jet.png").read_bytes().startswith(PNG))

    def test_a_figure_of_another_kind_or_place_is_refused_before_anything_is_written(self):
        small_case.write_contour(self.folder / "a.csv", small_case.ring((0, 0), 14.5, 0.0))
        common = ("evaluate", "--incision", "a.csv", "--tumor", "tumor.csv", "-o", "out")
        self.assert_refused(self.incise(*common, "--figure", "f.bmp"), BAD_CASE, "--figure", "f.bmp", ".svg or .png")
        self.assert_refused(self.incise(*common, "--figure", "nowhere/f.png"), BAD_DATA, "nowhere")
        self.assert_nothing_written()


    def test_contours_that_cannot_be_meant_are_refused_by_their_own_names(self):
        write = lambda name, points: small_case.write_contour(self.folder / name, points)
        eight = [(12 * math.sin(t / 50), 8 * math.sin(t / 25), 0.0) for t in range(314)]
        for name, points, says in (("eight.csv", eight, "crosses itself"),
                                   ("metres.csv", small_case.ring((0, 0), 0.0145, 0.0, 360), "Are its numbers in mm?"),
                                   ("huge.csv", small_case.ring((0, 0), 145.0, 0.0, 360), "290 mm across"),
                                   ("same.csv", [(1.0, 2.0, 3.0)] * 20, "0 mm across")):
            write(name, points)
            with self.subTest(name=name):
                done = self.incise("evaluate", "--incision", name, "--tumor", "tumor.csv", "-o", "out")
                self.assert_refused(done, BAD_DATA, name, says)
                done = self.incise("evaluate", "--incision", "tumor.csv", "--tumor", name, "-o", "out")
                self.assert_refused(done, BAD_DATA, name, says)
                self.assert_nothing_written()

    def test_a_scale_is_for_photographs(self):
        done = self.incise("evaluate", "--incision", "tumor.csv", "--tumor", "tumor.csv", "--mm-per-pixel", "0.03")
        self.assert_refused(done, BAD_CASE, "a scale for contour files")

    def test_points_given_twice_change_nothing(self):
        ring = small_case.ring((1.0, 0.0), 14.5, 0.0, 720)
        small_case.write_contour(self.folder / "twice.csv", [p for q in ring for p in (q, q)] + [ring[0]])
        once = self.evaluate("s1", 1.0)
        twice = self.json_of("evaluate", "--incision", "twice.csv", "--tumor", "tumor.csv", "--contour", "inner_edge")
        for key in ("abs_error_mm", "hu_score", "centroid_shift_mm", "n_points"):
            self.assertEqual(twice[key], once[key], key)


class CompareTest(ContourTest):
    def four(self):
        for name, shift in (("s1", 2.0), ("s2", 2.6), ("s3", 1.6), ("s4", 2.1)):
            self.evaluate(name, shift)
        return "--before", "s1.json", "s2.json", "--after", "s3.json", "s4.json"

    def test_points_claim_what_specimens_do_not(self):
        result = self.json_of("compare", *self.four())
        self.assertLess(result["points"]["p"], 0.01)
        self.assertIn("pooled", result["points"]["test"])
        self.assertGreater(result["specimens"]["p"], 0.1)
        self.assertGreater(result["points"]["block_bootstrap"]["p"], result["points"]["p"])
        self.assertLess(result["points"]["n_effective_before"], 0.1 * result["points"]["n_before"])
        self.assertGreater(result["specimens"]["fewest_specimens"], 2)
        self.assertLess(result["mean_after_mm"], result["mean_before_mm"])
        self.assertEqual([row["name"] for row in result["rows"]], ["s1", "s2", "s3", "s4"])

    def test_the_folder_is_complete_and_repeats_bit_for_bit(self):
        sides = self.four()
        self.json_of("compare", *sides, "-o", "one", "--threads", "1", "--seed", "7")
        self.json_of("compare", *sides, "-o", "two", "--threads", "2", "--seed", "7")
        names = ["box_plot.png", "box_plot.svg", "compare.json", "error_by_clock.png", "error_by_clock.svg", "manifest.json",
                 "table.csv", "table.tex", "tests.csv", "tests.tex"]
        self.assertEqual(files_below(self.folder / "one"), names)
        for name in names:
            if name != "manifest.json":
                self.assertEqual((self.folder / "one" / name).read_bytes(), (self.folder / "two" / name).read_bytes(), name)
        manifest = json.loads((self.folder / "one" / "manifest.json").read_text())
        self.assertEqual(len(manifest["inputs"]), 4)
        self.assertEqual(manifest["seed"], 7)
        self.assertIn("pooled by point", (self.folder / "one" / "tests.csv").read_text())
        self.assertIn("\\toprule", (self.folder / "one" / "table.tex").read_text())

    def test_pairs(self):
        result = self.json_of("compare", *self.four(), "--paired")
        self.assertEqual(result["specimens"]["df"], 1.0)
        self.assertEqual(result["specimens"]["test"], "paired, by specimen")
        self.assertEqual({name: result["specimens"][name]["test"] for name in ("student", "welch", "paired")},
                         {name: f"{name}, by specimen" for name in ("student", "welch", "paired")})
        self.assertEqual(result["points"]["welch"]["test"], "welch, pooled by point")
        self.assert_refused(self.incise("compare", "--before", "s1.json", "s2.json", "--after", "s3.json", "--paired"), BAD_CASE,
                            "--paired", "2 before and 1 after")

    def test_one_specimen_each_has_no_test_by_specimen(self):
        self.four()
        result = self.json_of("compare", "--before", "s1.json", "--after", "s3.json")
        self.assertEqual(result["specimens"]["verdict"], "too_few")
        self.assertIsNone(result["specimens"]["p"])
        self.assertIsNotNone(result["points"]["p"])

    def test_identical_specimens_have_no_spread(self):
        self.evaluate("a", 1.0)
        for name in ("b", "c", "d"):
            (self.folder / f"{name}.json").write_bytes((self.folder / "a.json").read_bytes())
        result = self.json_of("compare", "--before", "a.json", "b.json", "--after", "c.json", "d.json")
        self.assertEqual(result["specimens"]["verdict"], "no_spread")
        self.assertIsNone(result["specimens"]["p"])
        self.assertEqual(result["points"]["verdict"], "tested")
        self.assertEqual(result["points"]["p"], 1.0)

    def test_a_specimen_without_an_incision_is_named_and_left_out(self):
        self.four()
        failed = json.loads((self.folder / "s2.json").read_text())
        failed.update(outcome="open_loop", closed_loop=False, n_points=0, zones={"positive_margin": None, "too_close": None}, points={})
        (self.folder / "failed.json").write_text(json.dumps(failed))
        result = self.json_of("compare", "--before", "s1.json", "failed.json", "--after", "s3.json", "s4.json", "-o", "out")
        self.assertEqual(result["left_out"], [{"name": "failed", "outcome": "open_loop"}])
        self.assertEqual(result["specimens"]["n_before"], 1)
        self.assertIn("failed,open_loop,0,-", (self.out / "table.csv").read_text())
        alone = self.json_of("compare", "--before", "failed.json", "--after", "s3.json", "-o", "alone", status=NOT_ACCEPTABLE)
        self.assertTrue((self.folder / "alone" / "compare.json").is_file())
        self.assertEqual(alone["verdict"], "too_few")
        self.assertIsNone(alone["points"])

    def test_damaged_files_are_named_with_the_place(self):
        self.four()
        good = json.loads((self.folder / "s1.json").read_text())
        for key, value, says in (("points", None, "points"), ("target_mm", "far", "target_mm"), ("outcome", "fine", "outcome"), ("contour", "middle", "contour"),
                                 ("n_points", 7, "/points/signed_error_mm")):
            with self.subTest(key=key):
                (self.folder / "bad.json").write_text(json.dumps({**good, key: value}))
                done = self.incise("compare", "--before", "bad.json", "--after", "s3.json", "-o", "out")
                self.assert_refused(done, BAD_DATA, "bad.json", says)
                self.assert_nothing_written()
        (self.folder / "bad.json").write_text((self.folder / "s1.json").read_text()[:500])
        self.assert_refused(self.incise("compare", "--before", "bad.json", "--after", "s3.json"), BAD_DATA, "bad.json", "line")
        self.assert_refused(self.incise("compare", "--before", "none.json", "--after", "s3.json"), BAD_DATA, "none.json")

    def test_only_like_is_compared_with_like(self):
        self.four()
        small_case.write_contour(self.folder / "mid.csv", small_case.ring((0, 0), 15.0, 0.0, 360))
        self.json_of("evaluate", "--incision", "mid.csv", "--tumor", "tumor.csv", "-o", "mid.json")
        self.assert_refused(self.incise("compare", "--before", "s1.json", "--after", "mid.json"), BAD_DATA, "mid.json", "contour",
                            "centerline", "inner_edge")
        self.assert_refused(self.incise("compare", "--before", "s1.json", "--after", "s1.json"), BAD_CASE, "--after", "s1.json twice")

    def test_paired_specimens_may_have_targets_of_their_own(self):
        self.four()
        for name, source, target in (("near1", "s1", 2.5), ("near2", "s3", 2.5), ("far", "s4", 4.0)):
            changed = json.loads((self.folder / f"{source}.json").read_text())
            changed["target_mm"] = target
            (self.folder / f"{name}.json").write_text(json.dumps(changed))
        sides = ("--before", "s2.json", "near1.json", "--after", "s4.json", "near2.json")
        result = self.json_of("compare", *sides, "--paired", "-o", "out")
        self.assertIsNone(result["target_mm"])
        self.assertEqual([row["target_mm"] for row in result["rows"]], [4.5, 2.5, 4.5, 2.5])
        self.assertNotIn("tumour edge reached", (self.out / "box_plot.svg").read_text())
        self.assert_refused(self.incise("compare", *sides), BAD_DATA, "near1.json", "target_mm", "2.5", "s2.json")
        self.assert_refused(self.incise("compare", "--before", "s2.json", "near1.json", "--after", "s4.json", "far.json", "--paired"),
                            BAD_DATA, "far.json", "target_mm", "near1.json")

    def test_levels_that_are_none_are_refused(self):
        sides = self.four()
        self.assert_refused(self.incise("compare", *sides, "--alpha", "0"), BAD_CASE, "alpha")
        self.assert_refused(self.incise("compare", *sides, "--power", "1"), BAD_CASE, "power")


class AuditTest(CommandTest):
    def test_the_papers_table(self):
        result = self.json_of("audit", TABLES / "table_1.csv", "-o", "audit.json", status=NOT_ACCEPTABLE)
        self.assertEqual(json.loads((self.folder / "audit.json").read_text()), result)
        self.assertEqual(len(result["rows"]), 25)
        self.assertEqual(result["findings_by_rule"]["sd_too_large"], 22)
        self.assertEqual(result["findings_by_rule"]["pooled_mean_outside"], 1)
        self.assertEqual(result["score_baseline_mm"]["rows"], 20)
        done = self.incise("audit", TABLES / "table_1.csv", status=NOT_ACCEPTABLE)
        said = done.stdout
        self.assertIn("speed_mm_s 17, dullness 5", said)
        self.assertIn("pooled mean 0.8 lies outside the means of its parts", said)

    def test_a_table_that_passes(self):
        (self.folder / "t.csv").write_text("mean_mm,sd_mm,max_mm\n1.0,0.5,2.0\n")
        result = self.json_of("audit", "t.csv", "-o", "audit.json")
        self.assertEqual(result["impossible_rows"], 0)
        self.assertEqual(json.loads((self.folder / "audit.json").read_text()), result)

    def test_the_table_is_never_replaced(self):
        table = self.folder / "t.csv"
        table.write_text("mean_mm,sd_mm,max_mm\n1.0,0.5,2.0\n")
        self.assert_refused(self.incise("audit", "t.csv", "-o", "t.csv"), BAD_CASE, "-o", "an input")
        self.assertTrue(table.read_text().startswith("mean_mm"))

    def test_counts_by_their_grain(self):
        (self.folder / "t.csv").write_text("mean,sd,n\n5.18,1,28\n5.19,1,28\n")
        self.assertEqual(self.json_of("audit", "t.csv")["impossible_rows"], 0)
        self.assertEqual(self.json_of("audit", "t.csv", "--grain", "1", status=NOT_ACCEPTABLE)["impossible_rows"], 1)

    def test_pooling_is_checked_by_counts_and_what_is_not_is_said(self):
        header = "a_mean_mm,a_sd_mm,a_n,b_mean_mm,b_sd_mm,b_n,mean_mm,sd_mm,n\n"
        (self.folder / "t.csv").write_text(header + "1.0,0.2,10,3.0,0.2,10,1.1,1.05,20\n1.0,0.2,10,3.0,0.2,10,2.0,1.05,25\n"
                                           "1.0,0.2,10,3.0,0.2,10,2.0,1.0,20\n1.0,0.2,-,3.0,0.2,-,2.0,0.5,-\n")
        rows = self.json_of("audit", "t.csv", status=NOT_ACCEPTABLE)["rows"]
        self.assertEqual([[f["rule"] for f in row["findings"]] for row in rows],
                         [["pooled_mean_off"], ["pooled_n_off"], [], ["pooled_sd_too_small"]])
        self.assertEqual([u["rule"] for u in rows[3]["not_checkable"] if u["rule"].startswith("pooled")], ["pooled_n_off", "pooled_mean_off"])
        said = self.incise("audit", "t.csv").stdout
        self.assertIn("pooled_mean_off (needs n of every part)", said)

    def test_a_column_that_was_not_understood_is_named(self):
        (self.folder / "t.csv").write_text("trial,mean_mm,sd_mm,maximum_mm\n1,1.0,9.0,2.0\n")
        result = self.json_of("audit", "t.csv")
        self.assertEqual(result["columns"], {"read": ["mean_mm", "sd_mm"], "names": ["trial", "maximum_mm"]})
        said = self.incise("audit", "t.csv").stdout
        self.assertIn("names, not numbers: trial, maximum_mm", said)

    def test_numbers_that_are_none_are_refused(self):
        for cell in ("nan", "inf", "1e3", "1,2", "1.2.3", "0x1"):
            with self.subTest(cell=cell):
                (self.folder / "t.csv").write_text(f'mean_mm,sd_mm\n"{cell}",1\n')
                self.assert_refused(self.incise("audit", "t.csv", "-o", "out"), BAD_DATA, "t.csv", "line 2, column mean_mm", cell)
                self.assert_nothing_written()
        for text, says in (("mean_mm,sd_mm,n\n1,1,2.5\n", "a whole number"), ("mean_mm,sd_mm,n\n1,1,0\n", "a whole number"),
                           ("mean_mm,sd_mm,mean\n1,1,1\n", "one column for each"), ("mean_mm,sd_mm\n1\n", "line 2"), ("", "empty")):
            with self.subTest(text=text):
                (self.folder / "t.csv").write_text(text)
                self.assert_refused(self.incise("audit", "t.csv"), BAD_DATA, "t.csv", says)

    def test_missing_columns_and_words_are_refused(self):
        (self.folder / "t.csv").write_text("mean_mm,max_mm\n1,2\n")
        self.assert_refused(self.incise("audit", "t.csv"), BAD_DATA, "t.csv", "mean_mm and sd_mm")
        (self.folder / "t.csv").write_text("mean_mm,sd_mm\n1,broad\n")
        self.assert_refused(self.incise("audit", "t.csv"), BAD_DATA, "line 2, column sd_mm", "broad")
        self.assert_refused(self.incise("audit", "nowhere.csv"), BAD_DATA, "nowhere.csv")


if __name__ == "__main__":
    unittest.main()
