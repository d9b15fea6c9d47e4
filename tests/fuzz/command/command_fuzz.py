#!/usr/bin/env python3
"""Runs the command on damaged files.

Whatever is in a file, the command ends with a status that is documented; a refusal is one line that names a file; memory and processor time are
bounded; and nothing is left where a result was refused. Every case follows from the seed and its number: `--only N` repeats one.
"""

import argparse
import collections
import os
import pathlib
import random
import resource
import shutil
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
STATUSES = (0, 2, 3, 4, 130)
REFUSED = (2, 3)
MOST_CPU_S = 120           # of a case that takes a second at most when its file is sound
MOST_MEMORY = 1_500 << 20  # bytes, resident: what the command and its libraries take, and the files' few kilobytes a thousand times
MOST_ADDRESSES = 8 << 30   # bytes: what asks for all there is ends itself, not the machine
LEFT_BEHIND = (".part", ".tmp")


def status_and_use(process, watch):
    """Waits for the process. @returns its status and what it used."""
    next_look, pause = time.monotonic() + 1.0, 0.001
    while True:
        pid, status, use = os.wait4(process.pid, os.WNOHANG)
        if pid:
            process.returncode = os.waitstatus_to_exitcode(status)
            return process.returncode, use
        time.sleep(pause)
        pause = min(0.02, 1.5 * pause)
        if time.monotonic() > next_look:
            watch.look()
            next_look = time.monotonic() + 1.0


def limit():
    resource.setrlimit(resource.RLIMIT_CPU, (MOST_CPU_S, MOST_CPU_S))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_AS, (MOST_ADDRESSES, MOST_ADDRESSES))


class Fuzzer:
    def __init__(self, command, seed, root):
        os.environ.setdefault("INCISE_COMMAND", command)
        import scenes
        from command import Watch

        self.Watch, self.command, self.seed, self.root = Watch, command, seed, root
        self.sound = root / "sound"
        self.sound.mkdir()
        scenes.write_inputs(self.sound, command)
        self.scenes = [scene for scene in scenes.SCENES for _ in range(scene.weight)]
        self.statuses, self.findings = collections.Counter(), []

    def run(self, folder, arguments):
        """@returns status, output, what it said, use of the machine"""
        with open(self.root / "stdout", "w+b") as out, open(self.root / "stderr", "w+b") as said:
            process = subprocess.Popen([self.command, *arguments, "--threads", "1"], cwd=folder, stdin=subprocess.DEVNULL, stdout=out, stderr=said, start_new_session=True,
                                       preexec_fn=limit)
            try:
                status, use = status_and_use(process, self.Watch(process))
            except AssertionError:
                return None, "", "", None
            out.seek(0)
            said.seek(0)
            return status, out.read().decode("utf-8", "replace"), said.read().decode("utf-8", "replace"), use

    def damaged(self, scene, number):
        """A folder with the scene's inputs, one of them damaged. @returns it, and the damaged file's name"""
        import mutators

        rng = random.Random(f"{self.seed}:{number}")
        folder = self.root / "work"
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(self.sound, folder, copy_function=os.link)
        name = rng.choice(scene.damaged)
        data = (self.sound / name).read_bytes()
        others = [(self.sound / other).read_bytes() for other in sorted(set(scene.damaged))]
        changed = rng.choice(mutators.mutators_of(name))(data, rng, others)
        (folder / name).unlink()  # a link to the sound one
        (folder / name).write_bytes(changed)
        return folder, name

    @staticmethod
    def names_a_file(scene, folder, line):
        """Status 2 is of a setting, which is named in its place."""
        inputs = [word for word in scene.arguments + scene.damaged if (folder / word).exists()]
        return any(pathlib.PurePath(word).name in line for word in inputs)

    def complaints(self, scene, before, folder, status, out, said, use):
        if status is None:
            return ["it hangs"]
        found = []
        if status not in STATUSES:
            found.append(f"status {status}")
        if "internal error" in said:
            found.append("internal error")
        if use.ru_maxrss << 10 > MOST_MEMORY:
            found.append(f"{use.ru_maxrss >> 10} MB of memory")
        after = {str(path.relative_to(folder)) for path in folder.rglob("*")}
        lost, new = before - after, after - before
        if lost:
            found.append(f"inputs that are gone: {sorted(lost)[:3]}")
        if any(name.endswith(LEFT_BEHIND) or "/." in f"/{name}" for name in new):
            found.append(f"temporary files: {sorted(new)[:3]}")
        if status in REFUSED:
            lines = [line for line in said.splitlines() if line.startswith("incise: ")]
            if len(lines) != 1:
                found.append(f"{len(lines)} lines that refuse")
            elif status == 3 and not self.names_a_file(scene, folder, lines[0]):
                found.append("no file is named")
            if out:
                found.append("a refusal with output")
            if new and not scene.keeps:
                found.append(f"left behind: {sorted(new)[:3]}")
        return found

    def case(self, number):
        scene = random.Random(f"{self.seed}:{number}:scene").choice(self.scenes)
        folder, name = self.damaged(scene, number)
        before = {str(path.relative_to(folder)) for path in folder.rglob("*")}
        status, out, said, use = self.run(folder, scene.arguments)
        self.statuses[status] += 1
        found = self.complaints(scene, before, folder, status, out, said, use)
        if found:
            kept = pathlib.Path(tempfile.mkdtemp(prefix="incise_finding_")) / pathlib.PurePath(name).name
            shutil.copy(folder / name, kept)
            self.findings.append(number)
            print(f"finding: case {number}, seed {self.seed}: {'; '.join(found)}\n  incise {' '.join(scene.arguments)}\n  {name} damaged: {kept}\n  {said.strip()[:600]}", flush=True)


def numbers_of(request):
    return [request.only] if request.only is not None else range(request.first, request.first + request.count)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--command", default=os.environ.get("INCISE_COMMAND"))
    parser.add_argument("--count", type=int, default=10000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int)
    request = parser.parse_args()
    if not request.command:
        parser.error("--command or INCISE_COMMAND: the built command")
    sys.path.insert(0, str(HERE))
    with tempfile.TemporaryDirectory(prefix="incise_command_fuzz_") as root:
        fuzzer = Fuzzer(str(pathlib.Path(request.command).resolve()), request.seed, pathlib.Path(root))
        for done, number in enumerate(numbers_of(request), 1):
            fuzzer.case(number)
            if done % 500 == 0:
                print(f"{done} cases, statuses {dict(sorted(fuzzer.statuses.items(), key=str))}, {len(fuzzer.findings)} findings", flush=True)
    print(f"{sum(fuzzer.statuses.values())} cases, statuses {dict(sorted(fuzzer.statuses.items(), key=str))}, {len(fuzzer.findings)} findings")
    return 1 if fuzzer.findings else 0


if __name__ == "__main__":
    sys.exit(main())
