"""Faults that come from outside: streams that take nothing, pipes in place of files, names that are not UTF-8, a second writer, foreign files."""

import fcntl
import json
import os
import pathlib
import subprocess

import small_case
from command import BAD_CASE, BAD_DATA, COMMAND, DONE, CommandTest, files_below

LATIN = b"caf\xe9"


class StreamsTest(CommandTest):
    def status_with(self, redirection, *arguments):
        line = '"$0" "$@" ' + redirection
        return subprocess.run(["sh", "-c", line, COMMAND, *arguments], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)

    def test_what_cannot_be_printed_is_no_success(self):
        for redirection, says in ((">/dev/full", "no space left"), (">&-", "closed")):
            for arguments in (("schema", "case"), ("--help",), ("--version",), ("schema", "--defaults", "case")):
                done = self.status_with(redirection, *arguments)
                self.assertEqual(done.returncode, BAD_DATA, (redirection, arguments, done))
                self.assertIn("standard output", done.stderr)
                self.assertIn(says, done.stderr)

    def test_a_reader_that_went_away_is_no_success(self):
        read, write = os.pipe()
        os.close(read)
        done = subprocess.run([COMMAND, "schema", "case"], cwd=self.folder, stdout=write, stderr=subprocess.PIPE, text=True, check=False)
        os.close(write)
        self.assertEqual(done.returncode, BAD_DATA, done.stderr)
        self.assertIn("broken pipe", done.stderr)

    def test_messages_that_nobody_can_read_stop_nothing(self):
        small_case.write_case(self.folder / "case")
        for redirection in ("2>/dev/full", "2>&-", "0<&-"):
            done = self.status_with(redirection, "plan", "case", "-o", "out", "--json")
            self.assertEqual(done.returncode, DONE, redirection)
            self.assertIsInstance(json.loads(done.stdout), dict)
        self.assertEqual(self.status_with("2>/dev/full", "plan", "nowhere").returncode, BAD_DATA)

    def test_a_closed_output_is_found_before_anything_is_written(self):
        small_case.write_case(self.folder / "case")
        self.assertEqual(self.status_with(">&-", "plan", "case", "-o", "out").returncode, BAD_DATA)
        self.assert_nothing_written()


class FullDiskTest(CommandTest):
    def test_a_specimen_that_finds_no_room_is_refused_whole(self):
        for form in ("dicom", "nrrd", "nifti"):
            line = 'trap "" XFSZ; ulimit -f 16; exec "$0" "$@"'  # 512-byte blocks: a slice is longer
            done = subprocess.run(["sh", "-c", line, COMMAND, "phantom", "--format", form, "-o", "specimen"], cwd=self.folder, capture_output=True, text=True, check=False)
            self.assert_refused(done, BAD_DATA)
            self.assert_nothing_written(self.folder / "specimen")


class NamesTest(CommandTest):
    def test_names_on_the_command_line(self):
        small_case.write_case(self.folder / "case")
        for words in ((b"plan", b"case", b"-o", LATIN), (b"plan", LATIN, b"-o", b"out"), (b"run", b"case", b"-o" + LATIN)):
            done = subprocess.run([COMMAND.encode(), *words], cwd=self.folder, capture_output=True, check=False)
            said = done.stderr.decode()
            self.assertEqual(done.returncode, BAD_CASE, said)
            for part in ("caf?", "0xE9", "expected UTF-8"):
                self.assertIn(part, said)
            self.assertEqual(done.stdout, b"")
            self.assertEqual([entry.name for entry in self.folder.iterdir()], ["case"])

    def test_a_folder_in_which_the_command_is_given(self):
        here = os.fsencode(self.folder) + b"/" + LATIN
        os.mkdir(here)
        small_case.write_case(self.folder / "case")
        done = subprocess.run([COMMAND, "plan", "../case", "-o", "out"], cwd=here, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, BAD_CASE, done.stderr)
        self.assertIn("working folder", done.stderr)
        self.assertEqual(os.listdir(here), [])

    def test_titles_and_names_in_the_case(self):
        case = small_case.write_case(self.folder / "case")
        sound = (case / "case.yaml").read_bytes()
        for before, after in ((b"Test block", LATIN), (b"tumor.csv", LATIN + b".csv")):
            (case / "case.yaml").write_bytes(sound.replace(before, after))
            done = self.incise("run", "case", "-o", "out")
            self.assert_refused(done, BAD_DATA, "case.yaml", "line", "0xE9", "UTF-8")
            self.assertNotIn("Remove", done.stderr)
            self.assert_nothing_written()
        (case / "case.yaml").write_bytes(sound.replace(b"Test block", "Zunge, größer".encode()))
        self.assertEqual(self.incise("plan", "case", "-o", "größe").returncode, DONE)


class WritersTest(CommandTest):
    """A folder that somebody else writes into, held here as the command holds it."""

    def setUp(self):
        super().setUp()
        small_case.write_case(self.folder / "case")
        self.out.mkdir()
        self.held = os.open(self.out, os.O_RDONLY)
        self.addCleanup(os.close, self.held)
        fcntl.flock(self.held, fcntl.LOCK_EX)

    def test_a_second_one_is_refused_in_one_sentence(self):
        for words in (("run", "case"), ("plan", "case"), ("deform", "case"), ("simulate", "case"), ("compensate", "case"), ("experiment", "--quick"),
                      ("power", "--speed-mm-s", "7"), ("report", "out")):
            done = self.incise(*words, "-o", "out" if words[0] != "report" else "page.html")
            self.assert_refused(done, BAD_DATA, "out: found a folder that process", str(os.getpid()), "no other run writes into")
            self.assertEqual(files_below(self.out), [])

    def test_afterwards_it_is_free(self):
        fcntl.flock(self.held, fcntl.LOCK_UN)
        self.assertEqual(self.incise("plan", "case", "-o", "out").returncode, DONE)
        fcntl.flock(self.held, fcntl.LOCK_EX | fcntl.LOCK_NB)  # no longer held by the command
        self.assertFalse([name for name in files_below(self.out) if "lock" in name])


class ForeignFilesTest(CommandTest):
    def setUp(self):
        super().setUp()
        self.case = small_case.write_case(self.folder / "case")
        self.elsewhere = self.folder / "elsewhere"
        self.elsewhere.mkdir()
        (self.elsewhere / "thesis.txt").write_text("mine")

    def assert_untouched(self):
        self.assertEqual(files_below(self.elsewhere), ["thesis.txt"])
        self.assertEqual((self.elsewhere / "thesis.txt").read_text(), "mine")

    def test_behind_links_in_the_output_folder(self):
        self.out.mkdir()
        for name in ("stretched", "plan", "program", "robust", "assessment"):
            (self.out / name).symlink_to(self.elsewhere)
            done = self.incise("plan", "case", "-o", "out")
            self.assert_refused(done, BAD_DATA, name, "found a link")
            self.assert_untouched()
            (self.out / name).unlink()
        (self.out / "study.json").unlink(missing_ok=True)
        (self.out / "figures").symlink_to(self.elsewhere)
        self.assert_refused(self.incise("run", "case", "-o", "out"), BAD_DATA, "figures", "found a link")
        self.assert_untouched()
        (self.out / "figures").unlink()
        for name in ("study.json", "report.html", "manifest.json"):
            (self.out / name).unlink(missing_ok=True)
            (self.out / name).symlink_to(self.elsewhere / "thesis.txt")
            self.assert_refused(self.incise("plan", "case", "-o", "out"), BAD_DATA, name, "found a link")
            self.assert_untouched()
            (self.out / name).unlink()

    def test_an_output_folder_that_is_a_link(self):
        self.out.symlink_to(self.elsewhere)
        for name in ("out", "out/"):
            self.assert_refused(self.incise("plan", "case", "-o", name), BAD_DATA, "out", "found a link")
        self.assert_untouched()

    def test_a_link_to_a_result_of_another_case(self):
        self.assertEqual(self.incise("plan", "case", "-o", "other").returncode, DONE)
        kept = files_below(self.folder / "other")
        self.out.mkdir()
        (self.out / "plan").symlink_to(self.folder / "other" / "plan")
        small_case.write_case(self.case, {"plan": {"depth_mm": 4}})  # another plan, which would take the place of that one
        self.assert_refused(self.incise("plan", "case", "-o", "out"), BAD_DATA, "plan", "found a link")
        self.assertEqual(files_below(self.folder / "other"), kept)

    def test_a_run_of_another_case_is_not_replaced_by_the_demo(self):
        self.assertEqual(self.incise("plan", "case", "-o", "out").returncode, DONE)
        kept = files_below(self.out)
        self.assert_refused(self.incise("demo", "-o", "out"), BAD_DATA, "study.json: case_file: found \"../case/case.yaml\"",
                            "the demo's own case", "Choose another place for the output")
        self.assertEqual(files_below(self.out), kept)

    def test_a_study_that_was_damaged_is_named_by_the_report(self):
        self.assertEqual(self.incise("plan", "case", "-o", "out").returncode, DONE)
        study = self.out / "study.json"
        good = json.loads(study.read_text())
        for damage, says in (({"case_file": 5}, "type must be string, but is number"), ({"stages": [7]}, "cannot use at() with number")):
            study.write_text(json.dumps({**good, **damage}))
            done = self.incise("report", "out", "-o", "page.html")
            self.assert_refused(done, BAD_DATA, f"study.json: found {says}", "expected the file as incise wrote it")
            self.assertNotIn("json.exception", done.stderr)

    def test_files_of_the_same_names(self):
        self.out.mkdir()
        for name, text in (("study.json", '{"by": "me"}'), ("report.html", "<html>my thesis</html>"),
                           ("manifest.json", '{"name": "my web app"}'), ("manifest.json", "{")):
            (self.out / name).write_text(text)
            self.assert_refused(self.incise("plan", "case", "-o", "out"), BAD_DATA, name, "another origin")
            self.assertEqual((self.out / name).read_text(), text)
            (self.out / name).unlink()
        page = self.out / "plan"
        page.mkdir()
        (page / "manifest.json").write_text('{"name": "web app", "files": ["manifest.json"]}')
        self.assert_refused(self.incise("plan", "case", "-o", "out"), BAD_DATA, "plan", "manifest.json of another origin")
        self.assertEqual(files_below(page), ["manifest.json"])

    def test_figures_of_a_thesis_and_a_page_beside_them(self):
        figures = self.out / "figures"
        figures.mkdir(parents=True)
        (figures / "contours.svg").write_text("my figure")
        self.assert_refused(self.incise("run", "case", "-o", "out"), BAD_DATA, "figures", "another origin")
        self.assertEqual(self.incise("plan", "case", "-o", "other").returncode, DONE)
        for page in (self.out / "report.html", self.out / "mine.html"):
            self.assert_refused(self.incise("report", "other", "-o", page), BAD_DATA, "figures", "another origin")
        (self.elsewhere / "page.html").write_text("<html>my thesis</html>")
        self.assert_refused(self.incise("report", "other", "-o", self.elsewhere / "page.html"), BAD_DATA, "page.html", "another origin")
        self.assertEqual((self.elsewhere / "page.html").read_text(), "<html>my thesis</html>")
        self.assertEqual((figures / "contours.svg").read_text(), "my figure")
        self.assertEqual(files_below(self.out), ["figures", "figures/contours.svg"])

    def test_the_root_of_all_files_is_no_output_folder(self):
        self.assert_refused(self.incise("plan", "case", "-o", "/"), BAD_CASE, "-o: found /")
        self.assert_refused(self.incise("plan", "case", "-o", "/../tmp/.."), BAD_CASE, "-o: found")

    def test_pipes_in_place_of_inputs(self):
        for name in ("case.yaml", "block.msh", "tumor.csv"):
            kept = (self.case / name).read_bytes()
            (self.case / name).unlink()
            os.mkfifo(self.case / name)
            self.assert_refused(self.incise("plan", "case", "-o", "out"), BAD_DATA, name)
            (self.case / name).unlink()
            (self.case / name).write_bytes(kept)
            self.assert_nothing_written()

    def test_advice_to_remove_results_only_where_they_are_damaged(self):
        self.assertEqual(self.incise("plan", "case", "-o", "out").returncode, DONE)
        quality = pathlib.Path(self.out, "plan", "path.json")
        quality.write_text("{")
        self.assert_refused(self.incise("plan", "case", "-o", "out"), BAD_DATA, "plan", "Remove the folder")
