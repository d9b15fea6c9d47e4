"""The experiment on the virtual bench: small, interrupted, run again; what a planner's commands are told."""

import json
import pathlib
import shlex
import signal
import subprocess
import unittest

from command import BAD_CASE, BAD_DATA, INTERRUPTED, CommandTest

SMALL = ("experiment", "--specimens", "2", "--outside", "1", "--quick", "--withheld-force", "--tets", "10000", "--threads", "2", "-o", "study")


class StudyTest(CommandTest):
    def times_of(self, pattern):
        """When each of these files was written. A step that runs again replaces its files."""
        return {str(path): path.stat().st_mtime_ns for path in (self.folder / "study").glob(pattern)}

    def test_specimens_that_cannot_be_halved_are_refused(self):
        done = self.incise("experiment", "--specimens", "3", "-o", "study", status=BAD_CASE)
        for words in ("--specimens", "found 3", "even"):
            self.assertIn(words, done.stderr)
        self.assert_nothing_written(self.folder / "study")

    def test_a_folder_of_another_origin_is_not_removed(self):
        notes = self.folder / "study" / "advice" / "notes.txt"
        notes.parent.mkdir(parents=True)
        notes.write_text("mine")
        done = self.incise("experiment", "--quick", "-o", "study", status=BAD_DATA)
        self.assertIn("another origin", done.stderr)
        (self.folder / "study" / "experiment.json").write_text('{"schema": "incise.experiment/1", "seed": 1}')
        done = self.incise("experiment", "--quick", "--seed", "1", "-o", "study", status=BAD_DATA)
        self.assertIn("advice", done.stderr)
        self.assertEqual(notes.read_text(), "mine")

    def test_an_experiment_with_other_specimens_is_not_mixed_with(self):
        kept = self.folder / "study" / "experiment.json"
        kept.parent.mkdir()
        kept.write_text('{"schema": "incise.experiment/1", "seed": 521}')
        report = self.folder / "study" / "report.html"
        report.write_text("an older one")
        done = self.incise("experiment", "--quick", "--seed", "999", "-o", "study", status=BAD_DATA)
        for words in ("experiment.json", "seed", "521", "999"):
            self.assertIn(words, done.stderr)
        self.assertEqual(report.read_text(), "an older one")

    def test_laboratories_are_not_mixed(self):
        for option in (("--outside", "1"), ("--known-physics",)):
            done = self.incise("experiment", "--quick", "--bench", "2", *option, "-o", "study", status=BAD_CASE)
            for words in (option[0], "second bench"):
                self.assertIn(words, done.stderr)
            self.assert_nothing_written(self.folder / "study")
        kept = self.folder / "study" / "experiment.json"
        kept.parent.mkdir(exist_ok=True)
        kept.write_text('{"schema": "incise.experiment/1", "seed": 1}')
        done = self.incise("experiment", "--quick", "--bench", "2", "--seed", "1", "-o", "study", status=BAD_DATA)
        for words in ("experiment.json", "bench", "found 1", "2, that of this command"):
            self.assertIn(words, done.stderr)

    def test_the_second_laboratory_is_cut_at_its_own_margins(self):
        result = self.json_of("experiment", "--bench", "2", "--specimens", "2", "--quick", "--no-rivals", "--tets", "10000", "--seed", "63",
                              "-o", "study")
        self.assertEqual(result["pairs"], 1)
        for name in ("S1_planned", "S2_planned", "S2_corrected"):
            specimen = self.folder / "study" / name[:2]
            margin = json.loads((specimen / "lab" / "readings.json").read_text())["prescription"]["lateral_margin_mm"]
            self.assertEqual(json.loads((specimen / f"{name}.json").read_text())["target_mm"], margin - 0.5)
            truth = json.loads((self.folder / "study" / "truth" / name / "cut_truth.json").read_text())
            self.assertEqual(truth["target_mm"], margin - 0.5)
        self.assertEqual(json.loads((self.folder / "study" / "experiment.json").read_text())["bench"], 2)

    def test_factors_are_switched_by_a_design_and_what_was_cut_is_kept(self):
        asked = ("bench", "factors", "--seed", "1", "--specimens", "1", "--factors", "hand_eye,motion,arm", "--override", "heat", "--threads", "2", "-o", "study")
        found = self.json_of(*asked)
        self.assertEqual((found["cuts"], found["settings"]["runs"]), (8, 8))
        self.assertEqual([factor["factor"] for factor in found["factors"]], ["motion", "hand_eye", "arm"])
        self.assertTrue(all(factor["made_with"] == 4 for factor in found["factors"]))
        self.assertEqual(len({row["folder"] for row in found["rows"]}), 8)
        self.assertGreater(found["measured"], 5)
        hand_eye = found["factors"][1]["moved"]
        self.assertGreater(hand_eye["shift_mm"], 2.0 * hand_eye["level_mm"], "an offset of the tip shifts the ring")
        table = (self.folder / "study" / "factors.csv").read_text().splitlines()
        self.assertEqual([row.split(",")[0] for row in table], ["factor", "motion", "hand_eye", "arm"])
        self.assertEqual(len((self.folder / "study" / "cuts.csv").read_text().splitlines()), 1 + 8)
        self.assertIn("<svg", (self.folder / "study" / "factors.svg").read_text())
        photographs = self.times_of("**/photo.png")
        self.assertGreater(len(photographs), 5)
        again = self.json_of(*asked)
        self.assertEqual({**again, "wall_s": 0}, {**found, "wall_s": 0})
        self.assertEqual(self.times_of("**/photo.png"), photographs, "finished cuts are kept")
        self.assert_refused(self.incise("bench", "factors", "--seed", "2", "-o", "study"), BAD_DATA, "bench.json", "seed")
        self.assert_refused(self.incise("bench", "factors", "--factors", "arm", "-o", "other"), BAD_CASE, "--factors", "at least two")

    def test_the_truth_needs_a_folder_of_its_own(self):
        for truth in ("study", "./study", "study/", "study/.", "other/../study", str(self.folder / "study")):
            done = self.incise("experiment", "--quick", "--truth", truth, "-o", "study")
            self.assertEqual(done.returncode, BAD_CASE, truth + done.stderr)
            self.assertIn("--truth", done.stderr)
            self.assertFalse((self.folder / "study").exists())

    def test_an_interrupted_experiment_goes_on_and_ends(self):
        begun = self.start(*SMALL)
        record = self.folder / "study" / "S1" / "cache" / "bench_make.bin"
        self.wait_until(begun, record.is_file)
        begun.send_signal(signal.SIGINT)
        done = self.finished(begun)
        self.assertEqual(done.returncode, INTERRUPTED, done.stderr)
        self.assertIn("kept", done.stderr)
        made = record.stat().st_mtime_ns

        result = self.json_of(*SMALL)
        self.assertEqual(record.stat().st_mtime_ns, made, "a step that had ended was run again")
        self.assertEqual(result["specimen_is"], "virtual")
        self.assertEqual(result["pairs"], 1)
        self.assertLess(result["mean_after_mm"], result["mean_before_mm"])
        without = ["constant", "profile", "profile_smoothed", "profile_in_view", "photographs"]
        rivals = [*without, "paper_pass", "incise_uncalibrated", "hybrid", "learned", "robust"]
        self.assertEqual([row["cut"] for row in result["table_2"]],
                         ["planned", "planned", "corrected", *rivals, "planned", "corrected"])
        self.assertEqual([row["advice"] is None for row in result["table_2"]], [True] + 14 * [False])
        self.assertEqual([row["kind"] for row in result["table_2"]], 13 * [None] + ["stiff", "stiff"])
        self.assertEqual(list(result["rivals"]), ["as_planned", *rivals[:7], "incise", "hybrid", "learned", "robust"])
        self.assertIn(result["best_without_simulation"], without)
        best = result["rivals"][result["best_without_simulation"]]
        self.assertEqual(best["mean_mm"], min(result["rivals"][name]["mean_mm"] for name in without))
        self.assertAlmostEqual(result["rivals"]["incise"]["difference_mm"], result["mean_after_mm"] - best["mean_mm"], delta=1e-12)
        for name in without:
            folder = self.folder / "study" / "S2" / name
            self.assertFalse((folder / "as_planned").exists() or (folder / "corrected").exists(), "nothing is simulated")
        # The paper's single pass is cut as well, unless its own simulation comes too near the tumour.
        refused = result["table_2"][8]["ended_at"]
        self.assertEqual(result["paper_pass"]["pairs"], 1 if refused is None else 0)
        if refused is None:
            self.assertEqual(result["paper_pass"]["mean_before_mm"], result["mean_before_mm"])
        else:
            self.assertIn("paper_pass_export: not acceptable (refused: ", refused)
            self.assertFalse((self.folder / "study" / "S2" / "paper_pass_cut.script").exists())
        self.advice_is_held_against_the_truth(result)
        advice, stiff = result["assessments"]
        # Four times as stiff as what was calibrated on: the bias says less of it.
        self.assertGreater(stiff["p_worse"], advice["p_worse"])
        self.assertIn(advice["advice"], ("compensate", "cut_as_planned", "do_not_use"))
        self.assertEqual({entry["name"] for entry in advice["distances"]},
                         {"registration_rmse_mm", "registration_scale", "youngs_modulus_kpa", "compliance_mm_n"})
        self.assertAlmostEqual(advice["gain_mm"], result["mean_before_mm"] - result["mean_after_mm"], delta=1e-12)
        page = (self.folder / "study" / "report.html").read_text()
        self.assertIn("Virtual specimens, cut by a computed bench", page)
        for name in ("table_2.csv", "commands.sh", "study.json", "manifest.json"):
            self.assertTrue((self.folder / "study" / name).is_file(), name)

        self.planners_commands_know_nothing_of_the_truth(result)
        steps = self.times_of("S*/**/manifest.json")
        self.assertGreater(len(steps), 10)
        again = self.json_of(*SMALL)
        self.assertEqual(again["table_2"], result["table_2"])
        self.assertEqual(self.times_of("S*/**/manifest.json"), steps, "nothing was left to do")

        # Damaged answers, in form and in what they say, and damaged products, a file and one of a folder's: the steps are
        # run again, and come to the same.
        registered = self.folder / "study" / "S1" / "cache" / "register.bin"
        said = registered.read_bytes()
        self.assertIn(b'"rmse_mm":', said)
        registered.write_bytes(said.replace(b'"rmse_mm":', b'"rmse_mm":1', 1))
        pictures = sorted((self.folder / "study" / "S2" / "lab" / "ct").iterdir())
        pictures[0].unlink()
        record.write_bytes(b"incise.cache/1")
        program = self.folder / "study" / "S2" / "planned_cut.script"
        whole = program.read_bytes()
        program.write_bytes(whole[:100])
        mended = self.json_of(*SMALL)
        self.assertEqual(mended["table_2"], result["table_2"])
        self.assertEqual(program.read_bytes(), whole)
        self.assertTrue(pictures[0].is_file())
        self.assertNotIn(b'"rmse_mm":1' + said.split(b'"rmse_mm":')[1][:8], registered.read_bytes())
        self.assertGreater(record.stat().st_size, 100)

    def advice_is_held_against_the_truth(self, result):
        held = result["advice"]
        self.assertEqual(held["advised"], 2)
        self.assertEqual(held["skipped"], [])
        for entry in held["specimens"]:
            for cut in ("planned", "corrected"):
                truth = json.loads((self.folder / "study" / "truth" / f"{entry['specimen']}_{cut}" / "cut_truth.json").read_text())
                self.assertEqual(entry[cut]["true_mm"], truth["mean_abs_error_mm"])
            self.assertEqual(entry["is_worse"], entry["corrected"]["true_mm"] > entry["planned"]["true_mm"])
            self.assertIn("p_worse_without_pull", entry)
            truth = json.loads((self.folder / "study" / "truth" / f"{entry['specimen']}_withheld" / "cut_truth.json").read_text())
            self.assertEqual(entry["withheld"]["true_mm"], truth["mean_abs_error_mm"])
        self.assertEqual(held["worse"], sum(entry["is_worse"] for entry in held["specimens"]))
        self.assertEqual(held["auc"] is None, held["worse"] in (0, 2))
        self.assertEqual(held["close_margin"]["cuts"], 4)
        self.assertTrue((self.folder / "study" / "advice" / "reliability.svg").is_file())

    def planners_commands_know_nothing_of_the_truth(self, result):
        """Only the bench's commands name the truth's folder, and the others give the same without it."""
        truth = self.folder / "study" / "truth"
        lines = [shlex.split(line)[1:] for line in pathlib.Path(self.folder, result["commands"]).read_text().splitlines() if line.startswith("incise ")]
        planners = [line for line in lines if line[0] != "bench"]
        self.assertGreater(len(planners), 10)
        for line in planners:
            self.assertFalse([word for word in line if "truth" in word], line)
        truth.rename(self.folder / "elsewhere")
        planned = [line for line in planners if line[0] == "plan"][0]
        path = pathlib.Path(self.folder, planned[-1], "plan", "path.json")
        before = path.read_bytes()
        subprocess.run(["rm", "-r", path.parents[1]], check=True)
        self.json_of(*planned)
        self.assertEqual(path.read_bytes(), before)
        (self.folder / "elsewhere").rename(truth)


if __name__ == "__main__":
    unittest.main()
