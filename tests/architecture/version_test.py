#!/usr/bin/env python3
"""The digest of the sources, which is part of every cache key: it changes with any source, committed or not, and with nothing else."""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(sys.argv.pop(1)) / "cmake" / "InciseVersion.cmake"


class SourceDigest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.tree = pathlib.Path(folder.name)
        self.write("src/core/cut.cpp", "int depth_mm = 5;")
        self.write("include/incise/cut.hpp", "extern int depth_mm;")

    def write(self, name, text):
        file = self.tree / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)

    def answers(self):
        written = self.tree / "version.cpp"
        subprocess.run(["cmake", f"-DSOURCE_DIR={self.tree}", "-DVERSION=1.2.3", f"-DOUTPUT={written}", "-P", SCRIPT], check=True, capture_output=True)
        return dict(re.findall(r"(\w+)\(\) { return \"(.*?)\"", written.read_text()))

    def git(self, *arguments):
        subprocess.run(["git", "-C", self.tree, "-c", "user.name=test", "-c", "user.email=test@localhost", *arguments], check=True, capture_output=True)

    def test_differs_for_two_builds_of_one_commit_with_different_changes(self):
        self.git("init")
        self.git("add", ".")
        self.git("commit", "-m", "Cut")
        committed = self.answers()
        self.write("src/core/cut.cpp", "int depth_mm = 4;")
        one = self.answers()
        self.write("src/core/cut.cpp", "int depth_mm = 3;")
        other = self.answers()
        self.assertEqual(one["source_commit"], committed["source_commit"] + "-dirty")
        self.assertEqual(one["source_commit"], other["source_commit"])
        self.assertEqual(len({build["source_digest"] for build in (committed, one, other)}), 3)

    def test_differs_without_a_repository_and_with_new_or_renamed_sources(self):
        digests = [self.answers()["source_digest"]]
        self.write("src/core/burn.inc", "")
        digests.append(self.answers()["source_digest"])
        (self.tree / "src/core/burn.inc").rename(self.tree / "src/core/heat.inc")
        digests.append(self.answers()["source_digest"])
        self.assertEqual(self.answers()["source_commit"], "unknown")
        self.assertEqual(len(set(digests)), 3)

    def test_is_the_same_whatever_else_changes(self):
        digest = self.answers()["source_digest"]
        self.write("docs/page.md", "A page.")
        self.write("tests/core/cut_test.cpp", "int main() {}")
        self.assertEqual(self.answers()["source_digest"], digest)


if __name__ == "__main__":
    unittest.main()
