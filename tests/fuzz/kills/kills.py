#!/usr/bin/env python3
"""Kills `incise run` or `incise experiment` (SIGKILL, the whole process group) again and again, then runs it to its end and compares with a run that nothing disturbed.

Where a kill falls is drawn from the seed: after a share of the time that a whole run takes, or at the n-th change of what the output folder
lists, which meets the moments at which results change places. Time decides where a kill falls, never whether the test passes.
Every fourth folder starts from a CT, the others from a mesh. After each kill: every result folder that is there is whole. At the end: same files and bytes (but for times), nothing left over, and a foreign
file in the output folder as it was. An experiment is compared as tests/bits/outputs.py does.
"""

import argparse
import collections
import json
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "cli"))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "bits"))
import outputs  # noqa: E402
import small_case  # noqa: E402

MOST_KILLS_IN_A_ROW = 8  # of one folder, before it is run to its end
OF_TIME = ("wall_s", "ms_per_step", "stages", "folder", "files")  # keys that say how long something took, or digests of files that do
PRODUCTS = ("labels", "mesh", "stretched", "plan", "as_planned", "correction", "corrected", "program")
FOREIGN = "notes.txt"
CT_EVERY = 4  # of the folders, the first among them
CT_TETS = 2500
ACCEPTED = (*small_case.ACCEPTED, "--accept", "depth", "--accept", "heat")


class Finding(Exception):
    """A run that was killed was not put right."""


def require(holds, message):
    if not holds:
        raise Finding(message)


def without_times(value):
    if isinstance(value, dict):
        return {key: without_times(item) for key, item in value.items() if key not in OF_TIME}
    return [without_times(item) for item in value] if isinstance(value, list) else value


def content(file):
    """What has to be the same. The report's page shows times in many places: that it is there is enough."""
    if file.name == "report.html":
        return "a report"
    if file.suffix == ".bin":  # it holds how long things took
        return "an entry of the cache"
    return without_times(json.loads(file.read_text())) if file.suffix == ".json" else file.read_bytes()


def contents(folder):
    return {str(file.relative_to(folder)): content(file) for file in sorted(folder.rglob("*")) if not file.is_dir()}


def listing(folder):
    """Names two levels deep: changes whenever a result comes, goes or is written."""
    names = []
    for name in sorted(os.listdir(folder)) if folder.is_dir() else []:
        try:
            names.append((name, len(os.listdir(folder / name)) if (folder / name).is_dir() else 0))
        except OSError:  # gone meanwhile
            names.append((name, -1))
    return names


def mesh_case(_command, folder):
    small_case.write_case(folder, small_case.SOUND)
    small_case.write_tumor_surface(folder / "tumor.stl")


def ct_case(command, folder):
    """A virtual tongue, coarse and with a wide margin, so that it is cut within seconds and a program is written."""
    subprocess.run([command, "phantom", "--seed", "1", "--format", "nrrd", "-o", str(folder), "--quiet"], check=True, stdout=subprocess.DEVNULL)
    file = folder / "case.yaml"
    text = re.sub(r"tets: .*", f"tets: {CT_TETS}", file.read_text())
    text = re.sub(r"lateral_margin_mm: .*", "lateral_margin_mm: 7\n  close_margin_mm: 0.2", text)
    file.write_text(text + "cut: {dullness: 5, advance_per_step_mm: 0.8, frames: 2}\n")


class Harness:
    """Runs of one case."""

    def __init__(self, command, write_case, generator, root):
        self.command, self.random, self.root = command, generator, root
        self.case = root / "case"
        write_case(command, self.case)
        self.killed_at = collections.Counter()
        begun = time.monotonic()
        self.reference = self.finished(self.fresh("reference"))
        self.whole_s = time.monotonic() - begun

    def fresh(self, name):
        out = self.root / name / "out"
        out.mkdir(parents=True)
        (out / FOREIGN).write_text("mine")
        return out

    def start(self, out):
        words = [self.command, "run", str(self.case), "-o", "out", "--json", "--quiet", "--threads", "1", "--checkpoint-s", "0", *ACCEPTED]
        return subprocess.Popen(words, cwd=out.parent, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True)

    def finished(self, out):
        running = self.start(out)
        _, said = running.communicate()
        require(running.returncode == 0, f"status {running.returncode}: {said}")
        return contents(out)

    def wait_for_the_moment(self, running, out):
        if self.random.random() < 0.5:
            moment = time.monotonic() + self.random.random() * self.whole_s
            while running.poll() is None and time.monotonic() < moment:
                time.sleep(0.001)
            return
        changes, before = self.random.randrange(1, 60), listing(out)
        while running.poll() is None and changes > 0:
            now = listing(out)
            changes -= now != before
            before = now

    def killed(self, out):
        """False where it came to its end before."""
        running = self.start(out)
        self.wait_for_the_moment(running, out)
        was_running = running.poll() is None
        os.killpg(running.pid, signal.SIGKILL) if was_running else None
        _, said = running.communicate()
        require(running.returncode in (0, 4, -signal.SIGKILL), f"status {running.returncode}: {said}")
        return running.returncode == -signal.SIGKILL

    def look_at(self, out):
        """Results that are there are whole."""
        for product in PRODUCTS:
            if (out / product / "manifest.json").exists():
                listed = json.loads((out / product / "manifest.json").read_text())["files"]
                missing = [name for name in listed if not (out / product / name).exists()]
                require(not missing, f"{product} has lost {missing}")
            else:
                require(not (out / product).exists(), f"{product} without its manifest: {listing(out)}")
        made = [product for product in PRODUCTS if (out / product).exists()]
        passes = sorted(entry.name for entry in (out / "cache").glob("pass_?.bin")) if (out / "cache").exists() else []
        made += [name.removesuffix(".bin") for name in passes] if made and made[-1] == "as_planned" else []
        self.killed_at[f"after {made[-1]}" if made else "before the first result"] += 1

    def chain(self, number, kills):
        """One folder: killed up to so many times, then run to its end. Returns the number of kills."""
        out, done = self.fresh(f"chain_{number}"), 0
        while done < kills and self.killed(out):
            done += 1
            self.look_at(out)
        after = self.finished(out)
        require(after.keys() == self.reference.keys(), f"files: {sorted(after.keys() ^ self.reference.keys())}")
        different = [name for name in after if after[name] != self.reference[name]]
        require(not different, f"not the same as undisturbed: {different}")
        require([entry.name for entry in out.parent.iterdir()] == ["out"], f"left beside the output: {list(out.parent.iterdir())}")
        subprocess.run(["rm", "-r", out.parent], check=True)
        return done


class ExperimentHarness(Harness):
    """Runs of one small experiment. A kill falls within a share of the whole time, so that many are met on the way."""

    SHARE = 0.25

    def __init__(self, command, generator, root):
        super().__init__(command, lambda *_: None, generator, root)

    def start(self, out):
        words = [self.command, "experiment", "--quick", "--specimens", "2", "--tets", "6000", "--seed", "511", "-o", "out", "--json", "--quiet", "--threads", "1"]
        return subprocess.Popen(words, cwd=out.parent, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True)

    def fresh(self, name):
        out = self.root / name / "out"
        out.parent.mkdir(parents=True)
        return out

    def finished(self, out):
        running = self.start(out)
        _, said = running.communicate()
        require(running.returncode in (0, 4), f"status {running.returncode}: {said}")
        return {name: value for files in outputs.files_of(out).values() for name, value in files.items()}

    def wait_for_the_moment(self, running, out):
        moment = time.monotonic() + self.random.random() * self.SHARE * self.whole_s
        while running.poll() is None and time.monotonic() < moment:
            time.sleep(0.001)

    def look_at(self, out):
        done = sorted(entry.stem for entry in out.rglob("cache/*.bin")) if out.exists() else []
        self.killed_at[f"with {len(done):2d} entries of the cache"] += 1


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--command", default=os.environ.get("INCISE_COMMAND"), help="the incise command")
    parser.add_argument("--of", choices=["run", "experiment"], default="run", help="what is killed")
    parser.add_argument("--count", type=int, default=500, help="kills in all")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--end-at", type=float, default=None, help="begin no further folder after this many seconds")
    options = parser.parse_args()
    begun = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="incise_kills_") as root:
        command, generator = str(pathlib.Path(options.command).resolve()), random.Random(options.seed)
        harnesses = {}
        for name in ("CT", "mesh") if options.of == "run" else ("experiment",):
            folder = pathlib.Path(root) / name
            folder.mkdir()
            kinds = {"CT": lambda at: Harness(command, ct_case, generator, at), "mesh": lambda at: Harness(command, mesh_case, generator, at),
                     "experiment": lambda at: ExperimentHarness(command, generator, at)}
            harnesses[name] = kinds[name](folder)
        most_in_a_row = min(MOST_KILLS_IN_A_ROW, (options.count + 1) // 2)  # so that both kinds are met
        kills = chains = 0
        while kills < options.count and (options.end_at is None or time.monotonic() - begun < options.end_at):
            chains += 1
            harness = harnesses.get("experiment") or harnesses["CT" if chains % CT_EVERY == 1 else "mesh"]
            try:
                kills += harness.chain(chains, min(generator.randint(1, most_in_a_row), options.count - kills))
            except Finding as finding:
                kept = pathlib.Path(tempfile.mkdtemp(prefix="incise_kills_found_"))
                subprocess.run(["cp", "-a", root, str(kept)], check=True)
                print(f"seed {options.seed}, folder {chains}, kept in {kept}: {finding}")
                return 1
            if chains % 10 == 0:
                print(f"{kills} kills", flush=True)
        print(f"{kills} kills of {chains} runs, 0 findings")
        for name, harness in harnesses.items():
            print(f"from {name}, {harness.whole_s:.1f} s a run")
            for place, count in sorted(harness.killed_at.items()):
                print(f"  {count:4d} {place}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
