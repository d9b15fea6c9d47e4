"""Runs the built `incise` command in a folder of its own, for the tests beside this file."""

import json
import os
import pathlib
import signal
import subprocess
import tempfile
import unittest

COMMAND = os.environ["INCISE_COMMAND"]

# Exit statuses of the command.
DONE, OWN_FAULT, BAD_CASE, BAD_DATA, NOT_ACCEPTABLE, INTERRUPTED = 0, 1, 2, 3, 4, 130


class HandMadePaths:
    """For tests of `export` on paths that no simulation has cut: says so on the command line, as a user has to."""

    def incise(self, verb, *arguments, **options):
        accepted = ("--accept", "not_simulated") if verb == "export" else ()
        return super().incise(verb, *arguments, *accepted, **options)


def files_below(folder):
    """Every file and folder below a folder, hidden and temporary ones too, as sorted relative names."""
    folder = pathlib.Path(folder)
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))


class CommandTest(unittest.TestCase):
    """Each test works in `self.folder`, which is gone when it ends."""

    maxDiff = None

    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="incise_cli_")
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        self.out = self.folder / "out"

    def incise(self, *arguments, timeout=600):
        return subprocess.run([COMMAND, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True, timeout=timeout)

    def interrupted(self, *arguments, after):
        """The command, asked to stop (as by Ctrl-C) once `after` stands on standard error."""
        command = [COMMAND, *map(str, arguments)]
        with subprocess.Popen(command, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            said = ""
            for line in process.stderr:
                said += line
                if after in line:
                    process.send_signal(signal.SIGINT)
                    break
            out, rest = process.communicate(timeout=600)
        return subprocess.CompletedProcess(command, process.returncode, out, said + rest)

    def json_of(self, *arguments, status=DONE):
        """The one JSON object that a command prints with --json."""
        done = self.incise(*arguments, "--json")
        self.assertEqual(done.returncode, status, done.stderr)
        result = json.loads(done.stdout)
        self.assertIsInstance(result, dict)
        return result

    def assert_refused(self, done, status, *says):
        """Exit status as given, one line on standard error that holds all of `says`, nothing on standard output."""
        self.assertEqual(done.returncode, status, f"stdout: {done.stdout}\nstderr: {done.stderr}")
        lines = [line for line in done.stderr.splitlines() if line.startswith("incise: ")]
        self.assertEqual(len(lines), 1, done.stderr)
        for words in says:
            self.assertIn(words, lines[0])
        self.assertNotIn("internal error", lines[0])
        self.assertEqual(done.stdout, "")

    def assert_nothing_written(self, folder=None):
        folder = self.out if folder is None else folder
        self.assertFalse(folder.exists(), f"left behind: {folder} {files_below(folder) if folder.is_dir() else ''}")
        # No temporary name beside it either.
        self.assertEqual([p.name for p in folder.parent.glob(f"*{folder.name}*")] if folder.parent.is_dir() else [], [])
