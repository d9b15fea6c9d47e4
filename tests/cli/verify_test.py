"""`incise verify`: what it prints, its exit status, its figures."""

import json
import unittest
import xml.etree.ElementTree

from command import BAD_CASE, BAD_DATA, DONE, INTERRUPTED, NOT_ACCEPTABLE, CommandTest

KEYS = {"name", "passed", "expected", "found", "tolerance", "criterion", "unit", "what", "source", "note", "wall_s"}


class VerifyTest(CommandTest):
    def test_a_check_says_what_was_expected_and_found(self):
        result = self.json_of("verify", "--only", "support_penetration")
        self.assertTrue(result["passed"])
        (check,) = result["checks"]
        self.assertEqual(set(check), KEYS)
        self.assertEqual(check["unit"], "mm")
        self.assertLessEqual(abs(check["found"] - check["expected"]), check["tolerance"])

    def test_the_start_of_a_name_selects_its_family(self):
        names = [check["name"] for check in self.json_of("verify", "--only", "patch")["checks"]]
        self.assertGreaterEqual(len(names), 4)
        self.assertTrue(all(name.startswith("patch_") for name in names), names)

    def test_without_tolerance_the_outcome_is_not_acceptable_and_complete(self):
        result = self.json_of("verify", "--only", "cantilever_rate", "--tolerance-scale", "0", status=NOT_ACCEPTABLE)
        self.assertFalse(result["passed"])
        self.assertIsInstance(result["checks"][0]["found"], float)

    def test_figures_are_small_svg_files_named_like_the_checks(self):
        folder = self.folder / "new" / "figures"
        self.json_of("verify", "--only", "shear", "--figures", folder)
        files = sorted(folder.iterdir())
        self.assertIn("shear_corotational.svg", [file.name for file in files])
        for file in files:
            self.assertTrue(xml.etree.ElementTree.parse(file).getroot().tag.endswith("svg"))
            self.assertLess(file.stat().st_size, 40_000)

    def test_the_table_for_a_person_names_source_and_verdict(self):
        done = self.incise("verify", "--only", "support_pull", status=DONE)
        for words in ("support_pull", "source: ", "yes", "1 of 1 checks passed"):
            self.assertIn(words, done.stdout)
        self.assertIn("check 1 of 1: support_pull", done.stderr)

    def test_an_unknown_name_is_refused_with_the_nearest(self):
        self.assert_refused(self.incise("verify", "--only", "cantilver_rate"), BAD_CASE, "--only", "cantilever_rate")

    def test_an_output_that_cannot_be_written_is_told_before_anything_runs(self):
        done = self.incise("verify", "-o", "missing/x.json")
        self.assert_refused(done, BAD_DATA, "missing/x.json", "no folder 'missing'")
        self.assertNotIn("check 1 of", done.stderr)

    def test_an_interruption_says_that_nothing_was_written(self):
        done = self.interrupted("verify", "-o", "x.json", after="check 1 of")
        self.assertEqual(done.returncode, INTERRUPTED, done.stderr)
        self.assertIn("nothing was written", done.stderr)
        self.assert_nothing_written(self.folder / "x.json")

    def test_output_holds_what_json_prints(self):
        path = self.folder / "verify.json"
        printed = self.json_of("verify", "--only", "support_pull", "-o", path)
        self.assertEqual(json.loads(path.read_text()), printed)


if __name__ == "__main__":
    unittest.main()
