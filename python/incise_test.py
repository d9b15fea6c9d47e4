"""The Python module on a small block: numbers as the command gives them, arrays that fit together, exceptions with names."""

import pathlib
import signal
import tempfile
import threading
import time
import unittest

import incise
import numpy as np
import small_case


class InciseTest(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="incise_python_")
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def load(self, changes=None):
        return incise.load_case(small_case.write_case(self.folder / "case", changes))

    def test_a_case_shows_its_settings(self):
        case = self.load({"plan": {"depth_mm": 4.5}})
        self.assertEqual(case.title, "Test block")
        self.assertEqual(case.file, self.folder / "case" / "case.yaml")
        self.assertEqual(case.settings["plan.depth_mm"], "4.5")

    def test_a_simulation_gives_numbers_and_arrays_that_fit_together(self):
        cut = incise.simulate(self.load(), self.folder / "out")
        vertices, tets = small_case.block()
        self.assertEqual(cut["outcome"], "success")
        self.assertTrue(cut["closed_loop"])
        self.assertEqual(cut["target_mm"], 5.0)
        self.assertGreater(cut["abs_error_mm"]["mean"], 0.0)
        np.testing.assert_allclose(cut["vertices_mm"], np.array(vertices), atol=1e-12)
        np.testing.assert_array_equal(cut["tets"], np.array(tets))
        self.assertEqual(cut["stretched_mm"].shape, (len(vertices), 3))
        displacement = cut["stretched_mm"] - cut["vertices_mm"]
        front = cut["vertices_mm"][:, 1] < 1.0
        np.testing.assert_allclose(displacement[front], np.broadcast_to([0.0, -20.0, 0.0], displacement[front].shape), atol=1e-9)
        for name in ("centerline_mm", "inner_edge_mm"):
            self.assertEqual(cut[name].dtype, np.float64)
            self.assertEqual(cut[name].shape[1], 3)
            self.assertTrue(np.isfinite(cut[name]).all())
        self.assertEqual(cut["tets"].dtype, np.int32)
        removed = cut["removed_tets"]
        self.assertEqual(removed.dtype, np.int32)
        self.assertEqual(len(np.unique(removed)), len(removed))
        self.assertTrue((removed >= 0).all() and (removed < len(tets)).all())

        again = incise.simulate(self.load(), self.folder / "out", threads=1)  # from what the folder holds
        np.testing.assert_array_equal(again["removed_tets"], removed)
        np.testing.assert_array_equal(again["centerline_mm"], cut["centerline_mm"])

    def test_what_the_case_gets_wrong_is_a_case_error_and_a_bad_file_a_data_error(self):
        with self.assertRaisesRegex(incise.CaseError, "youngs_modulus_kpa"):
            self.load({"specimen": {"material": {"youngs_modulus_kpa": -1}}})
        case = self.load()
        (self.folder / "case" / "tumor.csv").unlink()
        with self.assertRaisesRegex(incise.DataError, "tumor.csv"):
            incise.simulate(case, self.folder / "out")
        with self.assertRaises(incise.DataError):
            incise.load_case(self.folder / "nowhere")
        with self.assertRaises(incise.InvalidArgument):
            incise.simulate(self.load(), self.folder / "out", threads=-1)
        self.assertTrue(issubclass(incise.CaseError, incise.Error) and issubclass(incise.Error, RuntimeError))

    def test_ctrl_c_stops_and_other_threads_run_meanwhile(self):
        case = self.load({"cut": {"advance_per_step_mm": 0.1}})
        ticks = []

        def interrupt_during_the_cut():
            deadline = time.monotonic() + 120
            while not (self.folder / "out" / "plan").exists() and time.monotonic() < deadline:
                ticks.append(time.monotonic())
                time.sleep(0.01)
            signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)

        other = threading.Thread(target=interrupt_during_the_cut)
        other.start()
        try:
            with self.assertRaises(KeyboardInterrupt):
                incise.simulate(case, self.folder / "out")
        finally:
            other.join()
        self.assertGreater(len(ticks), 1, "the other thread was held up")
        self.assertEqual(sorted(entry.name for entry in (self.folder / "out").iterdir()), ["cache", "plan", "stretched"])


if __name__ == "__main__":
    unittest.main()
