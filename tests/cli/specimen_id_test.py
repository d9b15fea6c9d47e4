"""Which specimen a file is of: the id travels with every result, and files of two specimens are not taken for those of one."""

import hashlib
import json
import unittest

import small_calibration
import small_case
from command import BAD_CASE, BAD_DATA, DONE, NOT_ACCEPTABLE, CommandTest, files_below
from keys_test import NRRD, voxels
from robot_test import ring
from sealed_json import sealed

OWN, OTHER = "tongue-07", "tongue-08"
SIMILAR = {"T_target_source": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], "scale": 1.0, "rmse_mm": 0.3, "inlier_fraction": 0.9,
           "converged": True, "outcome": "converged"}


class SpecimenIdTest(CommandTest):
    def case(self, name="case", **changes):
        folder = small_case.write_case(self.folder / name, small_case.merged(small_case.SOUND, changes))
        small_case.write_tumor_surface(folder / "tumor.stl")
        return folder

    def write(self, name, document):
        (self.folder / name).write_text(json.dumps(document))
        return name

    def path(self, specimen_id=OWN, **changes):
        return self.write("path.json", {**ring(), "specimen_id": specimen_id, **changes})

    def registration(self, specimen_id=OTHER, **changes):
        return self.write("registration.json", sealed({**SIMILAR, "specimen_id": specimen_id, **changes}))

    def assert_other_specimen(self, done, file):
        self.assert_refused(done, BAD_DATA, file, f"specimen_id: found {OTHER}", f"specimen, {OWN}")

    def test_every_file_of_a_run_carries_it(self):
        self.assertEqual(self.json_of("run", self.case(specimen_id=OWN), "-o", self.out, *small_case.ACCEPTED)["specimen_id"], OWN)
        files = {name for name in files_below(self.out) if (self.out / name).is_file()}
        listed = set()
        for name in sorted(files):
            if not name.endswith("manifest.json"):
                continue
            manifest = json.loads((self.out / name).read_text())
            self.assertEqual(manifest.get("specimen_id"), OWN, name)
            folder = name.removesuffix("manifest.json")
            listed |= {name} | {folder + file for file in manifest.get("files", [])}
        self.assertEqual({name for name in files - listed if not name.startswith(("figures/", "cache/"))}, {"study.json", "report.html"}, "files that no manifest lists")
        self.assertEqual(json.loads((self.out / "study.json").read_text())["specimen_id"], OWN)
        self.assertIn(OWN, (self.out / "report.html").read_text())
        paths = [name for name in files if name.endswith("path.json")]
        self.assertGreaterEqual(len(paths), 2)
        for name in paths:
            self.assertEqual(json.loads((self.out / name).read_text())["specimen_id"], OWN, name)
        self.assertIn(f"# incise.specimen_id: {OWN}\n", (self.out / "program" / "program.script").read_text())
        self.assertIn(OWN, (self.out / "program" / "program.json").read_text())
        replayed = self.incise("replay", self.out / "program" / "program.script", "-o", "replay", "--json")
        self.assertIs(json.loads(replayed.stdout)["program_audit"]["checked"], True)

    def test_without_a_name_it_follows_from_the_data_wherever_they_lie(self):
        ids = set()
        for name in ("one", "two"):
            self.case(name)
            self.json_of("surface", name, "-o", f"{name}.ply")
            ids.add(self.json_of("surface", f"{name}.ply", "--spacing-mm", "2", "-o", f"{name}_again.ply")["specimen_id"])
        digest = hashlib.sha256((self.folder / "one" / "block.msh").read_bytes()).hexdigest()
        self.assertEqual(ids, {f"mesh-{digest[:12]}"})
        self.assert_refused(self.incise("surface", self.case("bad", specimen_id="tongue 7"), "-o", "bad.ply"), BAD_CASE, "specimen_id", "'tongue 7'")

    def test_labels_and_mesh_of_a_scan_hand_it_on(self):
        (self.folder / "ct.nrrd").write_bytes((NRRD + "\n").encode() + voxels())
        scan = f"ct-{hashlib.sha256((self.folder / 'ct.nrrd').read_bytes()).hexdigest()[:12]}"
        (self.folder / "case").mkdir()
        self.json_of("segment", "ct.nrrd", "-o", "labels.nrrd")
        done = self.incise("mesh", "labels.nrrd", "--coarse-mm", "6", "-o", "case/block.vtu")
        self.assertIn(done.returncode, (DONE, NOT_ACCEPTABLE), done.stderr)
        for manifest in ("labels.nrrd.manifest.json", "case/block.vtu.manifest.json"):
            self.assertEqual(json.loads((self.folder / manifest).read_text())["specimen_id"], scan, manifest)
        small_case.write_case(self.folder / "case", {"specimen": {"mesh": "block.vtu"}})
        self.assertEqual(self.json_of("surface", "case", "-o", "tissue.ply")["specimen_id"], scan)
        (self.folder / "case" / "block.vtu").write_text((self.folder / "case" / "block.vtu").read_text() + "\n")
        self.assertTrue(self.json_of("surface", "case", "-o", "tissue.ply")["specimen_id"].startswith("mesh-"), "the manifest is of another file")
        (self.folder / "labels.nrrd.manifest.json").write_text("{}")
        self.assert_refused(self.incise("segment", "ct.nrrd", "-o", "labels.nrrd"), BAD_DATA, "labels.nrrd.manifest.json", "another origin")

    def test_a_program_is_made_for_the_case_of_its_specimen(self):
        path = self.path()
        self.case("other", specimen_id=OTHER)
        done = self.incise("export", path, "--case", "other", "-o", "cut.script")
        self.assert_refused(done, BAD_DATA, "path.json", f"specimen_id: found {OWN}", f"case.yaml's specimen, {OTHER}")
        case = self.case("own", specimen_id=OWN, cut={"overlap_mm": 4.0})
        self.json_of("export", path, "--case", "own", "--accept", "not_simulated", "-o", "cut.script")
        digest = hashlib.sha256((case / "case.yaml").read_bytes()).hexdigest()
        script = (self.folder / "cut.script").read_text()
        for line in ("incise.case: case.yaml", f"incise.case_sha256: {digest}", "incise.overlap_mm: 4"):
            self.assertIn(f"# {line}\n", script)
        # The cut of this case is open; the mark of its tumour's edge is a ring.
        self.case("line", specimen_id=OWN, plan={"kind": "line"})
        edge = ring()["waypoints"]
        mark = self.path(kind="mark", waypoints=[{**point, "depth_mm": 1.0, "speed_mm_s": 2.0} for point in edge],
                         tumor_edge=[point["position_mm"] for point in edge])
        made = self.json_of("export", mark, "--case", "line", "-o", "mark.script")
        self.assertIn("closed", {check["name"] for check in made["checks"]})

    def test_a_case_that_is_given_another_id_plans_anew(self):
        case = self.case("case", specimen_id=OWN)
        self.incise("run", case, "-o", self.out)
        self.case("case", specimen_id=OTHER)
        self.incise("run", case, "-o", self.out)
        for name in ("plan/path.json", "correction/path.json", "program/path.json", "manifest.json", "corrected/manifest.json"):
            if (self.out / name).exists():
                self.assertEqual(json.loads((self.out / name).read_text())["specimen_id"], OTHER, name)

    def test_register_takes_it_from_its_clouds_and_no_two(self):
        for name, specimen_id in (("own", OWN), ("other", OTHER)):
            self.json_of("surface", self.case(name, specimen_id=specimen_id), "-o", f"{name}.ply")
        found = self.incise("register", "--source", "own.ply", "--target", "own.ply", "--from-identity", "--json", "-o", "registration")
        self.assertEqual(json.loads(found.stdout)["specimen_id"], OWN)
        self.assert_refused(self.incise("register", "--source", "own.ply", "--target", "other.ply", "--from-identity", "-o", "mixed"), BAD_DATA, "other.ply", OTHER, OWN)

    def test_export_refuses_another_specimens_registration_and_surface(self):
        self.assert_other_specimen(self.incise("export", self.path(), "--registration", self.registration(), "-o", "cut.script"), "registration.json")
        self.json_of("surface", self.case(specimen_id=OTHER), "-o", "tissue.ply")
        self.assert_other_specimen(self.incise("export", self.path(), "--surface", "tissue.ply", "-o", "cut.script"), "tissue.ply")
        self.assert_nothing_written(self.folder / "cut.script")
        self.incise("export", self.path(), "--registration", self.registration(OWN), "--accept", "not_simulated", "-o", "cut.script", status=DONE)
        self.assertIn(f"# incise.specimen_id: {OWN}\n", (self.folder / "cut.script").read_text())

    def test_export_holds_a_registration_to_the_clouds_it_was_made_from(self):
        cloud = self.folder / "cloud.ply"
        cloud.write_text("a cloud")
        clouds = {"source": str(cloud), "source_sha256": hashlib.sha256(cloud.read_bytes()).hexdigest()}
        arguments = ("export", self.path(), "--registration", self.registration(OWN, **clouds), "--accept", "not_simulated", "-o", "cut.script")
        self.assertEqual(self.incise(*arguments).returncode, DONE)
        cloud.write_text("another cloud")
        self.assert_refused(self.incise(*arguments), BAD_DATA, "registration.json", "source_sha256", "cloud.ply", "register again")
        cloud.unlink()
        gone = self.incise(*arguments, status=DONE)
        self.assertIn("not checked: whether", gone.stderr)

    def test_project_and_assess_refuse_another_specimens_registration(self):
        self.json_of("surface", self.case(specimen_id=OWN), "-o", "tissue.ply")
        path = self.path(frame="sim_stretched")
        self.assert_other_specimen(self.incise("project", path, "--transform", self.registration(), "--surface", "tissue.ply", "-o", "laid"), "registration.json")
        small_calibration.write(self.folder / "calibration.json")
        self.assert_other_specimen(self.incise("assess", "case", "--calibration", "calibration.json", "--registration", "registration.json", "-o", self.out), "registration.json")

    def test_calibrate_refuses_another_specimens_cut(self):
        case = self.case(specimen_id=OWN)
        for name, radius in (("cut", 8.6), ("edge", small_case.TUMOR_RADIUS_MM)):
            small_case.write_contour(self.folder / f"{name}.csv", small_case.ring(radius=radius))
        done = self.incise("evaluate", "--incision", "cut.csv", "--tumor", "edge.csv", "--contour", "inner_edge", "--specimen-id", OTHER, "-o", "cut.json")
        self.assertIn(done.returncode, (DONE, NOT_ACCEPTABLE), done.stderr)
        self.assert_other_specimen(self.incise("calibrate", case, "--observed", "cut.json", "-o", self.out), "cut.json")
        for none in ("a b", ""):
            self.assert_refused(self.incise("evaluate", "--incision", "cut.csv", "--tumor", "edge.csv", "--specimen-id", none, "-o", "cut.json"), BAD_CASE,
                                f"--specimen-id: found '{none}', expected 1 to 64 letters")

    def test_evaluate_takes_no_other_id_than_its_files_state(self):
        for name, radius in (("cut", 8.6), ("edge", small_case.TUMOR_RADIUS_MM)):
            small_case.write_contour(self.folder / f"{name}.csv", small_case.ring(radius=radius))
        self.write("cut.csv.manifest.json", {"specimen_id": OWN})
        arguments = ("evaluate", "--incision", "cut.csv", "--tumor", "edge.csv", "--contour", "inner_edge", "--json", "--specimen-id")
        self.assert_refused(self.incise(*arguments, OTHER), BAD_CASE, "--specimen-id", OTHER, OWN)
        self.assertIn(f'"{OWN}"', self.incise(*arguments, OWN).stdout)

    def test_another_programs_manifest_is_none_of_ours(self):
        for name, radius in (("cut", 8.6), ("edge", small_case.TUMOR_RADIUS_MM)):
            small_case.write_contour(self.folder / f"{name}.csv", small_case.ring(radius=radius))
        for text in ("{", "[]", '{"files": 7, "specimen_id": 7}'):
            (self.folder / "manifest.json").write_text(text)
            done = self.incise("evaluate", "--incision", "cut.csv", "--tumor", "edge.csv", "--contour", "inner_edge", "--json")
            self.assertIn(done.returncode, (DONE, NOT_ACCEPTABLE), done.stderr)
            self.assertNotIn("specimen_id", json.loads(done.stdout))

    def test_a_given_path_of_another_specimen_is_refused(self):
        self.path(OTHER, frame="sim_stretched")
        case = self.case(specimen_id=OWN, path=str(self.folder / "path.json"))
        self.assert_refused(self.incise("simulate", case, "-o", self.out), BAD_DATA, "path.json", OTHER, OWN)


if __name__ == "__main__":
    unittest.main()
