#!/usr/bin/python3
"""What a person sees while it works: lines now and then, a line at the bottom of a terminal, what was written."""
import os
import pty
import re
import subprocess

from support import GPU, LAUNCHES, RAYCACHE, SCENE, ProgramTest, main

LINE = r"raycache: compare: \d+ %, \d+ s left( \([a-z ]+(, [0-9.]+ [kMG]?rays/s)?\))?"
COMPARE = ["compare", "--scene", *SCENE, "--resolution", "192x192", "--trace-samples", "4", *GPU]


class Progress(ProgramTest):
    def test_without_a_terminal_lines_come_now_and_then(self):
        result = self.run_program(*COMPARE, env={**os.environ, "RAYCACHE_PROGRESS_SECONDS": "0.05"})
        self.assertEqual(result.code, 0)
        lines = [line for line in result.stderr.splitlines() if not line.startswith("raycache: warning")]
        self.assertGreater(len(lines), 3, result)
        for line in lines:
            self.assertRegex(line, rf"\A{LINE}\Z")
        shares = [int(re.search(r"(\d+) %", line)[1]) for line in lines]
        self.assertLess(shares[0], shares[-1])
        self.assertGreater(shares[-1], 50)  # of the whole command, not of its last stage

    def test_by_default_a_short_run_says_nothing(self):
        environment = {k: v for k, v in os.environ.items() if k != "RAYCACHE_PROGRESS_SECONDS"}
        self.succeeds("compare", "--scene", *SCENE, *LAUNCHES, *GPU, env=environment)

    def test_a_terminal_shows_one_line_that_is_gone_at_the_end(self):
        ours, theirs = pty.openpty()
        process = subprocess.Popen([RAYCACHE, *COMPARE, "--save", "c"], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=theirs)
        os.close(theirs)
        shown = b""
        try:
            while piece := os.read(ours, 65536):
                shown += piece
        except OSError:  # the other end is closed
            pass
        self.assertEqual(process.wait(), 0)
        text = shown.decode()
        self.assertRegex(text, r"\r\x1b\[Kcompare \[#*\.*\] +\d+ %  \d+ s left")
        self.assertRegex(text, r"(?s)\r\x1b\[K(raycache: [^\n]*\n)*\r\x1b\[K\Z|\r\x1b\[K(raycache: [^\n]*\n)*\Z")

    def test_every_file_written_is_named_with_its_size(self):
        result = self.succeeds("compare", "--scene", *SCENE, *LAUNCHES, *GPU, "--save", "c")
        self.assertEqual(result.wrote, [f"raycache: wrote c{end}, {self.size('c' + end)}\n" for end in (".txt", ".json", ".csv")])
        result = self.succeeds("capture", *SCENE, *LAUNCHES, "--spp", "64", "-o", "t.rct")
        self.assertEqual(result.wrote, [f"raycache: wrote t.rct, {self.size('t.rct')}\n"])
        self.assertEqual(self.succeeds("capture", *SCENE, *LAUNCHES, "--spp", "64", "-o", "-").wrote, [])

    def size(self, name):
        size = self.path(name).stat().st_size
        if size < 10240:
            return f"{size} bytes"
        kib = size / 1024
        return f"{kib:.1f} KiB" if kib < 10 else f"{kib:.0f} KiB" if kib < 1024 else f"{kib / 1024:.1f} MiB"


if __name__ == "__main__":
    main()
