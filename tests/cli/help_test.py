"""What the command says of itself."""

import json
import re
import unittest

from command import BAD_CASE, DONE, CommandTest

VERBS = ["assess", "bench", "demo", "run", "phantom", "segment", "mesh", "deform", "plan", "simulate", "compensate", "calibrate", "evaluate", "export", "register", "report", "schema", "surface", "verify", "replay", "track", "project", "power", "compare", "audit"]


class HelpTest(CommandTest):
    def test_every_verb_is_listed(self):
        done = self.incise("--help")
        self.assertEqual(done.returncode, DONE)
        listed = done.stdout[done.stdout.index("Subcommands:"):]
        for verb in VERBS:
            self.assertRegex(listed, rf"(?m)^  {verb} ")

    def test_the_help_of_every_verb_ends_with_an_example_of_it(self):
        for verb in VERBS:
            with self.subTest(verb=verb):
                done = self.incise(verb, "--help")
                self.assertEqual(done.returncode, DONE)
                *_, heading, example = [line for line in done.stdout.splitlines() if line.strip()]
                self.assertEqual(heading, "Example:")
                self.assertTrue(example.startswith(f"  incise {verb} "), example)

    def test_help_is_a_word_too(self):
        self.assertEqual(self.incise("help").stdout, self.incise("--help").stdout)
        for words in (["run"], ["bench", "make"]):
            done = self.incise("help", *words)
            self.assertEqual(done.returncode, DONE)
            self.assertEqual(done.stdout, self.incise(*words, "--help").stdout)
            self.assertIn("Example:", done.stdout)
        self.assert_refused(self.incise("help", "rnu"), BAD_CASE, "'rnu'", "Did you mean 'run'?")

    def test_the_version_is_one_line(self):
        done = self.incise("--version")
        self.assertEqual(done.returncode, DONE)
        self.assertRegex(done.stdout, r"^incise \d+\.\d+\.\d+ \(\S+\)\n$")

    def test_the_schema_is_json_and_the_defaults_name_it(self):
        schema = json.loads(self.incise("schema", "case").stdout)
        self.assertEqual(schema["title"], "incise.case/1")
        self.assertRegex(self.incise("schema", "case", "--defaults").stdout, re.compile(r"^schema: incise\.case/1\b"))


if __name__ == "__main__":
    unittest.main()
