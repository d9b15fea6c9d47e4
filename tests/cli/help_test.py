"""What the command says of itself."""

import json
import re
import unittest

from command import BAD_CASE, DONE, CommandTest

GROUPS = ["Start here:", "Plan and cut:", "Robot:", "Measure:", "Virtual experiments:", "Tools:"]


class HelpTest(CommandTest):
    def verbs(self):
        """All that it knows, as it names them to whoever asks for another."""
        return re.search(r"expected one of (.*)\. Did", self.incise("rnu").stderr)[1].split(", ")

    def test_every_verb_is_listed_in_a_group_in_one_line_that_fits_100_columns(self):
        done = self.incise("--help", status=DONE)
        lines = done.stdout[done.stdout.index("Start here:") : done.stdout.index("`incise help")].splitlines()
        self.assertEqual([line for line in lines if line.endswith(":")], GROUPS)
        listed = [line for line in lines if line.startswith("  ")]
        self.assertEqual(sorted(line.split()[0] for line in listed), sorted(self.verbs()))
        for line in listed:
            self.assertRegex(line, r"^  [a-z]+ +[A-Z].*[^.]$")
            self.assertLessEqual(len(line), 100, line)

    def test_the_experiment_has_its_old_name_too(self):
        done = self.incise("study", "--help")
        self.assertEqual((done.returncode, done.stdout), (DONE, self.incise("experiment", "--help").stdout))
        self.assertIn("also: study", self.incise("--help").stdout)

    def test_the_help_of_every_verb_ends_with_an_example_of_it(self):
        for verb in self.verbs():
            with self.subTest(verb=verb):
                done = self.incise(verb, "--help", status=DONE)
                *_, heading, example = [line for line in done.stdout.splitlines() if line.strip()]
                self.assertEqual(heading, "Example:")
                self.assertTrue(example.startswith(f"  incise {verb} "), example)

    def test_help_is_a_word_too(self):
        self.assertEqual(self.incise("help").stdout, self.incise("--help").stdout)
        for words in (["run"], ["bench", "make"]):
            done = self.incise("help", *words, status=DONE)
            self.assertEqual(done.stdout, self.incise(*words, "--help").stdout)
            self.assertIn("Example:", done.stdout)
        self.assert_refused(self.incise("help", "rnu"), BAD_CASE, "'rnu'", "Did you mean 'run'?")
        self.assertNotIn("Did you mean", self.incise("help", "foo").stderr)

    def test_the_help_says_what_happens_without_an_output(self):
        for words, says in ((["mesh"], " (required)"), (["bench", "make"], " (required)"), (["plan"], "; by default `out` in the case's folder"),
                            (["audit"], "; by default nothing is written")):
            said = re.sub(r"\s+", " ", self.incise(*words, "--help").stdout)
            self.assertIn("File or folder to write" + says, said)

    def test_the_version_is_one_line(self):
        done = self.incise("--version", status=DONE)
        self.assertRegex(done.stdout, r"^incise \d+\.\d+\.\d+ \(\S+\)\n$")

    def test_the_schema_is_json_and_the_defaults_name_it(self):
        schema = json.loads(self.incise("schema", "case").stdout)
        self.assertEqual(schema["title"], "incise.case/1")
        self.assertRegex(self.incise("schema", "case", "--defaults").stdout, re.compile(r"^schema: incise\.case/1\b"))
        self.assertNotRegex(self.incise("schema", "case", "--defaults").stdout, r"-0\b(?!\.)")


if __name__ == "__main__":
    unittest.main()
