"""A cut that is interrupted goes on from its checkpoint and ends in the same files."""

import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import unittest

import small_case
from command import BAD_CASE, BAD_DATA, COMMAND, INTERRUPTED, NOT_ACCEPTABLE, CommandTest, files_below

# Some hundreds of steps: long enough to be met on its way.
LONG_CUT = {"cut": {"advance_per_step_mm": 0.4, "frames": 4}}


def without_times(value):
    """A result without how long it took and where it lies."""
    if isinstance(value, dict):
        return {key: without_times(item) for key, item in value.items() if key not in ("wall_s", "ms_per_step", "stages", "folder")}
    return value


class CheckpointTest(CommandTest):
    @classmethod
    def setUpClass(cls):
        """One run that nothing interrupts, on one thread: what all others are compared with."""
        temporary = tempfile.TemporaryDirectory(prefix="incise_cli_")
        cls.addClassCleanup(temporary.cleanup)
        cls.straight = pathlib.Path(temporary.name) / "out"
        case = small_case.write_case(pathlib.Path(temporary.name) / "case", LONG_CUT)
        done = subprocess.run([COMMAND, "run", case, "-o", cls.straight, "--threads", "1"], capture_output=True, text=True)
        # The block's mesh is far too coarse for its kerf to keep the close margin: the run is whole, and its verdict refuses a program.
        assert done.returncode == NOT_ACCEPTABLE, done.stderr

    def setUp(self):
        """The same case, already stretched and planned."""
        super().setUp()
        self.case = small_case.write_case(self.folder / "case", LONG_CUT)
        self.cache = self.out / "cache"
        self.checkpoint = self.cache / "as_planned.checkpoint.bin"
        self.cache.mkdir(parents=True)
        for product in ("stretched", "plan"):
            shutil.copytree(self.straight / product, self.out / product)
            shutil.copy(self.straight / "cache" / f"{product}.bin", self.cache)

    def stop(self, verb, checkpoint, stop_signal, *options):
        """The command with a checkpoint at every occasion, stopped by a signal once there is one."""
        return self.stopped((verb, "case", "-o", str(self.out), "--checkpoint-s", "0", *options), checkpoint.exists, stop_signal)

    def assert_same_cut(self, one, other):
        """Byte for byte, but for the time that it took and the record of the command."""
        self.assertEqual(files_below(one), files_below(other))
        for name in files_below(one):
            if name in ("manifest.json", "stage.json") or (one / name).is_dir():
                continue
            if name == "incision.json":
                self.assertEqual(*(without_times(json.loads((folder / name).read_text())) for folder in (one, other)))
            else:
                self.assertEqual((one / name).read_bytes(), (other / name).read_bytes(), name)

    def test_ctrl_c_leaves_a_checkpoint_and_resume_ends_in_the_same_files(self):
        done = self.stop("simulate", self.checkpoint, signal.SIGINT)
        self.assertEqual(done.returncode, INTERRUPTED, done.stderr)
        self.assertEqual(done.stdout, "")
        self.assertRegex(done.stderr, r"incise: the cut was interrupted after step \d+; its checkpoint "
                                      r"\S+as_planned\.checkpoint\.bin is kept\. Run the same command to continue\n")
        self.assertEqual({name.split("/")[0] for name in files_below(self.out)},
                         {"study.json", "stretched", "plan", "cache"})

        resumed = self.incise("simulate", "case", "-o", self.out, "--resume", "--threads", "2", status=NOT_ACCEPTABLE)
        self.assertRegex(resumed.stderr, r"simulate: continues after step \d+")
        self.assertFalse(self.checkpoint.exists(), "a cut that is finished needs none")
        self.assert_same_cut(self.out / "as_planned", self.straight / "as_planned")

    def test_a_checkpoint_beside_its_finished_cut_goes(self):
        self.stop("simulate", self.checkpoint, signal.SIGINT)
        left = self.checkpoint.read_bytes()
        self.assertEqual(self.incise("simulate", "case", "-o", self.out).returncode, NOT_ACCEPTABLE)
        self.checkpoint.write_bytes(left)  # as a run leaves it that is killed once the cut is in place, and before its checkpoint is removed
        self.assertEqual(self.incise("simulate", "case", "-o", self.out).returncode, NOT_ACCEPTABLE)
        self.assertFalse(self.checkpoint.exists(), "a cut that is finished needs none")

    def test_a_killed_run_goes_on_from_its_last_checkpoint(self):
        killed = self.stop("simulate", self.checkpoint, signal.SIGKILL)
        # Where the signal met it while it was writing, this is what it left.
        (self.cache / f".as_planned.checkpoint.bin.{killed.pid}.9.part").write_bytes(b"half a checkpoint")
        (self.out / f".as_planned.{killed.pid}.10.part").mkdir()
        alive = self.cache / f".as_planned.checkpoint.bin.{os.getpid()}.0.part"
        alive.write_bytes(b"of a process that runs")
        resumed = self.incise("simulate", "case", "-o", self.out)  # by itself
        self.assertEqual(resumed.returncode, NOT_ACCEPTABLE, resumed.stderr)
        self.assertIn("simulate: continues after step", resumed.stderr)
        self.assert_same_cut(self.out / "as_planned", self.straight / "as_planned")
        self.assertEqual([path for folder in (self.out, self.cache) for path in folder.iterdir() if path.name.startswith(".")], [alive])

    def test_run_goes_on_in_its_second_cut(self):
        done = self.stop("run", self.cache / "pass_1.checkpoint.bin", signal.SIGTERM)
        self.assertEqual(done.returncode, INTERRUPTED, done.stderr)
        resumed = self.incise("run", "case", "-o", self.out, status=NOT_ACCEPTABLE)
        self.assertIn("pass 1: continues after step", resumed.stderr)
        for product in ("as_planned", "corrected"):
            self.assert_same_cut(self.out / product, self.straight / product)
        for name in ("path.json", "history.csv", "errors.csv"):
            self.assertEqual((self.out / "correction" / name).read_bytes(), (self.straight / "correction" / name).read_bytes(), name)
        self.assertEqual([name for name in files_below(self.cache) if "pass_" in name or "checkpoint" in name], [])

    def test_a_run_stopped_in_its_third_cut_takes_the_pass_before_it_from_the_cache(self):
        done = self.stop("run", self.cache / "pass_2.checkpoint.bin", signal.SIGINT)
        self.assertEqual(done.returncode, INTERRUPTED, done.stderr)
        self.assertTrue((self.cache / "pass_1.bin").is_file())
        self.assertFalse((self.out / "correction").exists())
        resumed = self.incise("run", "case", "-o", self.out, "--resume", status=NOT_ACCEPTABLE)
        self.assertIn("pass 2: continues after step", resumed.stderr)
        self.assertNotIn("pass 1: continues", resumed.stderr)
        self.assert_same_cut(self.out / "corrected", self.straight / "corrected")

    def test_resume_without_a_checkpoint_is_refused(self):
        new = self.folder / "new"
        done = self.incise("simulate", "case", "-o", new, "--resume")
        self.assert_refused(done, BAD_CASE, "--resume", "no finished stretch", "an interrupted cut of this case", "Without --resume")
        self.assert_nothing_written(new)

    def test_resume_goes_on_with_the_cut_that_comes_next_and_no_other(self):
        self.stop("run", self.cache / "pass_1.checkpoint.bin", signal.SIGTERM)
        done = self.incise("simulate", "case", "-o", self.out, "--resume")
        self.assert_refused(done, BAD_CASE, "--resume", "cuts that are all finished", "Without --resume")
        (self.cache / "as_planned.bin").unlink()
        done = self.incise("run", "case", "-o", self.out, "--resume")
        self.assert_refused(done, BAD_CASE, "--resume", "no checkpoint of the cut as_planned")
        self.assertTrue((self.cache / "pass_1.checkpoint.bin").exists(), "it is left where it is")

    def test_a_checkpoint_of_other_settings_is_refused_by_resume_and_passed_over_without_it(self):
        self.stop("simulate", self.checkpoint, signal.SIGINT)
        left = self.checkpoint.read_bytes()
        small_case.write_case(self.case, {"cut": {"advance_per_step_mm": 0.8, "frames": 2, "dullness": 4}})
        done = self.incise("simulate", "case", "-o", self.out, "--resume")
        self.assert_refused(done, BAD_CASE, "--resume", "no checkpoint of the cut as_planned that fits")
        self.assertEqual(self.checkpoint.read_bytes(), left)
        done = self.incise("simulate", "case", "-o", self.out, status=NOT_ACCEPTABLE)
        self.assertIn("the cut starts from the beginning", done.stderr)

    def test_a_damaged_checkpoint_is_refused_by_resume_and_passed_over_without_it(self):
        self.stop("simulate", self.checkpoint, signal.SIGINT)
        whole = self.checkpoint.read_bytes()
        for name, damaged in (("cut short", whole[: len(whole) // 2]), ("one bit", whole[:5000] + bytes([whole[5000] ^ 1]) + whole[5001:]),
                              ("foreign", b"not a checkpoint at all"), ("empty", b"")):
            with self.subTest(damage=name):
                self.checkpoint.write_bytes(damaged)
                done = self.incise("simulate", "case", "-o", self.out, "--resume")
                if name == "foreign":
                    self.assert_refused(done, BAD_DATA, "as_planned.checkpoint.bin", "a file of another origin")
                else:
                    self.assert_refused(done, BAD_CASE, "no checkpoint of the cut as_planned that fits")
                self.assertEqual(self.checkpoint.read_bytes(), damaged)
        self.checkpoint.write_bytes(whole[: len(whole) // 2])
        done = self.incise("simulate", "case", "-o", self.out, status=NOT_ACCEPTABLE)
        self.assertIn("as_planned.checkpoint.bin: byte", done.stderr)
        self.assertIn("the cut starts from the beginning", done.stderr)
        self.assert_same_cut(self.out / "as_planned", self.straight / "as_planned")


class FramesTest(CommandTest):
    def setUp(self):
        super().setUp()
        small_case.write_case(self.folder / "case")

    def test_as_many_frames_as_asked_for_with_the_tool_beside_them(self):
        self.json_of("simulate", "case", "-o", self.out, "--frames", "5", status=NOT_ACCEPTABLE)
        cut = self.out / "as_planned"
        self.assertEqual((cut / "frames.pvd").read_text().count("<DataSet "), 5)
        self.assertEqual(len(list((cut / "frames").glob("frame_*.vtu"))), 5)
        tools = json.loads((cut / "frames" / "tool.json").read_text())["frames"]
        self.assertEqual(len(tools), 5)
        self.assertEqual([len(tools[0]["tip_mm"]), len(tools[0]["axis"])], [3, 3])
        self.assertEqual([tool["is_tool_in"] for tool in tools], [True] * 4 + [False])
        self.assertEqual(json.loads((cut / "manifest.json").read_text())["settings"]["cut.frames"], "5")

    def test_counts_that_are_none_are_refused(self):
        for count in ("0", "-1", "501", "2.5", "many", ""):
            with self.subTest(count=count):
                done = self.incise("simulate", "case", "-o", self.out, "--frames", count, status=BAD_CASE)
                self.assertIn("--frames", done.stderr)
                self.assert_nothing_written()


if __name__ == "__main__":
    unittest.main()
