"""A virtual tongue goes from CT to robot program, and is said to be virtual wherever it appears."""

from pathlib import Path

import loop

with loop.temporary_folder() as folder:
    out = Path(folder) / "demo"
    summary = loop.run("demo", "--seed", "1", "-o", out)
    loop.require_paper_promise(summary)
    loop.require_products(out)
    assert summary["specimen_is"] == "virtual"
    assert "Virtual specimen" in (out / "report.html").read_text()
    assert "VIRTUAL SPECIMEN" in (out / "program" / "program.script").read_text()
    again = loop.run("demo", "--seed", "1", "-o", out)
    assert {stage["state"] for stage in again["stages"]} == {"reused"}, again["stages"]
    assert again["after"]["abs_error_mm"] == summary["after"]["abs_error_mm"]
