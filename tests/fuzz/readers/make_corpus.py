#!/usr/bin/env python3
"""Makes the small corpus of the fuzz targets beside this file: a few sound inputs for each reader, a few kilobytes in all.

usage: make_corpus.py INCISE   (the built command: robot programs are its own)
Inputs that were found to break a reader are added by hand under names that begin with `was_`; this program leaves them alone.
"""

import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

HERE = pathlib.Path(__file__).resolve().parent
TESTS = HERE.parents[1]
sys.path.insert(0, str(TESTS / "cli"))
import small_calibration  # noqa: E402
import small_case  # noqa: E402
import small_dicom  # noqa: E402

NEXT_FILE = b"\n=== next file ===\n"
CORNERS = [(0.0, 0.0, 0.0), (9.0, 0.0, 0.0), (0.0, 9.0, 0.0), (0.0, 0.0, 9.0), (9.0, 9.0, 9.0)]
TETS = [(0, 1, 2, 3), (1, 2, 4, 3)]


def put(reader, name, content):
    folder = HERE / "corpus" / reader
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(content.encode() if isinstance(content, str) else content)


def circle(radius=15.0, count=8):
    return [[600 + radius * math.cos(2 * math.pi * k / count), radius * math.sin(2 * math.pi * k / count), 100.0] for k in range(count)]


def path():
    return small_case.path(circle(), tumor_edge=circle(10.0))


def surfaces():
    xyz = "property float x\nproperty float y\nproperty float z\n"
    vertices = "".join("%g %g %g 0 0 1\n" % p for p in CORNERS)
    put("ply", "ascii", f"ply\nformat ascii 1.0\ncomment SPACE=RAS\nelement vertex 5\n{xyz}property float nx\nproperty float ny\nproperty float nz\n"
        f"element face 2\nproperty list uchar int vertex_indices\nend_header\n{vertices}3 0 1 2\n4 1 2 4 3\n")
    put("ply", "binary", f"ply\nformat binary_little_endian 1.0\nelement vertex 5\n{xyz}property uchar red\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n".encode()
        + b"".join(struct.pack("<3fB", *p, 7) for p in CORNERS) + struct.pack("<B3i", 3, 0, 1, 2))
    put("obj", "plain", "# a\n" + "".join("v %g %g %g\n" % p for p in CORNERS) + "vn 0 0 1\nvt 0 0\nf 1 2 3\nf 1//1 2//1 4//1 5//1\nf -1/1/1 -2/1/1 -3/1/1\n")
    facets = "".join("facet normal 0 0 0\nouter loop\n" + "".join("vertex %g %g %g\n" % CORNERS[i] for i in t) + "endloop\nendfacet\n" for t in ((0, 1, 2), (1, 2, 4)))
    put("stl", "ascii", f"solid a\n{facets}endsolid a\n")
    put("stl", "binary", b"SPACE=LPS".ljust(80) + struct.pack("<I", 1) + struct.pack("<12fH", 0, 0, 0, *CORNERS[0], *CORNERS[1], *CORNERS[2], 0))


def vtk_xml():
    for name in ("ascii", "binary_zlib", "appended_raw", "appended_base64_zlib", "big_endian"):
        put("vtu", name, (TESTS / "io" / "vtk_files" / f"{name}.vtu").read_bytes())
    for name in ("ascii_42", "ascii_51", "binary_42", "binary_51"):
        put("vtk", name, (TESTS / "io" / "vtk_files" / f"{name}.vtk").read_bytes())
    points = " ".join("%g %g %g" % p for p in CORNERS)

    def poly_data(cells, number):
        return ('<VTKFile type="PolyData" version="0.1" byte_order="LittleEndian"><PolyData><FieldData><Array type="String" Name="SPACE" '
                'NumberOfTuples="1" format="ascii">82 65 83 0</Array></FieldData>'
                f'<Piece NumberOfPoints="5" Number{number}="1"><PointData><DataArray type="Float32" Name="normals" NumberOfComponents="3" format="ascii">'
                f'{points}</DataArray></PointData><Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">{points}</DataArray></Points>'
                f'<{number}><DataArray type="Int64" Name="connectivity" format="ascii">{cells}</DataArray><DataArray type="Int64" Name="offsets" '
                f'format="ascii">{len(cells.split())}</DataArray></{number}></Piece></PolyData></VTKFile>\n')

    put("vtp", "polygon", poly_data("0 1 4 2", "Polys"))
    put("contour_vtp", "line", poly_data("0 1 4 2 0", "Lines"))
    packed = zlib.compress(struct.pack("<9d", *CORNERS[1], *CORNERS[2], *CORNERS[3]))
    data = struct.pack("<4I", 1, 72, 0, len(packed)) + packed
    put("vtp", "packed", b'<VTKFile type="PolyData" byte_order="LittleEndian" header_type="UInt32" compressor="vtkZLibDataCompressor"><PolyData>'
        b'<Piece NumberOfPoints="3"><Points><DataArray type="Float64" NumberOfComponents="3" format="appended" offset="0"/></Points></Piece></PolyData>'
        b'<AppendedData encoding="raw">_' + data + b"</AppendedData></VTKFile>")
    put("pvd", "series", '<VTKFile type="Collection" version="0.1"><Collection><DataSet timestep="0" group="" part="0" file="a_0.vtu"/>'
        '<DataSet timestep="0.5" file="a_1.vtu"/></Collection></VTKFile>\n')


def meshes():
    nodes = "".join("%d %g %g %g\n" % (n + 1, *p) for n, p in enumerate(CORNERS))
    tets = ["".join(f" {corner + 1}" for corner in tet) for tet in TETS]
    put("msh", "two", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 5 \"a\"\n$EndPhysicalNames\n$Nodes\n5\n" + nodes + "$EndNodes\n$Elements\n2\n"
        + "".join(f"{n + 1} 4 2 5 1{tet}\n" for n, tet in enumerate(tets)) + "$EndElements\n$NodeData\n1\n\"q\"\n1\n0\n3\n0\n1\n1\n1 7\n$EndNodeData\n")
    put("msh", "one", "$NOD\n5\n" + nodes + "$ENDNOD\n$ELM\n2\n" + "".join(f"{n + 1} 4 1 1 4{tet}\n" for n, tet in enumerate(tets)) + "$ENDELM\n")
    put("msh", "four", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 1\n1 0 0 0 9 9 9 1 5 0\n$EndEntities\n$Nodes\n1 5 1 5\n3 1 0 5\n"
        + "".join(f"{n + 1}\n" for n in range(5)) + "".join("%g %g %g\n" % p for p in CORNERS) + "$EndNodes\n$Elements\n1 2 1 2\n3 1 4 2\n"
        + "".join(f"{n + 1}{tet}\n" for n, tet in enumerate(tets)) + "$EndElements\n")
    for first in (0, 1):
        node = "# a\n5 3 1 1\n" + "".join("%d %g %g %g 0.5 1\n" % (n + first, *p) for n, p in enumerate(CORNERS))
        ele = "2 4 1\n" + "".join(f"{n + first} " + " ".join(str(c + first) for c in tet) + " 7\n" for n, tet in enumerate(TETS))
        put("tetgen", f"from_{first}", node.encode() + NEXT_FILE + ele.encode())


def lists():
    rows = "".join("%g,%g,%g,%g\n" % (n, *p) for n, p in enumerate(circle()))
    put("contour_csv", "ring", "error_mm,x_mm,y_mm,z_mm\n" + rows)
    put("contour_csv", "windows", ("\ufeffz_mm,x_mm,y_mm\r\n1,0,0\r\n\r\n1,9,0\r\n1,0,9\r\n"))
    markup = {"markups": [{"type": "ClosedCurve", "coordinateSystem": "RAS", "coordinateUnits": "mm",
                           "controlPoints": [{"id": "1", "position": p} for p in circle()[:4]]}]}
    put("contour_json", "curve", json.dumps(markup))
    put("table", "quoted", 'name,x_mm,mean\n"a, ""b""",1,2.5\nc,-3e2,4\n')
    put("json", "transform", json.dumps({"T_robot_camera": [[0, 1, 0, 5.5], [-1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]], "t": [None, True, "\u00e4\\n"]}))
    put("path", "ring", json.dumps(path()))
    stamped = dict(path(), schema="incise.path/1", T_robot_sim=[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], source_sha256="0" * 64,
                   tumor_edge_closed=True)
    put("path", "stamped", json.dumps(stamped))
    put("published_table", "table", "who,mean_mm,sd,n,max,a_mean,a_sd,a_n,score_percent\nx,1.25,0.5,4,2.1,1.3,0.4,2,50\ny,-,n/a,,failed,,,,\n")
    put("timed_cuts", "cuts", "length_mm,time_s,who\n30,4.2,a\n62.8,9,b\n")


def programs(command):
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "path.json").write_text(json.dumps(path()))

        def exported(name, *options):
            subprocess.run([command, "export", "path.json", "--accept", "not_simulated", "-o", name, "--quiet", *options], cwd=folder, check=True,
                           capture_output=True)
            return (folder / name).read_text()

        def shortened(text, head, tail):
            """Without most of its moves."""
            lines = text.splitlines(keepends=True)
            begin = next(n for n, line in enumerate(lines) if not line.startswith("#"))
            kept = [line for line in lines[:begin] if "check" not in line]
            return "".join(kept + lines[begin : begin + head] + lines[-tail:])

        put("urscript", "movep", shortened(exported("cut.script"), 12, 6))
        put("urscript", "servoj", shortened(exported("servo.script", "--motion", "servoj"), 10, 6))
        put("joint_csv", "joints", shortened(exported("cut.csv", "--format", "joint-csv"), 8, 3))
        program = json.loads(exported("cut.json", "--format", "json"))
        program["poses"], program["checks"] = program["poses"][:3] + program["poses"][-2:], program["checks"][:2]
        program["motion"]["samples"] = program["motion"]["samples"][:4]
        put("program_json", "short", json.dumps(program))


def png(color_type=0, bits=8, interlace=0, packed=None, width=3, height=2):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    channels = {0: 1, 2: 3, 6: 4}[color_type]
    rows = b"".join(b"\0" + bytes(37 * i % 256 for i in range(width * channels * bits // 8)) for _ in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, bits, color_type, 0, 0, interlace))
            + chunk(b"IDAT", packed or zlib.compress(rows)) + chunk(b"IEND", b""))


NRRD = ("NRRD0004\n# a\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: 3 2 2\nspace directions: (1,0,0) (0,1,0) (0,0,2)\n"
        "encoding: {encoding}\nendian: little\nspace origin: (0,0,0)\n")
META = ("ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nCompressedData = {packed}\nTransformMatrix = 1 0 0 0 1 0 0 0 1\n"
        "Offset = 0 0 0\nElementSpacing = 1 1 2\nDimSize = 3 2 2\nElementType = MET_SHORT\n")
VOXELS = struct.pack("<12h", *range(-6, 6))


def jpeg():
    """8 x 8 pixels of one colour, turned by its camera: tables of a few codes, no coefficients but one."""
    def segment(marker, data):
        return struct.pack(">BBH", 0xFF, marker, len(data) + 2) + data

    exif = b"Exif\0\0II*\0" + struct.pack("<IHHHIII", 8, 1, 0x112, 3, 1, 6, 0)
    frame = struct.pack(">BHHB", 8, 8, 8, 3) + b"".join(bytes([c, 0x11, 0]) for c in (1, 2, 3))
    direct = b"\0" + bytes([1, 1]) + bytes(14) + bytes([0, 7])  # code 0: no difference, 10: one of 7 bits
    others = b"\x10" + bytes([1]) + bytes(15) + bytes([0])  # code 0: no further coefficient
    scan = bytes([3, 1, 0, 2, 0, 3, 0, 0, 63, 0])
    bits = "00" + "00" + "10" + "1000000" + "0" + "11"
    return (b"\xFF\xD8" + segment(0xE0, b"JFIF\0\1\1\1\0\x48\0\x48\0\0") + segment(0xE1, exif) + segment(0xDB, bytes(1) + b"\x01" * 64) + segment(0xC0, frame)
            + segment(0xC4, direct) + segment(0xC4, others) + segment(0xDA, scan) + int(bits, 2).to_bytes(len(bits) // 8, "big") + b"\xFF\xD9")


def tiff(channels, bits):
    """2 x 2 pixels in one strip."""
    pixels = bytes(37 * i % 256 for i in range(4 * channels * bits // 8))
    fields = [(256, 4, 1, 2), (257, 4, 1, 2), (258, 3, channels, bits if channels == 1 else 122), (259, 3, 1, 1), (262, 3, 1, 1 if channels == 1 else 2),
              (273, 4, 1, 130), (277, 3, 1, channels), (278, 4, 1, 2), (279, 4, 1, len(pixels))]
    return (b"II*\0" + struct.pack("<IH", 8, len(fields)) + b"".join(struct.pack("<HHII", *f) for f in fields) + bytes(4)
            + struct.pack("<4H", *[bits] * 4) + pixels)


def pictures():
    put("picture", "colour", png(color_type=2))
    put("picture", "transparent", png(color_type=6))
    put("picture", "jpeg", jpeg())
    put("picture", "tiff", tiff(3, 8))
    put("depth", "png", png(bits=16))
    put("depth", "tiff", tiff(1, 16))


def volumes():
    import gzip

    packed = gzip.compress(VOXELS, mtime=0)
    put("nrrd", "raw", NRRD.format(encoding="raw").encode() + b"\n" + VOXELS)
    put("nrrd", "gzip", NRRD.format(encoding="gzip").encode() + b"\n" + packed)
    put("nrrd", "ascii", NRRD.format(encoding="ascii").encode() + b"\n" + b"1 2 3 4 5 6 7 8 9 10 11 12\n")
    put("nhdr", "raw", NRRD.format(encoding="raw").encode() + b"data file: a.raw\n" + NEXT_FILE + VOXELS)
    put("mha", "raw", META.format(packed=False).encode() + b"ElementDataFile = LOCAL\n" + VOXELS)
    put("mha", "packed", META.format(packed=True).encode() + b"CompressedDataSize = %d\n" % len(zlib.compress(VOXELS))
        + b"ElementDataFile = LOCAL\n" + zlib.compress(VOXELS))
    put("mhd", "raw", META.format(packed=False).encode() + b"ElementDataFile = a.raw\n" + NEXT_FILE + VOXELS)
    header = bytearray(348)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, 3, 2, 2, 1, 1, 1, 1)
    struct.pack_into("<hh", header, 70, 4, 16)
    struct.pack_into("<8f", header, 76, 1, 1, 1, 2, 0, 0, 0, 0)
    struct.pack_into("<fff", header, 108, 352, 1, 0)
    struct.pack_into("<B", header, 123, 2)
    struct.pack_into("<hh", header, 252, 1, 1)
    struct.pack_into("<12f", header, 280, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2, 0)
    header[344:348] = b"n+1\0"
    put("nifti", "short", bytes(header) + b"\0" * 4 + VOXELS)
    put("nrrd_header", "one", NRRD.format(encoding="raw") + "data file: voxels.raw\n\n")
    put("nrrd_header", "numbered", NRRD.format(encoding="raw") + "data file: s%02d.raw 3 7 2\n\n")
    put("nrrd_header", "list", NRRD.format(encoding="raw").replace("\n", "\r\n") + "Data File: LIST 2\r\na.raw\r\nb.raw\r\n")
    put("meta_header", "one", META.format(packed=False) + "ElementDataFile = voxels.raw\n")
    put("meta_header", "list", META.format(packed=False) + "ElementDataFile = LIST 2\na.raw\nb.raw\n")
    put("meta_header", "pattern", META.format(packed=False) + "ElementDataFile = s%02d.raw 1 2 1\n")
    put("png", "gray", png())
    put("png", "deep", png(bits=16))
    put("png", "interlaced", png(interlace=1, width=1, height=1))
    put("png", "color", png(color_type=2))
    small_dicom.ROWS = small_dicom.COLUMNS = 4
    slices = [small_dicom.slice_bytes((0.0, 0.0, 2.0 * n), n)[128:] for n in range(2)]
    slices = [b"\0" * 128 + one for one in slices]
    put("dicom_header", "slice", slices[0])
    put("dicom", "two", NEXT_FILE.join(slices))


def results():
    put("case", "small.yaml", json.dumps(small_case.CASE, indent=1))
    put("case", "block.yaml", "schema: incise.case/1\nspecimen_is: virtual\nct: {volume: ct, spacing_mm: [1, 1, 1]}\ntumor: &t\n  contour: tumor.csv\n"
        "  surface: tumor.stl\ncut:\n  dullness: 5  # a\nconstraints:\n  - {kind: fixed, box_mm: [0, 0, 0, 40, 4, 14]}\n"
        "robot: {T_robot_sim: [[0, 1, 0, 500], [-1, 0, 0, 20], [0, 0, 1, 200], [0, 0, 0, 1]]}\n")
    put("calibration", "fit", json.dumps(small_calibration.calibration()))
    identity = [[1, 0, 0, 4.5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
    put("registration", "found", json.dumps({"schema": "incise.registration/1", "outcome": "converged", "converged": True, "reasons": [], "scale": 1.0,
        "T_target_source": identity, "rmse_mm": 0.3, "inlier_fraction": 0.8, "certificate": {"scale_sd": 0.01}, "target_sha256": "0" * 64}))
    cut = {"schema": "incise.evaluation/1", "outcome": "success", "closed_loop": True, "negative_margin": True, "contour": "inner_edge", "target_mm": 4.5,
           "n_points": 4, "hu_score": 30.0, "hu_score_ideal": 20.0, "centroid_shift_mm": 0.1, "zones": {"positive": None, "close": {"at_or_below_mm": 2.2}},
           "signed_error_mm": {"mean": 0.1}, "abs_error_mm": {"mean": 0.2},
           "points": {"x_mm": [1, 0, -1, 0], "y_mm": [0, 1, 0, -1], "z_mm": [0, 0, 0, 0], "arclength_mm": [0, 1, 2, 3],
                      "signed_error_mm": [0.1, -0.2, 0.3, 0.4], "clock_h": [0, 3, 6, 9]}}
    put("evaluation", "ring", json.dumps(cut))
    put("photographed_cut", "ring", json.dumps(dict(cut, tumor_edge={"x_mm": [1, 0, -1], "y_mm": [0, 1, 0], "z_mm": [0, 0, 0]}, approach=[0, 0, -1], virtual=True)))
    put("outcome", "success", '{"outcome": "success"}')
    put("specimen", "drawn", '{"schema": "incise.specimen/1", "seed": 7}')
    tissue, doses_and_bonds, pose = struct.pack("<5Q", 0, 0, 0, 0, 0), struct.pack("<3Q", 0, 0, 0), struct.pack("<9d", *range(9))
    put("checkpoint", "begun", tissue + doses_and_bonds + pose + struct.pack("<dqQqQQd", 0.5, 3, 0, 0, 0, 0, 1.5))


if __name__ == "__main__":
    surfaces()
    vtk_xml()
    meshes()
    lists()
    programs(pathlib.Path(sys.argv[1]).resolve())
    volumes()
    pictures()
    results()
