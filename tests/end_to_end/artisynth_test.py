"""The ArtiSynth tongue goes from a closed surface to a corrected path."""

import os
import shutil
import sys
from pathlib import Path

import loop

published = Path(os.environ.get("INCISE_DATA_DIR", "")) / "meshes" / "artisynth_tongue" / "badintongue.obj"
if not os.environ.get("INCISE_DATA_DIR") or not published.is_file():
    print("SKIPPED: INCISE_DATA_DIR does not name the folder of shared test data")
    sys.exit(77)


def turned(line):
    """A line of the published surface (m; x to the back, y to the right, z up) in mm and LPS."""
    if not line.startswith("v "):
        return line
    x, y, z = (1000.0 * float(number) for number in line.split()[1:4])
    return f"v {-y:.6f} {x:.6f} {z:.6f}"


with loop.temporary_folder() as folder:
    case = Path(folder) / "case"
    shutil.copytree(loop.EXAMPLES / "03_artisynth_tongue", case)
    surface = case / "tongue.obj"
    surface.write_text("\n".join(map(turned, published.read_text().splitlines())) + "\n")
    mesh = loop.run("mesh", surface, "--around", case / "around.csv", "--tets", 40000, "-o", case / "tongue.vtu")
    assert 95000.0 < mesh["volume_mm3"] < 105000.0, mesh["volume_mm3"]  # of a human tongue with its root
    out = case / "out"
    summary = loop.run("run", case, "-o", out, "--accept", "typed_transform")
    loop.require_verdict(summary, "caution", "typed_transform")
    loop.require_paper_promise(summary)
    loop.require_products(out, loop.STAGES_OF_A_MESH)
    assert "Virtual specimen" not in (out / "report.html").read_text()
