#!/usr/bin/env python3
"""Makes the outputs that a change without a change of numbers must not alter, and shows whether it did.

  outputs.py make FOLDER --command build/release/incise   the demo of five seeds, a head CT, the quick experiment with its calibration
  outputs.py hashes FOLDER                                one line for each run and kind of file
  outputs.py compare FOLDER OTHER                         every file that differs, or is in one of them only

One instruction set, one hash: make both folders on one machine. Times, versions and the names of folders do not count.
"""

import argparse
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
KINDS = {
    "contours": ("*.csv", "*.vtp"),
    "meshes": ("*.vtu", "*.nrrd", "*.pvd", "*.ply"),
    "programs": ("*.script", "program.json"),
    "results": ("*.json",),
    "pictures": ("*.svg", "*.png"),
}
# A digest covers the version; inputs, commands and folders name places.
VOLATILE = re.compile(r"(^|_)(build|wall_s|ms_per_step|commit|made_by|version|machine|command|folder|file|path|report|case_file|digest\w*|key|keys|files|inputs|sha256|\w+_sha256|started|seconds|judged_by)$")


def runs(command, folder):
    """(name, words, wanted statuses) of each run."""
    for seed in range(1, 6):
        yield f"demo_{seed}", [command, "demo", "--seed", str(seed), "-o", folder / f"demo_{seed}"], (0, 4)
    slices = pathlib.Path(os.environ.get("INCISE_DATA_DIR", "")) / "ct" / "vhf_head_png"
    if os.environ.get("INCISE_DATA_DIR") and slices.is_dir():
        case = folder / "head_ct_case"
        shutil.copytree(ROOT / "examples" / "02_head_ct", case)
        (case / "slices").symlink_to(slices)
        yield "head_ct", [command, "run", case, "-o", folder / "head_ct"], (0, 4)
    else:
        print("SKIPPED: head_ct: INCISE_DATA_DIR does not name the folder of shared data", flush=True)
    yield "experiment", [command, "experiment", "--quick", "--seed", "511", "-o", folder / "experiment"], (0, 4)


def make(folder, command):
    if folder.exists():
        sys.exit(f"{folder}: found a file or folder, expected none")
    folder.mkdir(parents=True)
    for name, words, statuses in runs(command, folder):
        done = subprocess.run([*map(str, words)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, check=False)
        print(f"{name}: status {done.returncode}", flush=True)
        if done.returncode not in statuses:
            sys.exit(done.stderr.decode("utf-8", "replace"))


def settled(value):
    """A JSON value without what differs from run to run."""
    if isinstance(value, dict):
        return {key: settled(item) for key, item in value.items() if not VOLATILE.search(key)}
    if isinstance(value, list):  # a program's header is a list of [key, value]
        return [settled(item) for item in value if not (isinstance(item, list) and item and isinstance(item[0], str) and VOLATILE.search(item[0]))]
    return value


def content(file, root):
    data = file.read_bytes().replace(str(root.resolve()).encode(), b"")  # where the outputs lie does not count
    if file.suffix == ".json":
        return json.dumps(settled(json.loads(data))).encode()
    if file.suffix == ".script":
        return b"\n".join(line for line in data.split(b"\n") if not re.match(rb"# incise\.(made_by|digest)", line.strip()))
    return data


def kind_of(file):
    if file.name == "manifest.json" or file.name == "stage.json":
        return None
    # "program.json" matches two kinds: the first counts.
    return next((kind for kind in ("contours", "meshes", "programs", "pictures", "results") if any(file.match(p) for p in KINDS[kind])), None)


def files_of(folder):
    """{(run, kind): {name: hash}}"""
    found = {}
    for file in sorted(folder.rglob("*")):
        kind = kind_of(file) if file.is_file() and not file.is_symlink() else None
        # The records of an older version's experiment hold digests of files that say how long something took.
        if not kind or "head_ct_case" in file.parts or "steps" in file.parts:
            continue
        name = file.relative_to(folder)
        found.setdefault((name.parts[0], kind), {})[str(name)] = hashlib.sha256(content(file, folder)).hexdigest()
    return found


def hashes(folder):
    for (run, kind), files in sorted(files_of(folder).items()):
        whole = hashlib.sha256("".join(f"{name} {value}\n" for name, value in sorted(files.items())).encode()).hexdigest()
        print(f"{run:12} {kind:10} {len(files):5} files {whole[:32]}")


def compare(folder, other):
    one = {name: value for files in files_of(folder).values() for name, value in files.items()}
    two = {name: value for files in files_of(other).values() for name, value in files.items()}
    differing = [name for name in sorted(one.keys() | two.keys()) if one.get(name) != two.get(name)]
    for name in differing:
        print(f"{'differs' if name in one and name in two else f'only in {folder if name in one else other}'}: {name}")
    print(f"{len(one.keys() | two.keys())} files, {len(differing)} of them differ")
    return 1 if differing else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("verb", choices=["make", "hashes", "compare"])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("other", type=pathlib.Path, nargs="?")
    parser.add_argument("--command", type=pathlib.Path, default=ROOT / "build" / "release" / "incise")
    request = parser.parse_args()
    if request.verb == "make":
        return make(request.folder.resolve(), request.command.resolve())
    if request.verb == "hashes":
        return hashes(request.folder)
    if request.other is None:
        parser.error("compare: expected two folders")
    return compare(request.folder, request.other)


if __name__ == "__main__":
    sys.exit(main())
