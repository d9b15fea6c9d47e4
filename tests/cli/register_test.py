"""`incise register`, the slow tests: points in another order, and tissue that has settled."""

import math
import random
import unittest

from small_cloud import RegisterCase, hill, write_ply


class LongRegisterTest(RegisterCase):
    def test_the_order_of_the_points_does_not_matter(self):
        points = hill(1200, 1)
        ordered = self.json_of(*self.register())
        random.Random(9).shuffle(points)
        write_ply(self.folder / "a.ply", points)
        shuffled = self.json_of(*self.register())
        self.assertTrue(shuffled["converged"])
        self.assertAlmostEqual(shuffled["scale"], ordered["scale"], delta=5e-4)
        for row, other in zip(ordered["T_target_source"][:3], shuffled["T_target_source"][:3]):
            self.assertAlmostEqual(row[3], other[3], delta=0.1)

    def test_settling_is_reported_and_not_mistaken_for_a_shift(self):
        settled = [(x, y, z - 1.0 * math.exp(-((x - 6) ** 2 + y * y) / 200)) for x, y, z in hill(2500, 4)]
        write_ply(self.folder / "settled.ply", settled)
        write_ply(self.folder / "a.ply", hill(2500, 1))
        rigid = self.json_of(*self.register("--scale", "fixed", target="settled.ply"))
        found = self.json_of(*self.register("--scale", "fixed", "--settling-mm", 1, target="settled.ply"))
        self.assertEqual(rigid["settled_max_mm"], 0)
        self.assertAlmostEqual(found["settled_max_mm"], 1.0, delta=0.4)

        # A different centre of rotation would hide the shift, so the shift is measured at the middle of the hill.
        def shift(result):
            return math.hypot(*(row[2] * 14.0 + row[3] for row in result["T_target_source"][:2]))

        self.assertLess(shift(found), 0.6 * shift(rigid))


if __name__ == "__main__":
    unittest.main()
