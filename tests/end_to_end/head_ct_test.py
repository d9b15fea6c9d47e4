"""The tongue of a real head CT goes the same way, from a folder of PNG slices."""

import os
import shutil
import sys
from pathlib import Path

import loop

slices = Path(os.environ.get("INCISE_DATA_DIR", "")) / "ct" / "vhf_head_png"
if not os.environ.get("INCISE_DATA_DIR") or not slices.is_dir():
    print("SKIPPED: INCISE_DATA_DIR does not name the folder of shared test data")
    sys.exit(77)

with loop.temporary_folder() as folder:
    case = Path(folder) / "case"
    shutil.copytree(loop.EXAMPLES / "02_head_ct", case)
    (case / "slices").symlink_to(slices)
    out = case / "out"
    # The lateral error falls as the paper promises, and the kerf is still open at the planned depth: a result, and no program.
    summary = loop.result("run", case, "-o", out, status=4)
    loop.require_paper_promise(summary)
    loop.require_products(out, has_program=False)
    loop.require_verdict(summary, "refused", "open_layer")
    assert summary["specimen_is"] == "real"
    assert "Virtual specimen" not in (out / "report.html").read_text()
