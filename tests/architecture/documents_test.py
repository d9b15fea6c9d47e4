#!/usr/bin/env python3
"""What the documents name is there: tests and functions of docs/paper-map.md, files of each module's README, and every public header in one."""

import pathlib
import re
import sys

ROOT = pathlib.Path(sys.argv[1])
MADE_BY_THE_BUILD = {"page_files.cpp"}


def text_of(folder, endings):
    return {file: file.read_text(errors="replace") for file in sorted((ROOT / folder).rglob("*")) if file.suffix in endings}


def paper_map_faults():
    """Backticked `Suite.Test`, and `function`s in the column that says where a part of the paper lives."""
    page = (ROOT / "docs" / "paper-map.md").read_text()
    tests = "".join(text_of("tests", {".cpp", ".hpp"}).values())
    headers = {module.name: "".join(text_of(module.relative_to(ROOT), {".hpp"}).values()) for module in (ROOT / "include" / "incise").iterdir() if module.is_dir()}
    for suite, name in re.findall(r"`([A-Z]\w+)\.(\w+|\*)`", page):
        if suite == "Suite":  # the page explains how tests are named
            continue
        # A test may be given by an instantiation, Prefix/Suite.
        macro = rf"TEST(?:_F|_P)?\(\s*(\w*{suite})\s*,\s*{name if name != '*' else chr(92) + 'w+'}\s*\)|INSTANTIATE_TEST_SUITE_P\(\s*{suite}\s*,"
        if not re.search(macro, tests):
            yield f"docs/paper-map.md: no test {suite}.{name}"
    for module, words in re.findall(r"\b([a-z_]+): ((?:`[^`]+`(?: \(`[^`]+`\))?,? ?(?:and by default )?)+)", page):
        if module not in headers:
            continue
        for word in re.findall(r"`(\w+)(?:::\w+)?`", words):
            if not re.search(rf"\b{word}\b", headers[module]):
                yield f"docs/paper-map.md: {module} has no {word} in its public headers"


def readme_faults():
    files = {file.name for folder in ("include", "src", "apps", "tests", "docs") for file in (ROOT / folder).rglob("*")}
    for module in sorted((ROOT / "include" / "incise").iterdir()):
        if not module.is_dir():
            continue
        readme = ROOT / "src" / module.name / "README.md"
        text = readme.read_text()
        for header in sorted(module.glob("*.hpp")):
            if f"{header.name}`" not in text:
                yield f"{readme.relative_to(ROOT)}: {header.name} is not named"
        for name in re.findall(r"`(?:[\w/]+/)?(\w+\.[hc]pp)`", text):
            if name not in files | MADE_BY_THE_BUILD:
                yield f"{readme.relative_to(ROOT)}: no file {name}"


def main():
    faults = [*paper_map_faults(), *readme_faults()]
    for fault in faults:
        print(fault)
    print(f"{len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
