"""Bad input: one clear message, the right exit status, and no output."""

import json
import math
import os
import pathlib
import struct
import unittest

import small_case
import small_dicom
import small_photo
from command import BAD_CASE, BAD_DATA, DONE, INTERRUPTED, NOT_ACCEPTABLE, CommandTest, HandMadePaths, files_below


class CtTest(CommandTest):
    def segment(self, volume):
        return self.incise("segment", volume, "-o", self.folder / "out.nrrd")

    def assert_segment_refused(self, volume, *says):
        self.assert_refused(self.segment(volume), BAD_DATA, *says)
        self.assert_nothing_written(self.folder / "out.nrrd")

    def test_a_regular_series_is_read_without_complaint(self):
        done = self.segment(small_dicom.write_series(self.folder / "ct", small_dicom.regular()))
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assertTrue((self.folder / "out.nrrd").is_file())

    def test_a_missing_file_is_named(self):
        self.assert_segment_refused("nowhere.nrrd", "nowhere.nrrd", "no such file", "expected a volume")

    def test_a_truncated_dicom_file_is_named_with_the_byte_where_it_ends(self):
        ct = small_dicom.write_series(self.folder / "ct", small_dicom.regular())
        broken = ct / "IM0003.dcm"
        broken.write_bytes(broken.read_bytes()[:700])
        self.assert_segment_refused("ct", "IM0003.dcm", "byte 700", "end of the file", "expected a complete DICOM file")

    def test_text_in_place_of_nrrd_is_told(self):
        (self.folder / "ct.nrrd").write_text("This is a letter, not a volume.\n")
        self.assert_segment_refused("ct.nrrd", "ct.nrrd", "header", "expected a header")

    def write_blocks(self, spacing_mm, blocks, size=(24, 24, 24), more="", name="ct.nrrd", voxel="h", air=-1000, tissue=50):
        """An NRRD with the vectors of `spacing_mm` as directions; `blocks` are boxes of tissue, first and last index along each axis."""
        x, y, z = size
        numbers = [air] * (x * y * z)
        for first, last in blocks:
            for k in range(first[2], last[2] + 1):
                for j in range(first[1], last[1] + 1):
                    for i in range(first[0], last[0] + 1):
                        numbers[i + x * (j + y * k)] = tissue
        directions = " ".join("(" + ",".join(str(step) if row == axis else "0" for row in range(3)) + ")" for axis, step in enumerate(spacing_mm))
        kind = {"h": "short", "B": "uchar"}[voxel]
        header = f"NRRD0004\ntype: {kind}\ndimension: 3\nspace: left-posterior-superior\nsizes: {x} {y} {z}\nspace directions: {directions}\nkinds: domain domain domain\n"
        header += f"endian: little\nencoding: raw\nspace origin: (0,0,0)\n{more}\n"
        (self.folder / name).write_bytes(header.encode() + struct.pack(f"<{len(numbers)}{voxel}", *numbers))

    def test_voxels_of_no_scanner_or_in_other_units_are_refused(self):
        block = [((6, 6, 6), (17, 17, 17))]
        self.write_blocks((1e200, 1, 1), block)
        self.assert_segment_refused("ct.nrrd", "ct.nrrd: space directions: found voxel spacing inf along axis 0", "0.0001 to 100 mm")
        self.write_blocks((0.001, 0.001, 0.001), block, more='space units: "m" "m" "m"\n')
        self.assert_segment_refused("ct.nrrd", "ct.nrrd: space units: found 'm' for axis 0, expected \"mm\"")
        self.write_blocks((0.01, 1, 100), block)
        self.assert_segment_refused("ct.nrrd", "ct.nrrd: spacing: found voxels of 0.01 x 1 x 100 mm", "at most 50 times the shortest")

    def test_two_bodies_of_a_size_are_a_caution(self):
        self.write_blocks((1, 1, 1), [((2, 6, 6), (9, 17, 17)), ((13, 6, 6), (20, 17, 17))])
        done = self.incise("segment", "ct.nrrd", "-o", "out.nrrd", "--json", status=DONE)
        result = json.loads(done.stdout)
        self.assertEqual(result["components"], 2)
        self.assertIn("1152 mm³ round (5.5, 11.5, 11.5) mm, which is kept", done.stderr)
        self.assertIn("1152 mm³ round (16.5, 11.5, 11.5) mm", done.stderr)
        self.assertIn("scan", [reason["id"] for reason in result["verdict"]["reasons"]])
        seeded = self.incise("segment", "ct.nrrd", "-o", "out.nrrd", "--seed-mm", 16, 11, 11, "--json")
        self.assertNotIn("two bodies", seeded.stderr)

    def test_labels_that_no_mesh_can_start_in_are_told_in_one_sentence(self):
        self.write_blocks((0.5, 0.5, 10), [((6, 6, 6), (17, 17, 17))], name="labels.nrrd", voxel="B", air=0, tissue=1)
        done = self.incise("mesh", "labels.nrrd", "-o", "out.vtu")
        self.assert_refused(done, BAD_DATA, "labels.nrrd: mesh sizing: a body of 4.31e+03 mm3 is too small for edges of 4 mm")
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)

    def test_mesh_names_the_formats_that_it_reads(self):
        small_case.write_contour(self.folder / "tumor.csv", small_case.ring())
        done = self.incise("mesh", "tumor.csv", "-o", "out.vtu")
        self.assert_refused(done, BAD_DATA, "tumor.csv: extension: found '.csv', expected labels (.nrrd,", "a closed surface (.ply, .stl, .obj or .vtp)")

    def test_segment_names_the_options_that_pictures_need(self):
        (self.folder / "ct").mkdir()
        for name in ("slice_1.png", "slice_2.png"):
            small_photo.write_png(self.folder / "ct" / name, 4, 4, 1, 8, [bytes(4)] * 4)
        for options, says in (((), "ct: --spacing-mm: found nothing"), (("--spacing-mm", 1, 1, 1), "ct: --hu: found nothing")):
            self.assert_refused(self.incise("segment", "ct", *options, "-o", "out.nrrd"), BAD_CASE, says)

    def test_a_truncated_nrrd_is_told(self):
        (self.folder / "ct.nrrd").write_bytes(
            b"NRRD0004\ntype: short\ndimension: 3\nsizes: 8 8 8\nspace: left-posterior-superior\n"
            b"space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\nencoding: raw\nendian: little\n\n" + b"\0" * 100
        )
        self.assert_segment_refused("ct.nrrd", "ct.nrrd", "expected a complete NRRD file", "cut short")

    def test_a_hole_in_a_series_is_told(self):
        small_dicom.write_series(self.folder / "ct", small_dicom.with_hole())
        self.assert_segment_refused("ct", "missing", "IM0004.dcm", "IM0005.dcm", "expected every slice")

    def test_a_tilted_series_is_resampled_with_a_notice(self):
        done = self.segment(small_dicom.write_series(self.folder / "ct", small_dicom.tilted()))
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assertIn("gantry tilt of 16.7 deg removed by linear resampling", done.stderr)

    def test_an_unevenly_spaced_series_is_resampled_with_a_notice(self):
        done = self.segment(small_dicom.write_series(self.folder / "ct", small_dicom.uneven()))
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assertIn("uneven slice steps of 2 to 3.5 mm removed by linear resampling", done.stderr)

    def assert_irregular_case_refused(self, positions, *says):
        case = self.folder / "case"
        small_dicom.write_series(case / "ct", positions)
        small_case.write_contour(case / "tumor.csv", small_case.ring())
        (case / "case.yaml").write_text(
            "schema: incise.case/1\nct: {volume: ct, irregular_slices: refuse}\ntumor: {contour: tumor.csv}\n"
        )
        self.assert_refused(self.incise("deform", "case", "-o", self.out), BAD_DATA, "case/ct", *says)
        self.assert_nothing_written()

    def test_a_tilted_series_is_refused_where_the_case_says_so(self):
        self.assert_irregular_case_refused(small_dicom.tilted(), "gantry tilt of 16.7 deg", "expected slices that stack straight")

    def test_an_unevenly_spaced_series_is_refused_where_the_case_says_so(self):
        self.assert_irregular_case_refused(small_dicom.uneven(), "uneven slice steps of 2 to 3.5 mm", "at even steps")

    @unittest.skipUnless(os.environ.get("INCISE_DATA_DIR"), "INCISE_DATA_DIR does not name the folder of shared test data")
    def test_a_real_head_with_tilt_and_uneven_steps_is_refused_or_resampled_as_asked(self):
        series = pathlib.Path(os.environ["INCISE_DATA_DIR"]) / "ct" / "ge_head_dicom"
        case = self.folder / "case"
        case.mkdir()
        small_case.write_contour(case / "tumor.csv", small_case.ring())
        (case / "case.yaml").write_text(
            f"schema: incise.case/1\nct: {{volume: {series}, irregular_slices: refuse}}\ntumor: {{contour: tumor.csv}}\n"
        )
        self.assert_refused(self.incise("deform", "case", "-o", self.out), BAD_DATA, "ge_head_dicom", "18.5 deg")
        self.assert_nothing_written()
        done = self.incise("segment", series, "--roi-box-mm", *(-30,) * 3, *(30,) * 3, "-o", self.folder / "out.nrrd", status=DONE)
        self.assertIn("resampling", done.stderr)


class SurfaceTest(CommandTest):
    CORNERS = [(0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0), (0, 0, 10), (10, 0, 10), (10, 10, 10), (0, 10, 10)]
    BOX = [(0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7), (0, 1, 5), (0, 5, 4), (1, 2, 6), (1, 6, 5), (2, 3, 7), (2, 7, 6), (3, 0, 4), (3, 4, 7)]

    def write_stl(self, triangles, corners=CORNERS):
        lines = ["solid box"]
        for triangle in triangles:
            lines += ["facet normal 0 0 0", "outer loop"]
            lines += ["vertex {} {} {}".format(*corners[corner]) for corner in triangle]
            lines += ["endloop", "endfacet"]
        (self.folder / "box.stl").write_text("\n".join([*lines, "endsolid box", ""]))

    def mesh(self):
        return self.incise("mesh", "box.stl", "--coarse-mm", "4", "-o", self.folder / "out.vtu")

    def assert_mesh_refused(self, *says):
        self.assert_refused(self.mesh(), BAD_DATA, "box.stl", *says)
        self.assert_nothing_written(self.folder / "out.vtu")

    def test_a_closed_box_is_meshed(self):
        self.write_stl(self.BOX)
        self.mesh()
        self.assertTrue((self.folder / "out.vtu").is_file())

    def test_a_surface_with_a_hole_is_refused(self):
        self.write_stl(self.BOX[:-1])
        self.assert_mesh_refused("expected a closed")

    def test_a_surface_with_three_triangles_on_an_edge_is_refused(self):
        fin = [*self.CORNERS, (20, 20, 5)]
        self.write_stl([*self.BOX, (0, 1, 8)], fin)
        self.assert_mesh_refused("expected a closed")

    def test_a_number_that_is_none_is_named_with_its_line(self):
        self.write_stl(self.BOX, [(math.nan, 0, 0), *self.CORNERS[1:]])
        self.assert_mesh_refused("line 4", "nan")


class CaseTest(CommandTest):
    """A case that cannot be run: the message names the file and the field; whole stages may stay, nothing half-made does."""

    def setUp(self):
        super().setUp()
        self.case = small_case.write_case(self.folder / "case")

    def change(self, **changes):
        small_case.write_case(self.case, changes)

    def assert_case_refused(self, verb, status, *says, stages=()):
        self.assert_refused(self.incise(verb, "case", "-o", self.out, "--quiet"), status, *says)
        if not stages:
            self.assert_nothing_written()
            return
        made = {name.split("/")[0] for name in files_below(self.out)}
        self.assertEqual(made, {"study.json", "cache", *stages})
        for stage in stages:
            self.assertTrue((self.out / stage / "stage.json").is_file(), f"{stage} is not complete")

    def test_a_missing_case_file_is_named(self):
        self.assert_refused(self.incise("run", "nowhere", "-o", self.out), BAD_DATA, "nowhere", "no such file", "schema case --defaults")
        self.assert_nothing_written()

    def test_a_missing_mesh_is_named_with_the_field_that_asks_for_it(self):
        (self.case / "block.msh").unlink()
        self.assert_case_refused("deform", BAD_DATA, "block.msh", "no such file", "specimen.mesh")

    def test_a_missing_tumor_edge_is_told_before_anything_is_computed(self):
        (self.case / "tumor.csv").unlink()
        self.assert_case_refused("simulate", BAD_DATA, "tumor.csv", "no such file", "tumor.contour")

    def test_an_unknown_key_is_named_with_its_line_and_the_nearest_valid_one(self):
        self.change(plan={"latral_margin_mm": 4})
        self.assert_case_refused("plan", BAD_CASE, "case.yaml line ", "plan.latral_margin_mm", "unknown key", "'lateral_margin_mm'")

    def test_a_negative_modulus_is_refused(self):
        self.change(specimen={"material": {"youngs_modulus_kpa": -70}})
        self.assert_case_refused("deform", BAD_CASE, "case.yaml line ", "specimen.material.youngs_modulus_kpa", "-70", "expected a number in [1e-06, 1000000000]")

    def test_a_case_that_is_not_yaml_is_told(self):
        (self.case / "case.yaml").write_text("schema: [unfinished\n")
        self.assert_case_refused("plan", BAD_DATA, "case.yaml", "line ", "expected YAML or JSON")

    def test_a_nan_in_a_mesh_is_named_with_its_line(self):
        vertices, tets = small_case.block()
        vertices[2] = (math.nan, 0.0, 0.0)
        small_case.write_msh(self.case / "block.msh", vertices, tets)
        self.assert_case_refused("deform", BAD_DATA, "block.msh", "line 8", "nan")

    def test_a_truncated_mesh_is_told(self):
        text = (self.case / "block.msh").read_text()
        (self.case / "block.msh").write_text(text[: len(text) // 2])
        self.assert_case_refused("deform", BAD_DATA, "block.msh", "line ")

    def test_a_tet_turned_inside_out_is_told(self):
        vertices, tets = small_case.block()
        tets[7] = (tets[7][1], tets[7][0], *tets[7][2:])
        small_case.write_msh(self.case / "block.msh", vertices, tets)
        self.assert_case_refused("deform", BAD_DATA, "block.msh", "7")

    def test_a_flat_tet_is_told(self):
        vertices, tets = small_case.block()
        a, b, c, _ = tets[7]
        vertices.append(tuple((vertices[a][i] + vertices[b][i] + vertices[c][i]) / 3 for i in range(3)))
        tets[7] = (a, b, c, len(vertices) - 1)
        small_case.write_msh(self.case / "block.msh", vertices, tets)
        self.assert_case_refused("deform", BAD_DATA, "block.msh", "volume", "7")

    def test_a_tet_that_is_there_twice_is_told(self):
        vertices, tets = small_case.block()
        small_case.write_msh(self.case / "block.msh", vertices, [*tets, tets[7]])
        self.assert_case_refused("deform", BAD_DATA, "block.msh", "repeat the corners", f"tet {len(tets)}")

    def test_a_body_in_two_pieces_is_told(self):
        vertices, tets = small_case.block()
        count = len(vertices)
        more = [(x + 100.0, y, z) for x, y, z in vertices]
        apart = [tuple(corner + count for corner in tet) for tet in tets]
        small_case.write_msh(self.case / "block.msh", [*vertices, *more], [*tets, *apart])
        self.assert_case_refused("deform", BAD_DATA, "block.msh", "2 bodies", f"tet {len(tets)}")

    CLAMP = {"kind": "fixed", "where": {"end": {"direction": "posterior", "within_mm": 5}}}

    def test_a_region_that_holds_nothing_is_told(self):
        self.change(specimen={"constraints": [self.CLAMP, {"kind": "fixed", "where": {"box_mm": [[500, 500, 500], [501, 501, 501]]}}]})
        self.assert_case_refused("deform", BAD_CASE, "case.yaml: specimen.constraints[1].where", "without any vertex")

    def test_a_body_that_can_still_move_as_a_whole_is_told(self):
        self.change(specimen={"constraints": [{"kind": "fixed", "where": {"box_mm": [[-1, -1, -1], [41, 0.5, 0.5]]}}]})
        self.assert_case_refused("deform", BAD_CASE, "case.yaml: specimen.constraints", "1 of the 6 rigid motions")

    def test_constraints_that_contradict_each_other_are_told(self):
        pull = {"kind": "displaced", "where": {"box_mm": [[-1, 50, -1], [41, 61, 20]]}, "displacement_mm": [0, 3, 0]}
        self.change(specimen={"constraints": [self.CLAMP, pull]})
        self.assert_case_refused("deform", BAD_CASE, "case.yaml: specimen.constraints[1].where", "3 mm along y", "specimen.constraints[0]")

    def test_an_incompressible_material_is_refused(self):
        self.change(specimen={"material": {"poissons_ratio": 0.5}})
        self.assert_case_refused("deform", BAD_CASE, "case.yaml line ", "specimen.material.poissons_ratio", "0.5", "[0, 0.5)")

    def test_tissue_that_locks_may_be_stretched_but_not_cut(self):
        self.change(specimen={"material": {"poissons_ratio": 0.499}})
        for verb in ("simulate", "run"):
            self.assert_case_refused(verb, BAD_CASE, "case.yaml: specimen.material.volume: found per_tet with a Poisson's ratio of 0.499", "expected averaged")
        self.assertEqual(self.incise("deform", "case", "-o", self.out, "--quiet").returncode, DONE)

    def test_a_displacement_that_is_no_number_is_refused(self):
        pull = {"kind": "displaced", "where": {"end": {"direction": "anterior", "within_mm": 5}}, "displacement_mm": [0, ".nan", 0]}
        self.change(specimen={"constraints": [self.CLAMP, pull]})
        self.assert_case_refused("deform", BAD_CASE, "case.yaml line ", "specimen.constraints[1].displacement_mm", "number")

    def test_a_material_from_a_mesh_that_carries_none_is_refused(self):
        self.change(specimen={"material": {"from_mesh": True}})
        self.assert_case_refused("deform", BAD_CASE, "case.yaml: specimen.material.from_mesh", "youngs_modulus_kpa")
        self.change(specimen={"material": {"labels": [{"label": 2, "youngs_modulus_kpa": 700}]}})
        self.assert_case_refused("deform", BAD_CASE, "case.yaml: specimen.material.labels", "'label'")

    def test_a_missing_or_damaged_holder_is_named(self):
        self.change(specimen={"constraints": [self.CLAMP, {"kind": "support", "surface": "holder.stl"}]})
        self.assert_case_refused("deform", BAD_DATA, "holder.stl", "no such file", "specimen.constraints[1].surface")
        (self.case / "holder.stl").write_text("solid holder\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n")
        self.assert_case_refused("deform", BAD_DATA, "holder.stl", "line 4")

    def test_a_tumor_is_needed_to_cut_and_not_to_deform(self):
        self.change(tumor=None)
        self.assert_case_refused("plan", BAD_CASE, "case.yaml: tumor.contour")
        self.assertEqual(self.incise("deform", "case", "-o", self.out, "--quiet").returncode, DONE)

    def test_an_export_that_the_format_cannot_hold_is_refused(self):
        self.change(specimen={"material": {"fibre_modulus_kpa": 30}})
        for program in ("sofa", "febio"):
            done = self.incise("interchange", "case", "--format", program, "-o", self.out, "--quiet")
            self.assert_refused(done, BAD_CASE, "case.yaml: specimen.material.fibre_modulus_kpa", "30 kPa")
            self.assert_nothing_written()

    def test_a_tumor_edge_off_the_surface_is_refused(self):
        small_case.write_contour(self.case / "tumor.csv", small_case.ring(z=40.0))
        self.assert_case_refused("plan", BAD_CASE, "tumour edge", "point 0", stages=["stretched"])

    def test_a_tumor_edge_beside_the_tissue_is_refused(self):
        small_case.write_contour(self.case / "tumor.csv", small_case.ring(center=(200.0, 20.0)))
        self.assert_case_refused("plan", BAD_CASE, "tumour edge", stages=["stretched"])

    def test_a_damaged_tumor_edge_is_named_with_its_line(self):
        (self.case / "tumor.csv").write_text("x_mm,y_mm,z_mm\n0,0,14\n1,two,14\n0,2,14\n")
        self.assert_case_refused("plan", BAD_DATA, "tumor.csv", "line 3", "two")
        # Three points of a tumour's edge beside each other are closed, and round nothing.
        (self.case / "tumor.csv").write_text("x_mm,y_mm,z_mm\n20,20,14\n20.5,20.2,14\n20.9,20.8,14\n")
        self.assert_case_refused("run", BAD_DATA, "tumor.csv", "a tumour", "2 to 100 mm")

    def test_a_ring_that_leaves_the_tissue_is_refused(self):
        small_case.write_contour(self.case / "tumor.csv", small_case.ring(center=(13.0, 20.0)))
        self.assert_case_refused("simulate", BAD_CASE, "a path outside the tissue", stages=["stretched"])

    def test_a_depth_through_the_tissue_is_refused(self):
        self.change(plan={"depth_mm": 20})
        self.assert_case_refused("simulate", BAD_CASE, "depth", "20", stages=["stretched"])

    def test_a_tool_or_a_cut_that_cannot_be_is_refused_with_its_line_before_anything_runs(self):
        for group, field, value, expected in (
            ("tool", "kind", "laser", "expected one of"),
            ("tool", "diameter_mm", 0, "expected a number in [0.05, 10]"),
            ("tool", "length_mm", 0, "expected a number in (0, 200]"),
            ("cut", "speed_mm_s", 0, "expected a number in [0.01, 100]"),
            ("cut", "dullness", 0, "expected a number in (0, 1000]"),
            ("cut", "dullness", -1, "expected a number in (0, 1000]"),
            ("cut", "dullness", ".nan", "expected a number in (0, 1000]"),
            ("cut", "frames", -1, "expected a number in [0, 500]"),
            ("plan", "depth_mm", 0, "expected a number in [0.5, 50]"),
        ):
            with self.subTest(field=field, value=value):
                self.change(**{group: {field: value}})
                self.assert_case_refused("simulate", BAD_CASE, "case.yaml line ", f"{group}.{field}: found ", str(value), expected)

    def test_a_step_longer_than_the_needle_is_thick_is_refused_before_anything_runs(self):
        self.change(cut={"advance_per_step_mm": 1.5})
        self.assert_case_refused("simulate", BAD_CASE, "case.yaml: cut.advance_per_step_mm: found 1.5, expected", "at most the tool's diameter or thickness")

    def test_settings_that_do_not_fit_each_other_are_told_before_anything_runs(self):
        for group, change, words in (("plan", {"power_w": 0.0001}, ("plan.power_w: found 0.0001", "600 s")),
                                     ("plan", {"lateral_margin_mm": 0.5}, ("plan.lateral_margin_mm: found 0.5 mm", "more than the electrode's radius")),
                                     ("specimen", {"mesh": "block.msh", "material": {"fibre_modulus_kpa": 1e300}}, ("fibre_modulus_kpa: found 1e+300", "1000000000"))):
            with self.subTest(change=change):
                self.change(**{group: change})
                self.assert_case_refused("simulate", BAD_CASE, *words)

    def test_an_overlap_that_goes_round_the_ring_again_is_refused(self):
        self.change(cut={"overlap_mm": 50}, plan={"lateral_margin_mm": 1})
        self.assert_case_refused("simulate", BAD_CASE, "case.yaml: cut.overlap_mm: found 50 mm", "less than the ", "round the ring",
                                 stages=("stretched", "plan"))

    SURFACE_MM = 11.7  # of the stretched block

    def give_path(self, points, frame="sim_stretched", **more):
        (self.case / "path.json").write_text(json.dumps(small_case.path(points, frame, **more)))
        self.change(path="path.json")

    def assert_path_refused(self, status, *says, stages=("stretched", "plan"), z=SURFACE_MM, **waypoint):
        self.give_path(small_case.ring(radius=10.0, z=z, corners=24), waypoint=waypoint)
        self.assert_case_refused("simulate", status, *says, stages=stages)

    def test_a_given_path_above_the_surface_is_refused(self):
        self.assert_path_refused(BAD_CASE, "path: waypoints", "waypoint 0", "above the surface", "expected at most 2 mm", z=25.0)

    def test_a_given_path_through_the_platform_is_refused(self):
        self.assert_path_refused(BAD_CASE, "path: depth_mm", "13 mm at waypoint 0", "mm thick", "come out beneath", depth_mm=13)

    def test_a_given_path_without_depth_is_refused(self):
        self.assert_path_refused(BAD_CASE, "path: depth_mm", "0 mm at waypoint 0", "above 0 mm", depth_mm=0)

    def test_a_given_path_whose_tool_points_upwards_is_refused(self):
        self.assert_path_refused(BAD_CASE, "waypoint 0", "points out of the tissue", axis=[0, 0, 1])

    def test_a_given_path_with_numbers_that_cannot_be_is_named_with_its_place(self):
        self.assert_path_refused(BAD_DATA, "path.json", "/waypoints/0/speed_mm_s", "found 0", stages=(), speed_mm_s=0)
        self.assert_path_refused(BAD_DATA, "path.json", "/waypoints/0/axis", "length 2", stages=(), axis=[0, 0, -2])

    def test_a_given_path_outside_the_tissue_is_refused(self):
        self.give_path(small_case.ring(center=(300.0, 20.0), radius=10.0, corners=24))
        self.assert_case_refused("simulate", BAD_CASE, "waypoint 0", stages=["stretched", "plan"])

    def test_a_given_path_in_the_wrong_frame_is_refused(self):
        self.give_path(small_case.ring(), "robot")
        self.assert_case_refused("simulate", BAD_DATA, "path.json", "frame", "robot", "sim_stretched")

    def test_an_open_path_for_a_ring_is_refused_before_anything_runs(self):
        self.give_path(small_case.ring(), closed=False)
        self.assert_case_refused("simulate", BAD_CASE, "an open path", "plan.kind: ring")

    def test_a_count_of_tets_that_is_no_mesh_is_refused(self):
        self.change(meshing={"tets": 50})
        self.assert_case_refused("plan", BAD_CASE, "meshing.tets", "50", "at least 100")

    def test_a_folder_of_somebody_else_is_never_replaced(self):
        precious = self.folder / "mydata"
        precious.mkdir()
        (precious / "thesis.txt").write_text("years of work")
        self.assert_refused(self.incise("phantom", "-o", precious, "--quiet"), BAD_DATA, "mydata", "another origin")
        self.assertEqual((precious / "thesis.txt").read_text(), "years of work")

    def test_a_product_folder_with_the_users_own_files_is_never_replaced(self):
        plan = self.folder / "work" / "plan"
        plan.mkdir(parents=True)
        (plan / "mine.csv").write_text("mine")
        self.incise("plan", "case", "-o", self.folder / "work", "--quiet", status=BAD_DATA)
        self.assertEqual((plan / "mine.csv").read_text(), "mine")

    def test_an_export_with_the_users_own_files_is_never_replaced(self):
        export = ("interchange", "case", "--format", "sofa", "-o", self.out, "--quiet")
        for _ in range(2):  # the second replaces the first
            self.assertEqual(self.incise(*export).returncode, DONE)
        (self.out / "sofa_result.vtu").write_text("an hour of SOFA")
        self.assert_refused(self.incise(*export), BAD_DATA, "'sofa_result.vtu' of another origin")
        self.assertEqual((self.out / "sofa_result.vtu").read_text(), "an hour of SOFA")

    def test_an_interruption_says_that_finished_stages_are_kept(self):
        done = self.interrupted("simulate", "case", "-o", self.out, after="stretch: done")
        self.assertEqual(done.returncode, INTERRUPTED, done.stderr)
        self.assertIn("the finished stages are kept", done.stderr)
        self.assertTrue((self.out / "stretched" / "stage.json").is_file())

    def test_a_damaged_product_says_what_to_remove(self):
        self.assertEqual(self.incise("deform", "case", "-o", self.out, "--quiet").returncode, DONE)
        for name in ("deformed.vtu", "deform.json", "stage.json"):
            with self.subTest(name=name):
                path = self.out / "stretched" / name
                whole = path.read_text()
                path.write_text("{ damaged")
                done = self.incise("deform", "case", "-o", self.out, "--quiet")
                self.assert_refused(done, BAD_DATA, name, f"Remove the folder {self.out / 'stretched'}")
                path.write_text(whole)

    def test_a_damaged_entry_of_the_cache_is_computed_again(self):
        self.assertEqual(self.incise("deform", "case", "-o", self.out, "--quiet").returncode, DONE)
        entry = self.out / "cache" / "stretched.bin"
        data, whole = entry.read_bytes(), (self.out / "stretched" / "deformed.vtu").read_bytes()
        for damaged in (data[:-1], data[:500] + bytes([data[500] ^ 1]) + data[501:], b""):
            entry.write_bytes(damaged)
            done = self.incise("deform", "case", "-o", self.out, status=DONE)
            self.assertIn("stretched.bin: byte", done.stderr)
            self.assertIn("It is computed again", done.stderr)
            self.assertEqual((self.out / "stretched" / "deformed.vtu").read_bytes(), whole)

    def test_a_mesh_that_is_turned_over_as_a_whole_is_told(self):
        vertices, tets = small_case.block()
        small_case.write_msh(self.case / "block.msh", vertices, [(a, b, d, c) for a, b, c, d in tets])
        for verb in (("deform", "case"), ("interchange", "case", "--format", "febio")):
            with self.subTest(verb=verb[0]):
                done = self.incise(*verb, "-o", self.folder / verb[0], status=DONE)
                self.assertIn("block.msh: every tet has a negative volume; all are turned over", done.stderr)

    def test_a_device_is_not_replaced_by_a_file(self):
        self.assert_refused(self.incise("schema", "case", "-o", "/dev/full"), BAD_DATA, "/dev/full", "a device")
        self.assertTrue(pathlib.Path("/dev/full").is_char_device())

    def test_numbers_that_are_not_finite_are_refused_on_the_command_line(self):
        for word in ("nan", "inf", "-inf"):
            with self.subTest(word=word):
                done = self.incise("evaluate", "--incision", "a.csv", "--tumor", "b.csv", "--target-mm", word)
                self.assert_refused(done, BAD_CASE, word, "a finite number")

    def test_an_output_below_a_file_cannot_be_written(self):
        (self.folder / "occupied").write_text("a file")
        for output in ("occupied", "occupied/out"):
            with self.subTest(output=output):
                self.assert_refused(self.incise("run", "case", "-o", output), BAD_DATA, output, "expected a folder that can be written")
        self.assertEqual((self.folder / "occupied").read_text(), "a file")


class ExportTest(HandMadePaths, CommandTest):
    """A ring of 20 mm across, 5 mm outside its tumour edge, under the robot."""

    def write_path(self, frame="robot", x=600.0, edge_mm=5.0, **changes):
        path = small_case.path(small_case.ring(center=(x, 0.0), radius=10.0, z=200.0, corners=48), frame, schema="incise.path/1",
                               tumor_edge=small_case.ring(center=(x, 0.0), radius=edge_mm, z=200.0), **changes)
        (self.folder / "path.json").write_text(json.dumps(path))

    def export(self, *options):
        return self.incise("export", "path.json", "-o", self.folder / "out.script", *options)

    def test_a_path_that_passes_the_checks_becomes_a_program(self):
        self.write_path()
        result = self.json_of("export", "path.json", "-o", self.folder / "out.script")
        self.assertTrue(all(check["passed"] for check in result["checks"]))
        self.assertIn("def ", (self.folder / "out.script").read_text())

    def test_the_checks_of_a_program_are_shown_as_a_table(self):
        self.write_path()
        said = self.export().stdout
        self.assertRegex(said, r"(?m)^check +found +limit +unit +passed$")
        self.assertRegex(said, r"(?m)^finite +yes +yes +yes$")
        self.assertRegex(said, r"(?m)^speed_max +\S+ +<= 30 +mm/s +yes$")

    def test_a_path_in_another_frame_is_refused(self):
        for frame in ("sim_rest", "sim_stretched"):
            with self.subTest(frame=frame):
                self.write_path(frame)
                self.assert_refused(self.export(), BAD_DATA, "path.json", "frame", frame, "expected robot")
                self.assert_nothing_written(self.folder / "out.script")

    def assert_unsafe(self, done, name):
        self.assertEqual(done.returncode, NOT_ACCEPTABLE, done.stderr)
        self.assertIn(f"no program: refused: program_check: {name}", done.stderr)
        self.assert_nothing_written(self.folder / "out.script")

    def test_a_depth_other_than_planned_is_not_exported(self):
        self.write_path()
        self.assert_unsafe(self.export("--depth-mm", "9"), "depth")

    def test_a_path_through_the_tumor_is_not_exported(self):
        self.write_path(edge_mm=9.0)
        self.assert_unsafe(self.export(), "margin")

    def test_a_path_beyond_the_arm_is_not_exported(self):
        self.write_path(x=2600.0)
        self.assert_unsafe(self.export(), "reach")

    def test_an_unknown_key_of_a_path_is_named(self):
        self.write_path(frme="robot")
        self.assert_refused(self.export(), BAD_DATA, "path.json", "frme", "frame")
        self.assert_nothing_written(self.folder / "out.script")


class EvaluateTest(CommandTest):
    def assert_evaluate_refused(self, text, *says):
        small_case.write_contour(self.folder / "good.csv", small_case.ring())
        (self.folder / "bad.csv").write_text("x_mm,y_mm,z_mm\n" + text)
        for incision, tumor in (("bad.csv", "good.csv"), ("good.csv", "bad.csv")):
            with self.subTest(incision=incision):
                done = self.incise("evaluate", "--incision", incision, "--tumor", tumor, "-o", "out.json")
                self.assert_refused(done, BAD_DATA, "bad.csv", *says)
                self.assert_nothing_written(self.folder / "out.json")

    def test_contours_of_two_points_are_refused(self):
        self.assert_evaluate_refused("0,0,0\n1,0,0\n", "2 points", "expected at least 3")

    def test_numbers_that_are_none_are_refused(self):
        self.assert_evaluate_refused("0,0,0\n1,nan,0\n1,1,0\n", "line 3", "y_mm", "nan")

    def test_a_header_without_the_columns_is_refused(self):
        (self.folder / "bad.csv").write_text("a,b,c\n1,2,3\n")
        done = self.incise("evaluate", "--incision", "bad.csv", "--tumor", "bad.csv")
        self.assert_refused(done, BAD_DATA, "bad.csv", "line 1", "x_mm")

    def test_a_tumor_edge_without_area_is_refused(self):
        small_case.write_contour(self.folder / "good.csv", small_case.ring())
        small_case.write_contour(self.folder / "flat.csv", [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (2.0, 0.0, 0.0)])
        done = self.incise("evaluate", "--incision", "good.csv", "--tumor", "flat.csv", "-o", "out.json")
        self.assert_refused(done, BAD_DATA, "flat.csv", "no area")
        self.assert_nothing_written(self.folder / "out.json")

    def test_an_edge_of_another_state_of_the_tissue_is_doubted(self):
        cut = small_case.ring(radius=small_case.TUMOR_RADIUS_MM + 5.0, z=10.0)
        small_case.write_contour(self.folder / "cut.csv", cut)
        for height, doubts in ((11.0, []), (13.0, ["3.0 mm below", "plan/tumor_edge.csv"])):
            with self.subTest(height=height):
                small_case.write_contour(self.folder / "edge.csv", small_case.ring(z=height))
                done = self.incise("evaluate", "--incision", "cut.csv", "--tumor", "edge.csv", "-o", "out.json")
                warnings = json.loads((self.folder / "out.json").read_text())["warnings"]
                self.assertEqual(len(warnings), 1 if doubts else 0)
                for doubt in doubts:
                    self.assertIn(doubt, warnings[0])
                    self.assertIn(doubt, done.stderr)

    def test_settings_out_of_range_are_the_command_lines_fault(self):
        small_case.write_contour(self.folder / "good.csv", small_case.ring())
        done = self.incise("evaluate", "--incision", "good.csv", "--tumor", "good.csv", "--approach", "0", "0", "0")
        self.assert_refused(done, BAD_CASE, "--approach")
        # Lengths whose square is 0 or infinite.
        for length in ("1e-300", "1e300"):
            done = self.incise("evaluate", "--incision", "good.csv", "--tumor", "good.csv", "--approach", "0", "0", length)
            self.assert_refused(done, BAD_CASE, f"--approach: found 0 0 {float(length):g}", "a direction")

    def test_numbers_of_options_are_refused_in_the_words_of_all_errors(self):
        small_case.write_contour(self.folder / "good.csv", small_case.ring())
        contours = ("--incision", "good.csv", "--tumor", "good.csv")
        for words, says in (
            (("evaluate", "photo.png", "--mm-per-pixel", "-1"), "command line: --mm-per-pixel: found -1, expected a number above 0"),
            (("evaluate", "photo.png", "--mm-per-pixel", "wide"), "--mm-per-pixel: found 'wide', expected a number above 0"),
            (("evaluate", *contours, "--close-margin-mm", "-1"), "command line: --close-margin-mm: found -1, expected a number above 0"),
            (("compare", "--before", "a", "b", "--after", "c", "d", "--alpha", "2"), "command line: --alpha: found 2, expected a number in (0, 1)"),
            (("audit", "t.csv", "--n-at-least", "1"), "command line: --n-at-least: found 1, expected a whole number from 2 to"),
            (("audit", "t.csv", "--n-at-least", "1e3"), "--n-at-least: found 1e3, expected a whole number from 2 to"),
            (("audit", "t.csv", "--n-at-least", "2.5"), "--n-at-least: found 2.5, expected a whole number from 2 to"),
            (("audit", "t.csv", "--n-at-least", "010"), "--n-at-least: found 010, expected a whole number from 2 to"),
            (("audit", "t.csv", "--n-at-least", "few"), "--n-at-least: found 'few', expected a whole number from 2 to"),
            (("audit", "t.csv", "--grain", "-1"), "--grain: found -1, expected a number of at least 0"),
            (("audit", "t.csv", "--grain", "abc"), "--grain: found 'abc', expected a number of at least 0"),
            (("audit", "t.csv", "--least", "nan"), "command line: --least: found nan, expected a finite number"),
            (("evaluate", "photo.png", "--mm-per-pixel", "nan"), "command line: --mm-per-pixel: found nan, expected a finite number"),
        ):
            with self.subTest(words=words):
                done = self.incise(*words)
                self.assert_refused(done, BAD_CASE, says)
                self.assertEqual(done.stderr.count("expected"), 1, done.stderr)

    def test_contours_that_cross_themselves_are_refused_with_their_place(self):
        small_case.write_contour(self.folder / "good.csv", small_case.ring())
        eight = [(10 + 8 * math.sin(t), 4 * math.sin(2 * t), 0.0) for t in (2 * math.pi * (k + 12.5) / 100 for k in range(100))]
        small_case.write_contour(self.folder / "eight.csv", eight)
        (self.folder / "eight.mrk.json").write_text(json.dumps({"markups": [{
            "type": "ClosedCurve", "coordinateSystem": "LPS", "coordinateUnits": "mm",
            "controlPoints": [{"position": list(p)} for p in eight]}]}))
        lines = "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">" + " ".join(
            f"{c}" for p in eight for c in p) + "</DataArray></Points>"
        ids = " ".join(str(k) for k in range(100)) + " 0"
        (self.folder / "eight.vtp").write_text(
            '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian"><PolyData><Piece NumberOfPoints="100" NumberOfLines="1">'
            + lines + '<Lines><DataArray type="Int64" Name="connectivity" format="ascii">' + ids
            + '</DataArray><DataArray type="Int64" Name="offsets" format="ascii">101</DataArray></Lines></Piece></PolyData></VTKFile>')
        for name in ("eight.csv", "eight.vtp", "eight.mrk.json"):
            for incision, tumor in (("good.csv", name), (name, "good.csv")):
                with self.subTest(incision=incision, tumor=tumor):
                    done = self.incise("evaluate", "--incision", incision, "--tumor", tumor)
                    self.assert_refused(done, BAD_DATA, name, "crosses itself", "10.00, ", "0.00 mm")
        done = self.incise("evaluate", "--incision", "eight.csv", "--open", "--tumor", "good.csv")
        self.assert_refused(done, BAD_DATA, "eight.csv", "crosses itself")

    def test_a_tumor_of_another_scale_is_refused_as_in_photographs(self):
        for across, limit in ((200.0, "2 to 100 mm"), (101.0, "2 to 100 mm"), (1.9, "2 to 100 mm")):
            with self.subTest(across=across):
                ring = lambda r: [(r * math.cos(2 * math.pi * k / 80), r * math.sin(2 * math.pi * k / 80), 0.0) for k in range(80)]
                small_case.write_contour(self.folder / "tumor.csv", ring(0.5 * across))
                small_case.write_contour(self.folder / "cut.csv", ring(min(0.5 * across + 5.0, 100.0)))
                done = self.incise("evaluate", "--incision", "cut.csv", "--tumor", "tumor.csv")
                self.assert_refused(done, BAD_DATA, "tumor.csv", "a tumour", "mm across", limit)

    def test_an_open_cut_is_measured_against_its_line(self):
        small_case.write_contour(self.folder / "line.csv", [(float(x), 0.0, 0.0) for x in range(31)])
        small_case.write_contour(self.folder / "cut.csv", [(float(x), 0.4, 0.0) for x in range(31)])
        result = self.json_of("evaluate", "--incision", "cut.csv", "--line", "line.csv")
        self.assertEqual(result["outcome"], "success")
        self.assertIsNone(result["closed_loop"])
        self.assertAlmostEqual(result["signed_error_mm"]["mean"], 0.4, places=9)
        self.assertAlmostEqual(result["coverage"], 1.0, places=9)
        small_case.write_contour(self.folder / "short.csv", [(float(x), 0.4, 0.0) for x in range(25)])
        result = self.json_of("evaluate", "--incision", "short.csv", "--line", "line.csv", status=NOT_ACCEPTABLE)
        self.assertEqual(result["outcome"], "open_loop")
        self.assertAlmostEqual(result["end_gap_mm"], 6.0, places=9)
        done = self.incise("evaluate", "--incision", "cut.csv", "--line", "line.csv", "--tumor", "line.csv")
        self.assert_refused(done, BAD_CASE, "--line and --tumor")


class CommandLineTest(CommandTest):
    def assert_misuse(self, *arguments, says):
        done = self.incise(*arguments, status=BAD_CASE)
        self.assertEqual(done.stdout, "")
        self.assertIn(says, done.stderr)
        self.assertEqual(files_below(self.folder), [])

    def test_an_unknown_verb_is_named_with_the_nearest_one(self):
        self.assert_misuse("simulte", "case", says="'simulte'")
        self.assert_misuse("simulte", "case", says="'simulate'")

    def test_an_unknown_option_is_named(self):
        self.assert_misuse("plan", "case", "--frobnicate", says="--frobnicate")

    def test_no_verb_at_all_is_told(self):
        done = self.incise()
        self.assertEqual((done.returncode, done.stdout, done.stderr), (BAD_CASE, self.incise("--help").stdout, ""))
        self.assert_misuse("nonsense", says="incise: command line: verb: found 'nonsense', expected one of bench, demo, run,")
        self.assert_misuse("bench", says="incise: command line: incise bench: found nothing, expected one of make, cut")

    def test_whatever_is_wrong_is_told_in_the_words_of_all_errors(self):
        for words, says in (
            ("plan case --threads -3", "--threads: found -3, expected a whole number from 0 to 1024, in digits"),
            ("run case --isa sse", "--isa: found 'sse', expected one of portable, avx2, avx512"),
            ("run case --frames 0", "--frames: found 0, expected a whole number from 1 to 500, in digits"),
            ("run case --frames many", "--frames: found 'many', expected a whole number from 1 to 500, in digits"),
            ("run case --frames", "--frames: found no value, expected 1 value"),
            ("simulate case --checkpoint-s -1", "--checkpoint-s: found -1, expected a number from 0 to 86400"),
            ("export p.json --tcp 1 2", "--tcp: found 2 values, expected 6 values"),
            ("run", "case: found nothing, expected case file, or a folder with case.yaml"),
            ("run case other", "incise run: found 'other', expected no further argument"),
            ("run case --frame 3", "incise run: found '--frame', expected one of its options. Did you mean '--frames'?"),
            ("run case --bogus", "incise run: found '--bogus', expected one of its options. See `incise run --help`"),
            ("bench cat", "incise bench: found 'cat', expected one of make, cut"),
        ):
            with self.subTest(words=words):
                done = self.incise(*words.split())
                # What a range or a number's form says needs no further help.
                further = () if says.endswith("in digits") else ("See `incise", "--help`")
                self.assert_refused(done, BAD_CASE, "incise: command line: " + says, *further)
                self.assertEqual(done.stderr.count("expected"), 1, done.stderr)

    def test_a_seed_is_a_whole_number_and_never_cut_down(self):
        for seed in ("-1", "2.5", "1000000000000001", "99999999999999999999999"):
            with self.subTest(seed=seed):
                done = self.incise("experiment", "--seed", seed)
                self.assert_refused(done, BAD_CASE, f"incise: command line: --seed: found {seed}, expected a whole number from 0 to 1000000000000000")

    def test_a_verb_that_writes_a_file_asks_where(self):
        self.assert_misuse("segment", "ct", says="-o: found nothing")

    def test_segment_judges_its_output_before_it_reads(self):
        done = self.incise("segment", "nowhere.nrrd", "-o", "labels.vtk")
        self.assert_refused(done, BAD_DATA, "labels.vtk", "extension", "expected .nrrd")

    def test_a_fine_length_above_the_coarse_one_is_told(self):
        self.assert_misuse("mesh", "box.stl", "--around", "cut.csv", "--fine-mm", "5", "--coarse-mm", "3", "-o", "out.vtu", says="--fine-mm")

    def test_a_fine_length_without_a_cut_to_be_fine_around_is_told(self):
        self.assert_misuse("mesh", "box.stl", "--fine-mm", "2", "-o", "out.vtu", says="--fine-mm: found no --around")

    def test_a_count_that_no_mesh_has_is_told(self):
        self.assert_misuse("mesh", "box.stl", "--tets", "99", "-o", "out.vtu", says="--tets: found 99, expected 0, or at least 100")

    def test_a_mesh_under_the_name_of_another_kind_of_file_is_refused(self):
        self.assert_misuse("mesh", "box.stl", "-o", "out.xyz", says="expected a file that ends in .vtu")


if __name__ == "__main__":
    unittest.main()
