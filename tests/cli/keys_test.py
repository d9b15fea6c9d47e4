"""Results are those of the data: a byte that differs in any file that was opened, and the stage that reads it runs again, or refuses."""

import ctypes
import json
import os
import pathlib
import shutil
import struct
import unittest

import small_case
import small_dicom
import small_photo
from command import BAD_CASE, BAD_DATA, DONE, CommandTest

IN_OPEN, IN_ISDIR = 0x20, 0x40000000
REFUSED = (BAD_CASE, BAD_DATA)
KEYED_BY_ITS_VALUES = "case.yaml"  # a comment in it changes no result


class Opened:
    """The files below a folder that anybody opens, by inotify."""

    def __init__(self, folder):
        self.libc = ctypes.CDLL(None, use_errno=True)
        self.folder, self.events = pathlib.Path(folder), self.libc.inotify_init1(os.O_NONBLOCK | os.O_CLOEXEC)
        if self.events < 0:
            raise OSError(ctypes.get_errno(), "inotify_init1")
        self.watched = {}
        for place in [self.folder, *(path for path in self.folder.rglob("*") if path.is_dir())]:
            self.watched[self.libc.inotify_add_watch(self.events, os.fsencode(place), IN_OPEN)] = place

    def files(self):
        """Those since it was last asked."""
        found = set()
        while True:
            try:
                data = os.read(self.events, 1 << 20)
            except BlockingIOError:
                return sorted(found)
            at = 0
            while at < len(data):
                watch, mask, _, length = struct.unpack_from("iIII", data, at)
                name = os.fsdecode(data[at + 16 : at + 16 + length].rstrip(b"\0"))
                at += 16 + length
                if name and not mask & IN_ISDIR:
                    found.add(str((self.watched[watch] / name).relative_to(self.folder)))

    def close(self):
        os.close(self.events)


def with_another_byte(data):
    """Text with another digit late in it, so that it is still a file of its kind; other bytes with another last bit, in the last quarter."""
    try:
        text = data.decode("ascii")
        at = max(k for k, c in enumerate(text[: 1 + 3 * len(text) // 4]) if c.isdigit())
        return (text[:at] + str((int(text[at]) + 1) % 10) + text[at + 1 :]).encode()
    except (UnicodeDecodeError, ValueError):
        at = 3 * len(data) // 4
        return data[:at] + bytes([data[at] ^ 1]) + data[at + 1 :]


# The small block in a scan, air around it.
SPACING, SIZE, MARGIN = (2.0, 2.0, 4.0), (26, 36, 6), (3, 3, 1)
TOP_MM = 18.0


def is_tissue(i, j, k):
    return all(least <= c < n - least for c, n, least in zip((i, j, k), SIZE, MARGIN))


def voxels():
    columns, rows, slices = SIZE
    return b"".join(struct.pack("<h", 40 if is_tissue(i, j, k) else -1000) for k in range(slices) for j in range(rows) for i in range(columns))


GEOMETRY = "space: left-posterior-superior\nspace directions: (2,0,0) (0,2,0) (0,0,4)\nspace origin: (0,0,0)\n"
NRRD = "NRRD0004\ntype: short\ndimension: 3\nsizes: 26 36 6\nencoding: raw\nendian: little\n" + GEOMETRY
META = "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nCompressedData = False\nTransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 0 0 0\nElementSpacing = 2 2 4\nDimSize = 26 36 6\nElementType = MET_SHORT\n"


def nifti():
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, *SIZE, 1, 1, 1, 1)
    struct.pack_into("<hh", header, 70, 4, 16)
    struct.pack_into("<8f", header, 76, 1, *SPACING, 0, 0, 0, 0)
    struct.pack_into("<fff", header, 108, 352, 1, 0)
    header[123] = 2
    struct.pack_into("<hh", header, 252, 0, 1)
    struct.pack_into("<12f", header, 280, -2, 0, 0, 0, 0, -2, 0, 0, 0, 0, 4, 0)
    header[344:348] = b"n+1\0"
    return bytes(header) + voxels()


def write_labels(case):
    """Tissue as label 2, and one voxel of it, the tumour, as label 5."""
    columns, rows, slices = SIZE
    labels = bytearray(2 * is_tissue(i, j, k) for k in range(slices) for j in range(rows) for i in range(columns))
    labels[columns * (rows * (slices // 2) + rows // 2) + columns // 2] = 5
    (case / "labels.nrrd").write_bytes(NRRD.replace("short", "uchar").encode() + b"\n" + bytes(labels))


def write_dicom(case):
    small_dicom.ROWS, small_dicom.COLUMNS = SIZE[1], SIZE[0]
    series = case / "series"
    series.mkdir()
    size = 2 * SIZE[0] * SIZE[1]
    data = voxels()
    for k in range(SIZE[2]):
        # The pixels are the last element.
        one = small_dicom.slice_bytes((0.0, 0.0, SPACING[2] * k), k)
        (series / f"{k:02}.dcm").write_bytes(one[:-size] + data[k * size : (k + 1) * size])


def write_pictures(case):
    slices = case / "slices"
    slices.mkdir()
    for k in range(SIZE[2]):
        rows = [bytes(140 if is_tissue(i, j, k) else 0 for i in range(SIZE[0])) for j in range(SIZE[1])]
        small_photo.write_png(slices / f"{k:02}.png", SIZE[0], SIZE[1], 1, 8, rows)


CT_FORMATS = {
    "ct.nrrd": lambda case: (case / "ct.nrrd").write_bytes(NRRD.encode() + b"\n" + voxels()),
    "ct.nhdr": lambda case: ((case / "ct.nhdr").write_text(NRRD + "data file: there.raw\n"), (case / "there.raw").write_bytes(voxels())),
    "ct.mha": lambda case: (case / "ct.mha").write_bytes(META.encode() + b"ElementDataFile = LOCAL\n" + voxels()),
    "ct.mhd": lambda case: ((case / "ct.mhd").write_text(META + "ElementDataFile = there.raw\n"), (case / "there.raw").write_bytes(voxels())),
    "ct.nii": lambda case: (case / "ct.nii").write_bytes(nifti()),
    "series": write_dicom,
    "slices": write_pictures,
}


def write_tetgen(case):
    vertices, tets = small_case.block(cells=(6, 9, 2))
    (case / "block.node").write_text(f"{len(vertices)} 3 0 0\n" + "".join(f"{n} {x!r} {y!r} {z!r}\n" for n, (x, y, z) in enumerate(vertices)))
    (case / "block.ele").write_text(f"{len(tets)} 4 1\n" + "".join(f"{n} {' '.join(map(str, t))} 7\n" for n, t in enumerate(tets)))


def write_vtu(case):
    """With the stiffness of each tet."""
    vertices, tets = small_case.block(cells=(6, 9, 2))

    def array(kind, name, numbers, components=1):
        return f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="ascii">{" ".join(map(repr, numbers))}</DataArray>\n'

    (case / "block.vtu").write_text(
        f'<VTKFile type="UnstructuredGrid" byte_order="LittleEndian"><UnstructuredGrid><Piece NumberOfPoints="{len(vertices)}" NumberOfCells="{len(tets)}">\n'
        f'<Points>{array("Float64", "p", [c for v in vertices for c in v], 3)}</Points><Cells>{array("Int64", "connectivity", [c for t in tets for c in t])}'
        f'{array("Int64", "offsets", range(4, 4 * len(tets) + 4, 4))}{array("UInt8", "types", [10] * len(tets))}</Cells>'
        f'<CellData>{array("Float64", "youngs_modulus_kpa", [70.5 + 0.01 * n for n in range(len(tets))])}</CellData></Piece></UnstructuredGrid></VTKFile>\n')


def write_vtk(case):
    vertices, tets = small_case.block(cells=(6, 9, 2))
    (case / "block.vtk").write_text("# vtk DataFile Version 3.0\na\nASCII\nDATASET UNSTRUCTURED_GRID\n" + f"POINTS {len(vertices)} double\n"
                                    + "".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in vertices) + f"CELLS {len(tets)} {5 * len(tets)}\n"
                                    + "".join(f"4 {' '.join(map(str, t))}\n" for t in tets) + f"CELL_TYPES {len(tets)}\n" + "10\n" * len(tets))


MESHES = {
    "block.msh": lambda case: small_case.write_msh(case / "block.msh", *small_case.block(cells=(6, 9, 2))),
    "block.node": write_tetgen,
    "block.vtu": write_vtu,
    "block.vtk": write_vtk,
}

CLAMP = {"kind": "fixed", "where": {"box_mm": [-1, 48, -1, 41, 61, 15]}}


def write_platform(path):
    """Two triangles below the block."""
    corners = [(-40.0, -40.0, 0.0), (80.0, -40.0, 0.0), (80.0, 120.0, 0.0), (-40.0, 120.0, 0.0)]
    facets = "".join("facet normal 0 0 1\nouter loop\n" + "".join("vertex %r %r %r\n" % corners[n] for n in t) + "endloop\nendfacet\n" for t in ((0, 1, 2), (0, 2, 3)))
    path.write_text(f"solid platform\n{facets}endsolid platform\n")


class KeysTest(CommandTest):
    VERB = "deform"

    def run_case(self, verb, out):
        """@returns status, and the states of the stages"""
        done = self.incise(verb, "case", "-o", out, "--json")
        self.assertNotIn("internal error", done.stderr)
        stages = json.loads(done.stdout)["stages"] if done.stdout else []
        return done, {stage["name"]: stage["state"] for stage in stages}

    def assert_every_file_counts(self, case, verb, accepted=(DONE,)):
        """Runs, runs again untouched, and then with another byte in each file that was opened. @returns the files"""
        opened = Opened(case)
        self.addCleanup(opened.close)
        first = self.folder / "first"
        done, _ = self.run_case(verb, first)
        self.assertIn(done.returncode, accepted, done.stderr)
        files = [name for name in opened.files() if name != KEYED_BY_ITS_VALUES]
        again, states = self.run_case(verb, first)
        self.assertIn(again.returncode, accepted, again.stderr)
        self.assertEqual({state for state in states.values() if state != "skipped"}, {"reused"}, states)
        for name in files:
            with self.subTest(file=name):
                shutil.copytree(first, self.out)
                sound = (case / name).read_bytes()
                (case / name).write_bytes(with_another_byte(sound))
                changed, states = self.run_case(verb, self.out)
                (case / name).write_bytes(sound)
                shutil.rmtree(self.out)
                self.assertTrue("computed" in states.values() or changed.returncode in REFUSED, f"{states} {changed.returncode} {changed.stderr}")
        return files


class ScanTest(KeysTest):
    def write_scan(self, ct):
        case = small_case.write_case(self.folder / "case", {
            "specimen": {"mesh": None}, "meshing": {"fine_mm": 4, "coarse_mm": 8, "survey_mm": 8}, "ct": ct})
        small_case.write_contour(case / "tumor.csv", small_case.ring(center=(26.0, 26.0), z=TOP_MM))
        (case / "block.msh").unlink()
        return case

    def check(self, name, *parts):
        case = self.write_scan({"volume": name, **({"spacing_mm": SPACING, "hu": [1, -100]} if name == "slices" else {})})
        CT_FORMATS[name](case)
        self.assertEqual(set(self.assert_every_file_counts(case, "deform")), {"tumor.csv", *parts})

    def test_nrrd(self):
        self.check("ct.nrrd", "ct.nrrd")

    def test_labels_in_place_of_thresholds(self):
        case = self.write_scan({"labels": "labels.nrrd", "volume": "ct.nrrd", "window_hu": [1000, 2000]})
        write_labels(case)
        CT_FORMATS["ct.nrrd"](case)
        self.assertEqual(set(self.assert_every_file_counts(case, "deform")), {"tumor.csv", "labels.nrrd", "ct.nrrd"})
        found = json.loads((self.folder / "first" / "labels" / "segment.json").read_text())
        self.assertIsNone(found["tissue_hu"])
        self.assertEqual(found["components"], 1)
        case = self.write_scan({"labels": "labels.nrrd"})
        self.incise("deform", "case", "-o", self.folder / "alone", status=DONE)
        self.assertEqual(json.loads((self.folder / "alone" / "labels" / "segment.json").read_text())["voxels"], found["voxels"])

    def test_detached_nrrd(self):
        self.check("ct.nhdr", "ct.nhdr", "there.raw")

    def test_meta_image(self):
        self.check("ct.mha", "ct.mha")

    def test_meta_image_with_its_data_beside_it(self):
        self.check("ct.mhd", "ct.mhd", "there.raw")

    def test_nifti(self):
        self.check("ct.nii", "ct.nii")

    def test_dicom(self):
        self.check("series", *(f"series/{k:02}.dcm" for k in range(SIZE[2])))

    def test_pictures(self):
        self.check("slices", *(f"slices/{k:02}.png" for k in range(SIZE[2])))


class MeshTest(KeysTest):
    def check(self, name, *parts):
        case = small_case.write_case(self.folder / "case", {"specimen": {"mesh": name, "material": {"from_mesh": name == "block.vtu"}}})
        (case / "block.msh").unlink()
        MESHES[name](case)
        self.assertTrue(set(parts) <= set(self.assert_every_file_counts(case, "plan")))

    def test_gmsh(self):
        self.check("block.msh", "block.msh")

    def test_tetgen(self):
        self.check("block.node", "block.node", "block.ele")

    def test_vtk_xml_with_stiffness(self):
        self.check("block.vtu", "block.vtu")

    def test_legacy_vtk(self):
        self.check("block.vtk", "block.vtk")

    def test_a_holder(self):
        case = small_case.write_case(self.folder / "case", {"specimen": {"constraints": [CLAMP, {"kind": "support", "surface": "platform.stl"}]}})
        MESHES["block.msh"](case)
        write_platform(case / "platform.stl")
        self.assertIn("platform.stl", self.assert_every_file_counts(case, "plan"))


class TumorTest(KeysTest):
    def test_edge_in_each_form(self):
        points = small_case.ring()
        case = small_case.write_case(self.folder / "case")
        MESHES["block.msh"](case)
        small_case.write_tumor_surface(case / "tumor.stl")
        (case / "tumor.mrk.json").write_text(json.dumps({"markups": [{"type": "ClosedCurve", "coordinateSystem": "LPS", "controlPoints": [{"position": p} for p in points]}]}))
        for edge in ("tumor.csv", "tumor.mrk.json"):
            with self.subTest(edge=edge):
                (case / "case.yaml").write_text(json.dumps(small_case.merged(small_case.CASE, {"tumor": {"contour": edge}})))
                self.assertEqual(self.assert_every_file_counts(case, "plan"), sorted(["block.msh", edge]))
                shutil.rmtree(self.folder / "first")


if __name__ == "__main__":
    unittest.main()
