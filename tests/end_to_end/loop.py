"""Runs the incise command and reads its summary."""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

COMMAND = str(Path(sys.argv[1]).resolve())
EXAMPLES = Path(sys.argv[2]).resolve()
STAGES_OF_A_MESH = ("stretched", "plan", "as_planned", "correction", "corrected", "program")  # where the case names a mesh
STAGES_OF_A_SCAN = ("labels", "mesh", *STAGES_OF_A_MESH)


def run(*arguments):
    """The JSON summary of a run that has to end with exit status 0."""
    return result(*arguments, status=0)


def result(*arguments, status):
    """The JSON summary of a run that has to end with this exit status."""
    done = subprocess.run([COMMAND, *map(str, arguments), "--json", "--threads", "1"], capture_output=True, text=True)
    assert done.returncode == status, f"exit status {done.returncode}:\n{done.stderr}"
    return json.loads(done.stdout)


def require_paper_promise(summary):
    """The cut closes with a negative margin, and one pass of the correction lowers the mean absolute error by half or more."""
    before, after = summary["before"], summary["after"]
    for name, cut in (("before", before), ("after", after)):
        assert cut["closed_loop"] and cut["negative_margin"], f"{name}: {cut['outcome']}"
        assert cut["contour"] == "centerline" and cut["target_mm"] == 5.0
        assert cut["tets"] >= 30000, f"{cut['tets']} tetrahedra"
    error_before, error_after = before["abs_error_mm"]["mean"], after["abs_error_mm"]["mean"]
    print(f"mean |error| against 5.0 mm: {error_before:.3f} -> {error_after:.3f} mm")
    assert error_before > 0.4, "nothing to correct"
    assert error_after <= 0.5 * error_before
    assert after["inner_edge"]["abs_error_mm"]["mean"] < before["inner_edge"]["abs_error_mm"]["mean"]


def require_verdict(summary, status, *ids):
    """The verdict's status, and reasons that it must have."""
    verdict = summary["verdict"]
    found = [reason["id"] for reason in verdict["reasons"]]
    assert verdict["status"] == status and set(ids) <= set(found), verdict


def require_products(folder, stages=STAGES_OF_A_SCAN, has_program=True):
    """Every stage left its files, each folder its manifest; no program unless there is to be one."""
    assert (folder / "program").exists() == has_program, "program"
    if "mesh" in stages:
        assert (folder / "mesh" / "mesh.vtu").stat().st_size > 0, "mesh/mesh.vtu"
    files = ["report.html", "stretched/deformed.vtu", "plan/path.json", "as_planned/frames.pvd", "as_planned/incision.json", "corrected/centerline.csv"]
    for name in files + ["program/program.script", "program/program.json"] * has_program:
        assert (folder / name).stat().st_size > 0, name
    for stage in stages:
        if stage == "program" and not has_program:
            continue
        manifest = json.loads((folder / stage / "manifest.json").read_text())
        assert manifest["inputs"] and all(len(entry["sha256"]) == 64 for entry in manifest["inputs"]), stage


def temporary_folder():
    return tempfile.TemporaryDirectory(prefix="incise_test_")
