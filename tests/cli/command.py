"""Runs the built `incise` command in a folder of its own, for the tests beside this file."""

import json
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

COMMAND = os.environ["INCISE_COMMAND"]

# Exit statuses of the command.
DONE, OWN_FAULT, BAD_CASE, BAD_DATA, NOT_ACCEPTABLE, INTERRUPTED = 0, 1, 2, 3, 4, 130


# No verdict depends on how long something takes: a machine may be as busy as it likes. A command hangs when, look after look, none of its
# processes runs, waits to run or waits for a disk, and none has used any processor time; one that never ends is stopped by its processor time.
LOOK_S = 1.0
IDLE_LOOKS = 180
MOST_CPU_S = 7200


def processes_of(session):
    """State and processor time of every process of a session."""
    found = []
    for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:  # it ended meanwhile
            continue
        if int(fields[3]) == session:
            found.append((fields[0], int(fields[11]) + int(fields[12])))
    return found


class Watch:
    """Finds out that the processes of a session no longer get anywhere."""

    def __init__(self, process):
        self.process, self.used, self.idle = process, -1, 0

    def look(self):
        processes = processes_of(self.process.pid)
        used = sum(time for _, time in processes)
        is_idle = used == self.used and all(state in "STtZ" for state, _ in processes)
        self.idle = self.idle + 1 if is_idle else 0
        self.used = used
        if self.idle < IDLE_LOOKS:
            return
        os.killpg(self.process.pid, signal.SIGKILL)
        raise AssertionError(f"it hangs: {IDLE_LOOKS} looks without a process that runs: {self.process.args}")


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

    def start(self, *arguments, cpu_s=MOST_CPU_S):
        """The command, in a session of its own. @param cpu_s: processor time after which the system ends it."""
        return subprocess.Popen([COMMAND, *map(str, arguments)], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                start_new_session=True, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (cpu_s, cpu_s)))

    def finished(self, process):
        """What `start` began, once it has ended."""
        watch = Watch(process)
        while True:
            try:
                out, said = process.communicate(timeout=LOOK_S)
                return subprocess.CompletedProcess(process.args, process.returncode, out, said)
            except subprocess.TimeoutExpired:
                watch.look()

    def wait_until(self, process, is_so):
        """Until `is_so()`, or the process has ended."""
        watch, next_look = Watch(process), time.monotonic() + LOOK_S
        while not is_so() and process.poll() is None:
            time.sleep(0.002)
            if time.monotonic() > next_look:
                watch.look()
                next_look = time.monotonic() + LOOK_S

    def stopped(self, arguments, is_so, stop_signal):
        """The command, sent a signal once `is_so()`. On a machine so busy that it ends before that, its output is put back, and it starts again."""
        before = self.folder / "before_it_was_stopped"
        if self.out.exists():
            shutil.copytree(self.out, before, symlinks=True)
        while True:
            process = self.start(*arguments)
            self.wait_until(process, is_so)
            is_met = is_so() and process.poll() is None
            if is_met:
                process.send_signal(stop_signal)
            done = self.finished(process)
            if not is_met and done.returncode != DONE and done.returncode != NOT_ACCEPTABLE:
                raise AssertionError(f"it ended before it could be stopped: {done.returncode} {done.stderr}")
            if is_met and done.returncode not in (DONE, NOT_ACCEPTABLE):
                shutil.rmtree(before, ignore_errors=True)
                done.pid = process.pid
                return done
            shutil.rmtree(self.out)
            if before.exists():
                shutil.copytree(before, self.out, symlinks=True)

    def incise(self, *arguments, status=None, cpu_s=MOST_CPU_S):
        """The command, once it has ended. @param status: the required exit status; None: any."""
        done = self.finished(self.start(*arguments, cpu_s=cpu_s))
        if status is not None:
            self.assertEqual(done.returncode, status, done.stderr)
        return done

    def interrupted(self, *arguments, after):
        """The command, asked to stop (as by Ctrl-C) once `after` stands on standard error."""
        process = self.start(*arguments)
        said = ""
        for line in process.stderr:
            said += line
            if after in line:
                process.send_signal(signal.SIGINT)
                break
        done = self.finished(process)
        done.stderr = said + done.stderr
        return done

    def json_of(self, *arguments, status=DONE):
        """The one JSON object that a command prints with --json."""
        result = json.loads(self.incise(*arguments, "--json", status=status).stdout)
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


class SharedStart:
    """For tests that begin with the same command: it runs for the first of a class, and the others get a copy of its folder, as any folder may be
    copied."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        temporary = tempfile.TemporaryDirectory(prefix="incise_cli_")
        cls.addClassCleanup(temporary.cleanup)
        cls.kept, cls.starts = pathlib.Path(temporary.name), {}

    def begin(self, *arguments, status=DONE):
        """The JSON that a command prints and its standard error, with self.folder as the command leaves it. It runs once per class for the same
        arguments, status and files."""
        here = str(self.folder)
        written = [self.folder / name for name in files_below(self.folder)]
        files = tuple((str(file).replace(here, "."), file.read_bytes().replace(here.encode(), b".")) for file in written if file.is_file())
        key = (" ".join(map(str, arguments)).replace(here, "."), status, files)
        if key in self.starts:
            copy, there, done = self.starts[key]
            shutil.copytree(copy, self.folder, dirs_exist_ok=True)
        else:
            copy, there, done = self.kept / str(len(self.starts)), here, self.incise(*arguments, "--json", status=status)
            shutil.copytree(self.folder, copy)
            self.starts[key] = (copy, there, done)
        return json.loads(done.stdout.replace(there, here)), done.stderr.replace(there, here)
