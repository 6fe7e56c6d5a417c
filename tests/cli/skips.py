#!/usr/bin/python3
"""Skipped tests are named and counted: what test programs print, and what tools/test_summary.py makes of it."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
from xml.etree import ElementTree

from support import RAYCACHE, ROOT, main

PROGRAM = pathlib.Path(RAYCACHE).parent / "tests/traces_tests"
UNITTEST = '''
import sys, unittest
sys.path.insert(0, {folder!r})
from support import main
class Moon(unittest.TestCase):
    def test_shines(self): pass
    @unittest.skip("the moon is new; wait for a week")
    def test_is_full(self): pass
    def test_phases(self):
        for phase in range(3):
            with self.subTest(phase):
                if phase: self.skipTest("the moon is new; wait for a week")
    {more}
main()
'''


class Skips(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def summary(self, *programs):
        """Of programs (name, status, output): (exit code, lines of the summary)."""
        suite = ElementTree.Element("testsuite")
        for name, status, output in programs:
            case = ElementTree.SubElement(suite, "testcase", name=name, status=status)
            ElementTree.SubElement(case, "system-out").text = output
        ElementTree.ElementTree(suite).write(self.folder / "tests.xml")
        return self.summary_of(self.folder / "tests.xml")

    def summary_of(self, path):
        done = subprocess.run([sys.executable, ROOT / "tools/test_summary.py", path], stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL, text=True, check=False, timeout=60)
        return done.returncode, done.stdout.splitlines()

    def output(self, *command, **environment):
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False,
                              timeout=120, env=dict(os.environ, **environment))
        return ("fail" if done.returncode else "run"), done.stdout

    def test_programs_that_pass_fail_and_crash_are_added_up(self):
        catch_failed = "test cases:  6 |  3 passed |  2 failed | 1 failed as expected\nassertions: 10 | 8 passed | 2 failed\n"
        code, lines = self.summary(("a", "run", "All tests passed (12 assertions in 4 test cases)\n"),
                                   ("b", "fail", catch_failed), ("c", "fail", "Segmentation fault\n"),
                                   ("d", "run", "Ran 7 tests in 1.5s\n\nOK\n"),
                                   ("e", "fail", "Ran 3 tests in 1.5s\n\nFAILED (failures=1, errors=1)\n"))
        self.assertEqual((code, lines), (1, ["16 passed, 5 failed, 0 skipped"]))

    def test_all_green_is_exit_code_0(self):
        self.assertEqual(self.summary(("a", "run", "All tests passed (1 assertion in 1 test case)\n")),
                         (0, ["1 passed, 0 failed, 0 skipped"]))

    def test_nothing_run_is_a_failure(self):
        self.assertEqual(self.summary(), (1, ["0 passed, 0 failed, 0 skipped"]))
        self.assertEqual(self.summary_of(self.folder / "absent.xml"), (1, ["0 passed, 0 failed, 0 skipped"]))

    def test_what_is_skipped_is_named_with_its_remedy_before_the_last_line(self):
        line = 'SKIPPED {"test": "t%d", "missing": "no moon", "remedy": "wait"}\n'
        code, lines = self.summary(("p", "run", line % 1 + line % 2 + line % 1 +
                                    "All tests passed (9 assertions in 5 test cases)\n"))
        self.assertEqual(code, 0)
        self.assertEqual(lines, ["skipped; to run them, wait:", "  p: t1: no moon", "  p: t2: no moon",
                                 "3 passed, 0 failed, 2 skipped"])

    def test_skips_without_a_word_are_counted_too(self):
        code, lines = self.summary(("p", "run", "Ran 7 tests in 1.5s\n\nOK (skipped=2)\n"))
        self.assertEqual((code, lines[-1]), (0, "5 passed, 0 failed, 2 skipped"))
        self.assertIn("p: 2 tests", lines[1])

    def test_a_catch2_case_that_skips_a_part_is_skipped_unless_it_fails(self):
        code, lines = self.summary(("traces", *self.output(PROGRAM, "[.skips]")))
        self.assertEqual(code, 1)
        self.assertEqual(lines, [
            "skipped; to run them, wait for the night:",
            '  traces: skips: as a whole: a "moon" is absent',
            "skipped; to run them, wait for the day:",
            "  traces: skips: one section of two, the other passes: a sun is absent",
            "1 passed, 1 failed, 2 skipped"])

    def test_a_catch2_program_whose_cases_all_skip_is_green(self):
        code, lines = self.summary(("traces", *self.output(PROGRAM, "skips: as a whole")))
        self.assertEqual((code, lines[-1]), (0, "0 passed, 0 failed, 1 skipped"))

    def test_a_python_test_that_skips_is_named_and_counted_once(self):
        for more, expected in (("", "1 passed, 0 failed, 2 skipped"),
                               ("def test_falls(self): self.fail()", "1 passed, 1 failed, 2 skipped")):
            script = self.folder / "moon.py"
            script.write_text(UNITTEST.format(folder=str(ROOT / "tests/cli"), more=more))
            code, lines = self.summary(("cli_moon", *self.output(sys.executable, script)))
            self.assertEqual((code, lines[-1]), (int("1 failed" in expected), expected))
            self.assertEqual(lines[:-1], ["skipped; to run them, wait for a week:",
                                          "  cli_moon: Moon.test_is_full: the moon is new",
                                          "  cli_moon: Moon.test_phases: the moon is new"])


if __name__ == "__main__":
    main()
