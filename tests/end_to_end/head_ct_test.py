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
    summary = loop.run("run", case, "-o", out)
    loop.require_paper_promise(summary)
    loop.require_products(out)
    assert summary["specimen_is"] == "real"
    assert "Virtual specimen" not in (out / "report.html").read_text()
