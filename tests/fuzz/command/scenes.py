"""Sound inputs of the command, and the command that reads them."""

import dataclasses
import json
import math
import pathlib
import random
import struct
import subprocess
import sys
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "cli"))
import small_calibration  # noqa: E402
import small_case  # noqa: E402
import small_dicom  # noqa: E402
import small_photo  # noqa: E402
from small_photo import GREEN, RED  # noqa: E402


@dataclasses.dataclass
class Scene:
    """One command on inputs in a folder; `damaged` says which of them may be damaged."""

    name: str
    arguments: tuple
    damaged: tuple
    weight: int = 4       # share of the cases: less where one takes long
    keeps: bool = False   # the output is a folder in which stages that were done before the refusal stay


CORNERS = [(0.0, 0.0, 0.0), (9.0, 0.0, 0.0), (0.0, 9.0, 0.0), (0.0, 0.0, 9.0), (9.0, 9.0, 9.0)]
IDENTITY = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]


def voxels(size=12):
    """Hounsfield units: a warm block in air."""
    inside = lambda *place: all(3 <= c < size - 3 for c in place)
    return b"".join(struct.pack("<h", 40 if inside(i, j, k) else -1000) for k in range(size) for j in range(size) for i in range(size))


def labels(size=12):
    return bytes(voxels(size)[2 * n + 1] == 0 for n in range(size**3))


NRRD = "NRRD0004\ntype: {kind}\ndimension: 3\nspace: left-posterior-superior\nsizes: 12 12 12\nspace directions: (2,0,0) (0,2,0) (0,0,2)\nencoding: {encoding}\nendian: little\nspace origin: (0,0,0)\n"
META = "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nCompressedData = {packed}\nTransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 0 0 0\nElementSpacing = 2 2 2\nDimSize = 12 12 12\nElementType = MET_SHORT\n"


def nifti():
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, 12, 12, 12, 1, 1, 1, 1)
    struct.pack_into("<hh", header, 70, 4, 16)
    struct.pack_into("<8f", header, 76, 1, 2, 2, 2, 0, 0, 0, 0)
    struct.pack_into("<fff", header, 108, 352, 1, 0)
    header[123] = 2
    struct.pack_into("<hh", header, 252, 0, 1)
    struct.pack_into("<12f", header, 280, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0)
    header[344:348] = b"n+1\0"
    return bytes(header) + voxels()


def write_volumes(folder):
    (folder / "ct.nrrd").write_bytes(NRRD.format(kind="short", encoding="raw").encode() + b"\n" + voxels())
    packed = zlib.compressobj(6, zlib.DEFLATED, 31)
    (folder / "packed.nrrd").write_bytes(NRRD.format(kind="short", encoding="gzip").encode() + b"\n" + packed.compress(voxels()) + packed.flush())
    (folder / "ct.nhdr").write_text(NRRD.format(kind="short", encoding="raw") + "data file: ct.raw\n")
    (folder / "ct.mhd").write_text(META.format(packed=False) + "ElementDataFile = ct.raw\n")
    (folder / "ct.raw").write_bytes(voxels())
    (folder / "ct.mha").write_bytes(META.format(packed=False).encode() + b"ElementDataFile = LOCAL\n" + voxels())
    (folder / "ct.nii").write_bytes(nifti())
    (folder / "labels.nrrd").write_bytes(NRRD.format(kind="uchar", encoding="raw").encode() + b"\n" + labels())
    small_dicom.write_series(folder / "series", small_dicom.regular(6))
    (folder / "slices").mkdir()
    for k in range(6):
        rows = [bytes(200 if 3 <= j < 9 and 3 <= i < 9 and 1 <= k < 5 else 0 for i in range(12)) for j in range(12)]
        small_photo.write_png(folder / "slices" / f"{k}.png", 12, 12, 1, 8, rows)


def write_ply(path, points, faces=()):
    lines = ["ply", "format ascii 1.0", f"element vertex {len(points)}"] + [f"property double {axis}" for axis in "xyz"]
    lines += [f"element face {len(faces)}", "property list uchar int vertex_indices"] if faces else []
    rows = ["%.4f %.4f %.4f" % tuple(p) for p in points] + ["3 %d %d %d" % tuple(f) for f in faces]
    path.write_text("\n".join(lines + ["end_header"] + rows) + "\n")


def write_surfaces(folder):
    """A closed box in each form, and two clouds of a hill."""
    corners = [(x, y, z) for z in (0.0, 12.0) for y in (0.0, 18.0) for x in (0.0, 24.0)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    faces = [f for a, b, c, d in quads for f in ((a, b, c), (a, c, d))]
    write_ply(folder / "box.ply", corners, faces)
    (folder / "box.obj").write_text("".join("v %g %g %g\n" % c for c in corners) + "".join("f %d %d %d\n" % tuple(i + 1 for i in f) for f in faces))
    facet = "".join("facet normal 0 0 0\nouter loop\n" + "".join("vertex %g %g %g\n" % corners[i] for i in f) + "endloop\nendfacet\n" for f in faces)
    (folder / "box.stl").write_text(f"solid a\n{facet}endsolid a\n")
    (folder / "packed.stl").write_bytes(b"a".ljust(80) + struct.pack("<I", len(faces)) + b"".join(
        struct.pack("<12fH", 0, 0, 0, *corners[f[0]], *corners[f[1]], *corners[f[2]], 0) for f in faces))
    points = " ".join("%g %g %g" % c for c in corners)
    (folder / "box.vtp").write_text(
        '<VTKFile type="PolyData" version="0.1" byte_order="LittleEndian"><PolyData>\n<Piece NumberOfPoints="8" NumberOfPolys="12">\n<Points>\n'
        f'<DataArray type="Float32" NumberOfComponents="3" format="ascii">{points}</DataArray>\n</Points>\n<Polys>\n'
        f'<DataArray type="Int64" Name="connectivity" format="ascii">{" ".join(str(i) for f in faces for i in f)}</DataArray>\n'
        f'<DataArray type="Int64" Name="offsets" format="ascii">{" ".join(str(3 * n + 3) for n in range(12))}</DataArray>\n'
        "</Polys>\n</Piece>\n</PolyData></VTKFile>\n")
    rng = random.Random(1)
    for name, shift in (("a.ply", 0.0), ("b.ply", 3.0)):
        places = [(rng.uniform(-20, 20), rng.uniform(-15, 15)) for _ in range(150)]
        write_ply(folder / name, [(x + shift, y, 9 * math.exp(-(x * x / 300 + y * y / 120)) + 0.04 * x) for x, y in places])


def write_meshes(folder):
    vertices, tets = small_case.block(cells=(4, 6, 2))
    small_case.write_msh(folder / "block.msh", vertices, tets)
    (folder / "block.node").write_text(f"{len(vertices)} 3 0 0\n" + "".join(f"{n} {x!r} {y!r} {z!r}\n" for n, (x, y, z) in enumerate(vertices)))
    (folder / "block.ele").write_text(f"{len(tets)} 4 0\n" + "".join(f"{n} " + " ".join(map(str, t)) + "\n" for n, t in enumerate(tets)))
    rows = "".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in vertices)
    cells = "".join("4 " + " ".join(map(str, t)) + "\n" for t in tets)
    (folder / "block.vtk").write_text("# vtk DataFile Version 3.0\na\nASCII\nDATASET UNSTRUCTURED_GRID\n" f"POINTS {len(vertices)} double\n{rows}"
                                      f"CELLS {len(tets)} {5 * len(tets)}\n{cells}CELL_TYPES {len(tets)}\n" + "10\n" * len(tets))
    connectivity = " ".join(str(c) for t in tets for c in t)
    (folder / "block.vtu").write_text(
        f'<VTKFile type="UnstructuredGrid" byte_order="LittleEndian"><UnstructuredGrid>\n<Piece NumberOfPoints="{len(vertices)}" NumberOfCells="{len(tets)}">\n'
        f'<Points>\n<DataArray type="Float64" NumberOfComponents="3" format="ascii">{rows}</DataArray>\n</Points>\n<Cells>\n'
        f'<DataArray type="Int64" Name="connectivity" format="ascii">{connectivity}</DataArray>\n'
        f'<DataArray type="Int64" Name="offsets" format="ascii">{" ".join(str(4 * n + 4) for n in range(len(tets)))}</DataArray>\n'
        f'<DataArray type="UInt8" Name="types" format="ascii">{"10 " * len(tets)}</DataArray>\n</Cells>\n</Piece>\n</UnstructuredGrid></VTKFile>\n')


def write_case(folder):
    """A case of few tets, with a mesh of its own."""
    case = small_case.write_case(folder / "case", {"tumor": {"surface": "tumor.stl"}})
    small_case.write_msh(case / "block.msh", *small_case.block(cells=(6, 9, 2)))
    small_case.write_tumor_surface(case / "tumor.stl")


def ring(radius, count=24, center=(600.0, 0.0, 100.0)):
    return [[center[0] + radius * math.cos(2 * math.pi * n / count), center[1] + radius * math.sin(2 * math.pi * n / count), center[2]] for n in range(count)]


def write_robot_files(folder, command):
    path = small_case.path(ring(15.0), tumor_edge=ring(10.0))
    (folder / "path.json").write_text(json.dumps(path))
    (folder / "sim.json").write_text(json.dumps(dict(path, frame="sim_stretched")))
    plate = [(570.0 + 1.5 * i, -30.0 + 1.5 * j, 100.0) for i in range(41) for j in range(41)]
    write_ply(folder / "plate.ply", plate)
    (folder / "registration.json").write_text(json.dumps({"T_target_source": IDENTITY, "converged": True, "scale": 1.0, "rmse_mm": 0.3, "inlier_fraction": 0.97}))
    for name, options in (("cut.script", ()), ("cut.csv", ("--format", "joint-csv")), ("cut_program.json", ("--format", "json"))):
        subprocess.run([command, "export", "path.json", "--accept", "not_simulated", *options, "-o", name], cwd=folder, check=True, capture_output=True)
    small_calibration.write(folder / "calibration.json")


def write_pictures(folder):
    small_photo.ring_photo(folder / "cut.png", 200, 200, (100.0, 100.0), [(30.0, 4.0, GREEN, 0.0), (50.0, 4.0, RED, 0.0)])
    small_photo.ring_photo(folder / "color.png", 160, 120, (80.0, 60.0), [(33.0, 4.0, GREEN, 0.0)])
    small_photo.depth_picture(folder / "depth.png", 160, 120, lambda u, v: 1500)
    (folder / "camera.json").write_text(json.dumps({"width": 160, "height": 120, "fx": 500.0, "fy": 500.0, "cx": 80.0, "cy": 60.0, "depth_scale": 0.0001}))
    (folder / "mount.json").write_text(json.dumps({"T_robot_camera": [[1, 0, 0, 500], [0, -1, 0, 100], [0, 0, -1, 300], [0, 0, 0, 1]]}))
    small_case.write_contour(folder / "incision.csv", ring(10.0, 60))
    small_case.write_contour(folder / "edge.csv", ring(5.0, 60))
    (folder / "edge.mrk.json").write_text(json.dumps({"markups": [{"type": "ClosedCurve", "coordinateSystem": "LPS", "controlPoints": [
        {"position": p} for p in ring(5.0, 60)]}]}))


def write_tables(folder, command):
    for name, radius in (("before", 9.0), ("after", 10.0)):
        small_case.write_contour(folder / f"{name}.csv", ring(radius, 60))
        subprocess.run([command, "evaluate", "--incision", f"{name}.csv", "--tumor", "edge.csv", "--contour", "inner_edge", "-o", f"{name}.json"], cwd=folder,
                       check=False, capture_output=True)
    (folder / "table.csv").write_text("who,mean_mm,sd,n,max,a_mean,a_sd,a_n\n" + "".join(f"s{n},1.{n},0.5,4,2.1,1.3,0.4,2\n" for n in range(6)))
    (folder / "cuts.csv").write_text("length_mm,time_s\n30,4.2\n62.8,9\n40,5\n")


def write_inputs(folder, command):
    write_volumes(folder)
    write_surfaces(folder)
    write_meshes(folder)
    write_case(folder)
    write_robot_files(folder, command)
    write_pictures(folder)
    write_tables(folder, command)


EXPORT = ("--accept", "not_simulated", "-o", "out.script")

SCENES = [
    *(Scene(f"segment {name}", ("segment", name, "-o", "out.nrrd"), damaged)
      for name, damaged in (("ct.nrrd", ("ct.nrrd",)), ("packed.nrrd", ("packed.nrrd",)), ("ct.nhdr", ("ct.nhdr", "ct.raw")), ("ct.mhd", ("ct.mhd", "ct.raw")),
                            ("ct.mha", ("ct.mha",)), ("ct.nii", ("ct.nii",)), ("series", tuple(f"series/IM{n:04}.dcm" for n in range(6))))),
    Scene("segment slices", ("segment", "slices", "--spacing-mm", "2", "2", "2", "--hu", "1", "-100", "-o", "out.nrrd"), tuple(f"slices/{n}.png" for n in range(6)), 8),
    Scene("mesh labels", ("mesh", "labels.nrrd", "--coarse-mm", "8", "-o", "out.vtu"), ("labels.nrrd",), 1),
    *(Scene(f"mesh {name}", ("mesh", name, "--coarse-mm", "10", "-o", "out.vtu"), (name,), 1) for name in ("box.ply", "box.stl", "box.obj", "box.vtp")),
    *(Scene(f"surface {name}", ("surface", name, "-o", "out.ply", *more), damaged)
      for name, damaged, more in (("box.ply", ("box.ply",), ()), ("box.obj", ("box.obj",), ()), ("box.stl", ("box.stl",), ()), ("packed.stl", ("packed.stl",), ()),
                                  ("box.vtp", ("box.vtp",), ()), ("block.msh", ("block.msh",), ()), ("block.vtk", ("block.vtk",), ()),
                                  ("block.vtu", ("block.vtu",), ()), ("block.node", ("block.node", "block.ele"), ()), ("a.ply", ("a.ply",), ("--planes", "1")))),
    Scene("plan", ("plan", "case", "-o", "out"), ("case/case.yaml", "case/case.yaml", "case/block.msh", "case/tumor.csv", "case/tumor.stl"), 2, keeps=True),
    Scene("register", ("register", "--source", "a.ply", "--target", "b.ply", "--rotations", "8", "--max-iterations", "20", "-o", "out"), ("a.ply", "b.ply"), 1),
    Scene("export", ("export", "path.json", *EXPORT), ("path.json",)),
    Scene("export checked", ("export", "path.json", "--surface", "plate.ply", "--registration", "registration.json", "--accept", "typed_transform", *EXPORT),
          ("path.json", "plate.ply", "registration.json", "registration.json")),
    *(Scene(f"replay {name}", ("replay", name, "-o", "out"), (name,), 2) for name in ("cut.script", "cut.csv", "cut_program.json")),
    Scene("project", ("project", "sim.json", "--transform", "registration.json", "--surface", "plate.ply", "-o", "out.json"), ("sim.json", "registration.json", "plate.ply")),
    Scene("evaluate photo", ("evaluate", "cut.png", "--mm-per-pixel", "0.15", "-o", "out.json"), ("cut.png",), 8),
    Scene("evaluate files", ("evaluate", "--incision", "incision.csv", "--tumor", "edge.csv", "-o", "out.json"), ("incision.csv", "edge.csv")),
    Scene("evaluate markup", ("evaluate", "--incision", "incision.csv", "--tumor", "edge.mrk.json", "-o", "out.json"), ("edge.mrk.json",)),
    Scene("track", ("track", "color.png", "depth.png", "--intrinsics", "camera.json", "--camera", "mount.json", "-o", "out"),
          ("color.png", "depth.png", "camera.json", "mount.json"), 6),
    Scene("compare", ("compare", "--before", "before.json", "--after", "after.json", "-o", "out.json"), ("before.json", "after.json")),
    Scene("audit", ("audit", "table.csv", "-o", "out.json"), ("table.csv",)),
    Scene("calibrate", ("calibrate", "case", "--observed", "before.json", "-o", "out"), ("before.json",), 0),
    Scene("assess", ("assess", "case", "--calibration", "calibration.json", "--registration", "registration.json", "-o", "out"),
          ("calibration.json", "registration.json"), 0, keeps=True),
]
