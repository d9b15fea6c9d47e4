"""One verdict wherever a cut is shown, and no robot program against it."""

import json
import unittest

import small_case
from command import BAD_CASE, BAD_DATA, DONE, NOT_ACCEPTABLE, CommandTest, SharedStart


def ids(verdict, severity=None):
    return [reason["id"] for reason in verdict["reasons"] if severity in (None, reason["severity"])]


class VerdictTest(SharedStart, CommandTest):
    def write(self, changes=small_case.SOUND):
        """Writes a case that corrects by one pass, the fewest cuts, unless `changes` name another method."""
        case = small_case.write_case(self.folder / "case", small_case.merged({"compensation": {"method": "paper"}}, changes))
        small_case.write_tumor_surface(case / "tumor.stl")
        return case

    def begin_with_a_run(self):
        """The sound case and a run of it whose cautions are accepted. Returns what it printed."""
        self.write()
        return self.begin("run", "case", "-o", self.out, *small_case.ACCEPTED)[0]

    def read(self, name):
        return json.loads((self.out / name).read_text())

    def run_case(self, *options, status):
        return self.json_of("run", "case", "-o", self.out, *options, status=status)

    def assert_no_program(self):
        self.assertFalse((self.out / "program").exists())

    def test_every_face_shows_the_same_verdict(self):
        verdict = self.begin_with_a_run()["verdict"]
        self.assertEqual(verdict["status"], "caution")
        self.assertEqual(self.read("study.json")["verdict"], verdict)
        self.assertEqual(self.read("manifest.json")["verdict"], verdict)
        self.assertEqual(self.read("program/manifest.json")["verdict"], verdict)
        in_path = self.read("program/path.json")["verdict"]
        self.assertEqual({key: in_path[key] for key in verdict}, verdict)
        report = (self.out / "report.html").read_text()
        self.assertIn("<strong>Caution</strong>", report)
        self.assertLess(report.index("<strong>Caution</strong>"), report.index("class=\"numbers\""), "before any number")
        for reason in verdict["reasons"]:
            self.assertIn(reason["message"].split(":")[0], report)
        shown = self.incise("run", "case", "-o", self.out, *small_case.ACCEPTED).stdout
        for reason in verdict["reasons"]:
            self.assertIn(f"{reason['severity']}: {reason['id']}: {reason['message']}", shown)
        script = (self.out / "program" / "program.script").read_text()
        self.assertIn("# incise.verdict: caution\n", script)
        for caution in set(ids(verdict)):
            self.assertIn(f"# incise.accepted: {caution}\n", script)

    def test_each_caution_needs_its_own_accept(self):
        self.write()
        found = self.run_case(*small_case.ACCEPTED[:-2], status=NOT_ACCEPTABLE)
        self.assertEqual(found["program"]["gate"]["missing"], ["convergence"])
        self.assert_no_program()
        self.run_case(*small_case.ACCEPTED, status=DONE)
        self.assertTrue((self.out / "program" / "program.script").is_file())
        self.run_case(status=NOT_ACCEPTABLE)
        self.assert_no_program()  # an older one does not outlive the refusal

    def test_no_program_for_a_cut_that_its_own_simulation_sees_near_the_tumour(self):
        self.write({**small_case.SOUND, "plan": {"lateral_margin_mm": 9}})  # the close margin of 2.2 mm
        found = self.run_case(*small_case.ACCEPTED, status=NOT_ACCEPTABLE)
        self.assertEqual(found["outcome"], "success", "the paper's success does not look at the tumour's surface")
        self.assertEqual(found["verdict"]["status"], "refused")
        self.assertEqual(found["verdict"]["reasons"][0]["id"], "tumor_distance")
        self.assertEqual(found["verdict"]["reasons"][0]["limit"], 2.2)
        self.assert_no_program()
        self.assertIn("<strong>Refused</strong>", (self.out / "report.html").read_text())
        nobody = self.incise("run", "case", "-o", self.out, "--accept", "tumor_distance")
        self.assert_refused(nobody, BAD_CASE, "--accept", "'tumor_distance'", "nobody can accept")

    def test_the_margin_is_judged_where_the_case_expects_its_cut(self):
        def margins(compensation, status, close_margin_mm=0.2):
            self.write({"plan": {**small_case.SOUND["plan"], "close_margin_mm": close_margin_mm}, "compensation": {"method": "default", **compensation}})
            verdict = self.json_of("simulate", "case", "-o", self.out, status=status)["verdict"]
            return [r for r in verdict["reasons"] if r["id"] in ("lateral_margin", "simulated_margin")]

        self.assertEqual(margins({}, DONE), [], "the simulated cut leaves 0.4 mm")
        nearer = margins({"residual_mm": [-0.5]}, NOT_ACCEPTABLE)[0]
        self.assertEqual((nearer["id"], nearer["severity"], nearer["limit"]), ("lateral_margin", "refused", 0.2))
        self.assertIn("with the errors that compensation expects of real cuts", nearer["message"])
        self.assertEqual(margins({"residual_mm": [-0.5], "bias_mm": 0.5}, DONE), [], "the two cancel")
        self.assertEqual(margins({}, NOT_ACCEPTABLE, close_margin_mm=2.2)[0]["id"], "lateral_margin")
        farther = margins({"residual_mm": [3.0]}, DONE, close_margin_mm=2.2)[0]
        self.assertEqual((farther["id"], farther["severity"]), ("simulated_margin", "caution"))
        self.assertAlmostEqual(farther["value"], nearer["value"] + 0.5, delta=1e-6)

    def test_a_contour_that_was_shifted_flipped_or_is_of_another_unit_than_the_surface(self):
        for change, expected in ((lambda p: (p[0], p[1] + 8.0, p[2]), "contour_surface"), (lambda p: (-p[0], -p[1], p[2]), "contour_flipped")):
            with self.subTest(expected):
                case = self.write()
                small_case.write_contour(case / "tumor.csv", [change(p) for p in small_case.ring()])
                done = self.incise("run", "case", "-o", self.folder / expected, *small_case.ACCEPTED, "--json")
                self.assertIn(f"refused: {expected}: ", done.stderr)
                self.assertFalse((self.folder / expected / "program").exists())
                self.assertIn(done.returncode, (BAD_CASE, NOT_ACCEPTABLE))  # 2: the flipped edge lies beside the tissue
        case = self.write()
        small_case.write_tumor_surface(case / "tumor.stl", scale=1e-3)  # metres
        done = self.incise("run", "case", "-o", self.out, *small_case.ACCEPTED)
        self.assert_refused(done, BAD_CASE, "tumor.surface", "2 to 100 mm", "Lengths are in mm")

    def test_a_typed_transform_of_a_real_body_is_a_caution(self):
        self.begin_with_a_run()
        self.write({**small_case.SOUND, "specimen_is": "real"})
        found = self.run_case(*small_case.ACCEPTED, status=NOT_ACCEPTABLE)
        self.assertEqual(found["program"]["gate"]["missing"], ["typed_transform"])
        self.run_case(*small_case.ACCEPTED, "--accept", "typed_transform", status=DONE)

    def test_export_goes_by_the_verdict_of_the_path_and_notices_a_changed_one(self):
        self.begin_with_a_run()
        path = self.out / "program" / "path.json"
        script = self.folder / "cut.script"
        refused = self.json_of("export", path, "-o", script, status=NOT_ACCEPTABLE)
        self.assertEqual(refused["gate"]["missing"], ids(refused["verdict"]))
        self.assertFalse(script.exists())
        self.json_of("export", path, "-o", script, *small_case.ACCEPTED)
        self.assertIn("# incise.accepted: convergence\n", script.read_text())
        document = json.loads(path.read_text())
        document["waypoints"][3]["depth_mm"] += 0.1
        (self.folder / "edited.json").write_text(json.dumps(document))
        edited = self.json_of("export", "edited.json", "-o", self.folder / "edited.script", *small_case.ACCEPTED, status=NOT_ACCEPTABLE)
        self.assertEqual(edited["gate"]["missing"], ["not_simulated"])
        document["verdict"] = {"status": "ok", "reasons": [], "digest_sha256": "0" * 64}
        (self.folder / "forged.json").write_text(json.dumps(document))
        forged = self.json_of("export", "forged.json", "-o", self.folder / "forged.script", *small_case.ACCEPTED, status=NOT_ACCEPTABLE)
        self.assertEqual(forged["gate"]["missing"], ["not_simulated"])
        document["verdict"] = {"status": "ok", "reasons": [{"id": "depth"}]}
        (self.folder / "broken.json").write_text(json.dumps(document))
        self.assert_refused(self.incise("export", "broken.json", "-o", self.folder / "broken.script"), BAD_DATA, "broken.json", "/reasons/0")

    def test_a_stored_plan_that_was_edited_is_not_the_one_that_was_cut(self):
        small_case.write_case(self.folder / "case")
        self.incise("run", "case", "-o", "out")
        file = self.folder / "out" / "plan" / "path.json"
        sound = file.read_text()
        path = json.loads(sound)
        for waypoint in path["waypoints"]:
            waypoint["depth_mm"] = 5.4
        file.write_text(json.dumps(path))
        self.assert_refused(self.incise("run", "case", "-o", "out"), BAD_DATA, "plan/path.json", "changed since")
        file.write_text(sound)
        again = self.json_of("run", "case", "-o", "out", status=NOT_ACCEPTABLE)
        self.assertEqual({stage["state"] for stage in again["stages"]} - {"skipped"}, {"reused"})

    def test_what_was_changed_in_a_stored_result_is_refused(self):
        self.begin_with_a_run()

        def moved(text):
            path = json.loads(text)
            path.pop("verdict", None)  # a run that was refused has taken it away
            for waypoint in path["waypoints"]:
                waypoint["position_mm"][0] += 1.0
            return json.dumps(path)

        def far(text):
            cut = json.loads(text)
            cut["deep_margin_mm"]["nearest"] = 9.0
            return json.dumps(cut)

        for name, change in (("plan/path.json", moved), ("correction/path.json", moved), ("as_planned/incision.json", far),
                             ("stretched/deformed.vtu", lambda text: text + "\n"), ("corrected/inner_edge.csv", None),
                             ("as_planned/centerline_4mm.csv", None), ("as_planned/added.csv", lambda _: "x\n")):
            with self.subTest(name):
                file = self.out / name
                sound = file.read_text() if file.exists() else None
                if change is None:
                    file.unlink()
                else:
                    file.write_text(change(sound))
                done = self.incise("run", "case", "-o", self.out, *small_case.ACCEPTED)
                self.assert_refused(done, BAD_DATA, name, f"Remove the folder {self.out / name.split('/')[0]}")
                if sound is None:
                    file.unlink()
                else:
                    file.write_text(sound)
        again = self.run_case(*small_case.ACCEPTED, status=DONE)
        self.assertEqual({stage["state"] for stage in again["stages"]} - {"skipped"}, {"reused"})

    def test_a_cut_goes_on_along_no_other_path(self):
        self.write()
        self.json_of("simulate", "case", "-o", self.out)
        plan = self.out / "plan" / "path.json"
        path = json.loads(plan.read_text())
        path.pop("verdict")  # as an interrupted run leaves it
        path["waypoints"][2]["depth_mm"] += 0.4
        plan.write_text(json.dumps(path))
        self.assert_refused(self.incise("simulate", "case", "-o", self.out), BAD_DATA, "plan/path.json", "changed since")

    def test_a_mark_is_no_simulated_cut(self):
        self.begin_with_a_run()
        path = self.read("program/path.json")
        path.pop("verdict")
        path["kind"] = "mark"
        (self.folder / "mark.json").write_text(json.dumps(path))
        found = self.json_of("export", "mark.json", "--kind", "incise", "-o", "mark.script", status=NOT_ACCEPTABLE)
        self.assertEqual(found["gate"]["missing"], ["not_simulated"])
        self.assertFalse((self.folder / "mark.script").exists())

    def test_a_refused_path_stays_refused_when_it_is_touched(self):
        self.write({**small_case.SOUND, "plan": {"lateral_margin_mm": 9}})
        self.run_case(*small_case.ACCEPTED, status=NOT_ACCEPTABLE)
        path = self.read("plan/path.json")
        self.assertEqual(path["verdict"]["status"], "refused")
        path["frame"] = "robot"
        path["waypoints"][0]["speed_mm_s"] += 1e-9
        (self.folder / "touched.json").write_text(json.dumps(path))
        found = self.json_of("export", "touched.json", "--accept", "not_simulated", "-o", "touched.script", status=NOT_ACCEPTABLE)
        self.assertIn("tumor_distance", found["gate"]["refused"])

    def test_a_rejected_correction_is_known_in_both_paths(self):
        self.assertFalse(self.begin_with_a_run()["accepted"])
        for name in ("plan", "correction"):
            self.assertIn("not_corrected", ids(self.read(f"{name}/path.json")["verdict"]), name)

    def test_a_program_of_other_settings_goes(self):
        self.begin_with_a_run()
        self.assertTrue((self.out / "program" / "program.script").is_file())
        self.write(small_case.merged(small_case.SOUND, {"plan": {"close_margin_mm": 2.2}}))
        done = self.incise("simulate", "case", "-o", self.out, status=NOT_ACCEPTABLE)
        self.assertIn("program: removed, because the settings, the inputs or their places, or the version have changed", done.stderr)
        self.assert_no_program()
        self.assertFalse((self.out / "correction").exists(), "it was judged by another margin")

    def test_a_verdict_of_other_limits_does_not_stay_beside_a_path(self):
        self.begin_with_a_run()
        strict = small_case.merged(small_case.SOUND, {"plan": {"lateral_margin_mm": 9, "close_margin_mm": 2.2}})
        for changes in (strict, small_case.SOUND):
            self.write(changes)
            self.incise("run", "case", "-o", self.out, *small_case.ACCEPTED)
        self.write(strict)
        self.assertEqual(self.incise("plan", "case", "-o", self.out).returncode, DONE)
        self.assertNotIn("verdict", self.read("plan/path.json"))
        self.assertNotIn("verdict", self.read("study.json"), "that of another run")
        self.incise("run", "case", "-o", self.out, *small_case.ACCEPTED)
        self.assertEqual(self.read("plan/path.json")["verdict"]["status"], "refused")

    def test_a_line_through_the_tumour_is_refused(self):
        changes = {"plan": {"kind": "line", "line": "line.csv", "lateral_margin_mm": None}, "tumor": {"surface": None}}
        case = self.write(changes)
        small_case.write_contour(case / "line.csv", [(8.0 + 2.0 * n, 20.0, small_case.BLOCK_MM[2]) for n in range(13)])
        found = self.run_case(*small_case.ACCEPTED, "--accept", "depth", "--accept", "heat", status=NOT_ACCEPTABLE)
        self.assertIn("lateral_margin", found["program"]["gate"]["refused"])
        self.assertLess(found["verdict"]["reasons"][0]["value"], 0.0)
        self.assert_no_program()

    def test_an_advice_against_the_simulation_stands_against_the_path_as_planned(self):
        self.begin_with_a_run()
        (self.out / "assessment").mkdir()
        (self.out / "assessment" / "assess.json").write_text(json.dumps({"advice": "do_not_use", "reasons": ["unlike the calibration's"]}))
        found = self.run_case(*small_case.ACCEPTED, status=NOT_ACCEPTABLE)
        self.assertEqual(found["program"]["gate"]["missing"], ["eligibility"])
        self.assertIn("eligibility", ids(self.read("plan/path.json")["verdict"]))

    def test_a_tool_shorter_than_its_needle_and_a_place_out_of_reach_are_told_first(self):
        for robot, words in (({"T_flange_tool": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}, ("robot.T_flange_tool", "needle")),
                             ({"T_robot_sim": [[0, 1, 0, 1e6], [-1, 0, 0, 20], [0, 0, 1, 200], [0, 0, 0, 1]]}, ("robot.T_robot_sim", "10000 mm"))):
            self.write(small_case.merged(small_case.SOUND, {"robot": robot}))
            done = self.incise("run", "case", "-o", self.out)
            self.assert_refused(done, BAD_CASE, *words)
            self.assertFalse(self.out.exists())

    def test_accept_names_a_caution(self):
        self.write()
        for verb, where in (("run", "case"), ("export", "path.json")):
            done = self.incise(verb, where, "-o", self.out, "--accept", "dept")
            self.assert_refused(done, BAD_CASE, "--accept", "'dept'", "Did you mean 'depth'?")

    def test_simulate_and_compensate_show_it_too(self):
        self.write()
        cut = self.json_of("simulate", "case", "-o", self.out)
        self.assertEqual(cut["verdict"], self.read("as_planned/incision.json")["verdict"])
        planned = self.read("plan/path.json")["verdict"]
        self.assertEqual(planned["reasons"], cut["verdict"]["reasons"])
        again = self.json_of("simulate", "case", "-o", self.out)
        self.assertEqual(again["verdict"], cut["verdict"], "read back from the folder")

    def test_simulate_of_a_cut_that_is_refused_ends_with_status_4(self):
        self.write({"plan": {"close_margin_mm": 4.9}})
        cut = self.json_of("simulate", "case", "-o", self.out, status=NOT_ACCEPTABLE)
        self.assertEqual((cut["outcome"], cut["verdict"]["status"]), ("success", "refused"))


if __name__ == "__main__":
    unittest.main()
