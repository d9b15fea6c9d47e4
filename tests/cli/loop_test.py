"""The whole loop on a small block: its files, its summary, resuming, stopping, and the same bits at any thread count."""

import json
import signal
import unittest
from xml.etree import ElementTree

import meshio
import small_case
from command import INTERRUPTED, NOT_ACCEPTABLE, CommandTest, files_below

CUT_FILES = {"incision.json", "centerline.csv", "inner_edge.csv", "frames.pvd", "removed.vtu", "manifest.json",
             "kerf.vtp", "depth.csv", "lag.csv", "centerline_1mm.csv", "centerline_2.5mm.csv", "inner_edge_reference.csv"}
KERF_MEASURES = ("kerf", "live_skin", "layers", "depth_reached_mm", "lag_mm", "drift_mm", "deep_margin_mm")


def states(result):
    return {stage["name"]: stage["state"] for stage in result["stages"]}


class LoopTest(CommandTest):
    def setUp(self):
        super().setUp()
        small_case.write_case(self.folder / "case")

    def read(self, name):
        return json.loads((self.out / name).read_text())

    def test_run_goes_from_mesh_to_report_and_a_second_run_reuses_every_stage(self):
        small_case.write_case(self.folder / "case", small_case.SOUND)
        small_case.write_tumor_surface(self.folder / "case" / "tumor.stl")
        first = self.json_of("run", "case", "-o", self.out, *small_case.ACCEPTED)
        self.assertEqual(first["outcome"], "success")
        self.assertEqual(states(first), {"segment": "skipped", "mesh": "skipped", "stretch": "computed", "plan": "computed",
                                         "simulate": "computed", "compensate": "computed", "verify": "computed"})
        for when, folder in (("before", "as_planned"), ("after", "corrected")):
            self.assertTrue(first[when]["closed_loop"])
            self.assertTrue(first[when]["negative_margin"])
            self.assertTrue(CUT_FILES <= set(files_below(self.out / folder)), files_below(self.out / folder))
        self.assertLess(first["after"]["abs_error_mm"]["mean"], first["before"]["abs_error_mm"]["mean"])
        self.assertTrue(first["program"]["written"])
        for mesh in sorted(self.out.rglob("*.vtu")):  # meshio reads no .vtp
            self.assertGreater(len(meshio.read(mesh).points), 3, mesh)
        frame = meshio.read(self.out / "as_planned" / "frames" / "frame_0001.vtu")
        self.assertIn("displacement_mm", frame.point_data)
        self.assertIn("von_mises_kpa", frame.cell_data)
        self.assertLessEqual(first["correction"]["simulations"], 4)
        self.assertIn("pass by pass", (self.out / "report.html").read_text())
        self.assertIn("</html>", (self.out / "report.html").read_text()[-200:])
        self.assertEqual([name for name in files_below(self.out) if ".tmp" in name or "/." in name], [])

        second = self.json_of("run", "case", "-o", self.out, *small_case.ACCEPTED)
        self.assertEqual({state for name, state in states(second).items() if name not in ("segment", "mesh")}, {"reused"})
        for when in ("before", "after"):
            for measure in ("abs_error_mm", "signed_error_mm", "hu_score", "close_margin", "inner_edge", *KERF_MEASURES):
                self.assertEqual(first[when][measure], second[when][measure], f"{when} {measure}")

        self.check_kerf(first["before"])

        # A report can be drawn anew, and the program's path exported once more.
        self.json_of("report", self.out, "-o", self.folder / "again.html")
        self.json_of("export", self.out / "program" / "path.json", "-o", self.folder / "again.script", *small_case.ACCEPTED)

    def test_a_cut_by_points_is_drawn_as_it_goes_and_has_a_caution(self):
        small_case.write_case(self.folder / "case", {
            **small_case.SOUND, "cut": {"rule": "lattice", "frames": 4, "dullness": 5, "advance_per_step_mm": 0.8},
            "compensation": {"method": "paper"}})
        small_case.write_tumor_surface(self.folder / "case" / "tumor.stl")
        result = self.json_of("run", "case", "-o", self.out, *small_case.ACCEPTED, status=NOT_ACCEPTABLE)
        self.assertIn("cut_rule", json.dumps(result["verdict"]))
        self.assertIn("lattice", (self.out / "report.html").read_text())
        cut = self.out / "as_planned"
        uncut = meshio.read(cut / "frames" / "uncut.vtu")
        steps = uncut.cell_data["gone_step"][0].ravel()
        count = len(steps)
        left = [meshio.read(frame).cell_data["cell"][0].ravel().astype(int) for frame in sorted((cut / "frames").glob("frame_*.vtu"))]
        self.assertEqual(len(left), 4)
        self.assertEqual(list(left[0]), list(range(count)))
        for before, after in zip(left, left[1:]):
            self.assertTrue(set(after) < set(before))
        self.assertEqual(set(left[-1]), {cell for cell in range(count) if steps[cell] < 0})
        removed = meshio.read(cut / "removed.vtu")
        self.assertEqual(len(removed.cells[0].data), count - len(left[-1]))
        times = removed.cell_data["removed_at_s"][0].ravel()
        self.assertTrue(all(a <= b for a, b in zip(times, times[1:])))

    def check_kerf(self, cut):
        """The kerf of the small block: 5 mm deep at 9 mm from a tumour of 3 mm depth, within what a mesh of 3 mm allows."""
        self.assertEqual([layer["depth_mm"] for layer in cut["layers"]], [1, 2.5, 4, 5])
        top = next(layer for layer in cut["layers"] if layer["depth_mm"] == 2.5)
        self.assertTrue(top["closed_loop"])
        self.assertLess(abs(top["signed_error_mm"]["mean"] - cut["signed_error_mm"]["mean"]), 1.0)
        self.assertAlmostEqual(cut["depth_reached_mm"]["planned"], 5.0, delta=1e-6)
        self.assertGreater(cut["depth_reached_mm"]["min"], 2.0)
        self.assertGreater(cut["lag_mm"]["mean"], 0.0)
        self.assertEqual(cut["kerf"]["open_edges"], 0)
        self.assertEqual(cut["live_skin"]["open_edges"], 0)
        margin = cut["deep_margin_mm"]
        self.assertLess(margin["nearest"], 5.0)
        self.assertGreater(margin["floor_below"]["mean"], 0.0)

    def test_a_changed_setting_runs_its_stage_and_those_after_it_again(self):
        self.json_of("plan", "case", "-o", self.out)
        small_case.write_case(self.folder / "case", {"plan": {"waypoints": 32}})
        again = self.json_of("plan", "case", "-o", self.out)
        self.assertEqual(again["waypoints"], 32)
        self.assertEqual(states(again)["plan"], "computed")

    def test_every_manifest_says_how_to_repeat_the_run(self):
        self.json_of("plan", "case", "-o", self.out, "--seed", "5", "--threads", "1")
        for folder in ("stretched", "plan"):
            manifest = self.read(f"{folder}/manifest.json")
            self.assertEqual(manifest["seed"], 5)
            self.assertEqual(manifest["threads"], 1)
            self.assertIn("plan case", manifest["command"])
            self.assertEqual({entry["path"] for entry in manifest["inputs"]}, {"case.yaml", "block.msh", "tumor.csv"})
            self.assertTrue(all(len(entry["sha256"]) == 64 for entry in manifest["inputs"]))
            self.assertEqual(manifest["settings"]["plan.depth_mm"], "5")

    def test_deform_tells_what_the_contract_promises(self):
        result = self.json_of("deform", "case", "-o", self.out)
        self.assertTrue(result["converged"])
        self.assertAlmostEqual(result["max_displacement_mm"], 20.0, delta=1.0)
        for key in ("iterations", "relative_residual", "reaction_mn", "solver", "wall_s"):
            self.assertIn(key, result)
        # Clamp, pull, support: at rest their forces carry the weight.
        self.assertEqual(len(result["reaction_mn"]), 3)
        weight = 1040e-9 * 40 * 60 * 14 * 9810
        sums = [sum(reaction[axis] for reaction in result["reaction_mn"]) for axis in range(3)]
        pull = abs(result["reaction_mn"][1][1])
        for found, expected in zip(sums, (0.0, 0.0, weight)):
            self.assertAlmostEqual(found, expected, delta=1e-4 * pull)
        # At rest and deformed: the same vertices, apart by what both files say.
        rest, deformed = (meshio.read(self.out / "stretched" / name) for name in ("rest.vtu", "deformed.vtu"))
        for mesh in (rest, deformed):
            self.assertEqual(mesh.point_data["displacement_mm"].shape, rest.points.shape)
            self.assertEqual(mesh.cell_data["von_mises_kpa"][0].size, len(rest.cells[0].data))
        apart = deformed.points - rest.points
        self.assertLess(abs(apart - rest.point_data["displacement_mm"]).max(), 1e-12)
        self.assertAlmostEqual(float((apart ** 2).sum(axis=1).max()) ** 0.5, result["max_displacement_mm"], delta=1e-9)

    def test_interchange_writes_the_case_for_two_other_solvers(self):
        for program, name in (("sofa", "case.scn"), ("febio", "case.feb")):
            result = self.json_of("interchange", "case", "--format", program, "-o", self.folder / program)
            self.assertEqual(result["files"], [str(self.folder / program / name)])
            self.assertEqual(files_below(self.folder / program), [name, "manifest.json"])
            root = ElementTree.parse(self.folder / program / name).getroot()
            self.assertEqual(root.tag, "Node" if program == "sofa" else "febio_spec")
        self.assertFalse((self.folder / "case" / "out").exists())

    def test_one_and_two_threads_cut_the_same_tets_at_the_same_times(self):
        removals = []
        for threads in (1, 2):
            out = self.folder / f"out{threads}"
            self.json_of("simulate", "case", "-o", out, "--threads", threads, status=NOT_ACCEPTABLE)  # a coarse block: its verdict is refused
            removals.append(json.loads((out / "as_planned" / "incision.json").read_text())["removals"])
        self.assertGreater(len(removals[0]), 100)
        self.assertEqual(removals[0], removals[1])

    def test_a_cut_that_does_not_succeed_is_a_complete_result_with_status_4(self):
        small_case.write_case(self.folder / "case", {"cut": {"dullness": 900}})  # so blunt that next to nothing goes
        result = self.json_of("simulate", "case", "-o", self.out, status=NOT_ACCEPTABLE)
        self.assertEqual(result["outcome"], "open_loop")
        self.assertFalse(result["closed_loop"])
        self.assertEqual(self.read("as_planned/incision.json")["outcome"], "open_loop")
        self.assertTrue((self.out / "as_planned" / "manifest.json").is_file())
        shown = self.incise("simulate", "case", "-o", self.out, status=NOT_ACCEPTABLE).stdout
        self.assertRegex(shown, r"outcome +open_loop\nring closed +no\nmid-line: mean \|error\|, mm ")
        self.assertRegex(shown, r"verdict +\w+\n")
        self.assertTrue(shown.endswith(f"all numbers: --json, or incision.json in {self.out}/as_planned\n"), shown)
        self.assertLess(len(shown.splitlines()), 40)


class SameBitsTest(CommandTest):
    """A deformation is the same to the last bit however it was run."""

    def deformed(self, out, *options):
        self.json_of("deform", "case", "-o", out, *options)
        return (out / "stretched" / "deformed.vtu").read_bytes()  # positions, displacement_mm and stresses, losslessly

    def test_at_any_thread_count_repeated_and_after_an_interruption(self):
        case = small_case.write_case(self.folder / "case")
        small_case.write_msh(case / "block.msh", *small_case.block(cells=(16, 24, 6)))
        straight = self.deformed(self.folder / "one", "--threads", 1)
        self.assertEqual(self.deformed(self.folder / "two", "--threads", 2), straight)
        self.assertEqual(self.deformed(self.folder / "again", "--threads", 1), straight)

        done = self.stopped(("deform", "case", "-o", str(self.out)), (self.out / "study.json").exists, signal.SIGINT)
        self.assertEqual(done.returncode, INTERRUPTED, done.stderr)
        self.assertFalse((self.out / "stretched").exists())
        self.assertEqual(self.deformed(self.out), straight)


if __name__ == "__main__":
    unittest.main()
