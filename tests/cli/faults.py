#!/usr/bin/python3
"""What the system can do to an output: a full disk, a stdout that is closed or gone, a folder that is read-only, pipes
that nobody reads or writes. Every result that can be delivered is, and the rest is one line each."""
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import threading
import time
import unittest

from support import GPU, GPU_FILE, LAUNCHES, RAYCACHE, ROOT, SCENE, ProgramTest, main

SMALL = ["--resolution", "16x16", "--trace-samples", "2"]
SECTORS = ["--gpu", "h100", "--sm", "0", "--launch", "0", "--format", "csv"]
QUALITY = ["quality", *SCENE, "--resolution", "16x16", "--spp", "2", "--reference-spp", "4", "--strategy",
           "coherent,cranley-patterson"]
POINTS = ["samples", "--spp", "8", "--copies", "4"]


def at_most(size):
    """No file may grow beyond this: what a full disk does."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


def without(*descriptors):
    return lambda: [os.close(d) for d in descriptors]


class Faults(ProgramTest):
    def setUp(self):
        super().setUp()
        self.environment = {**os.environ, "XDG_CACHE_HOME": str(self.path("cache"))}

    def small_trace(self, name):
        self.succeeds("capture", *SCENE, *SMALL, "--spp", "64", "-o", name)

    def writing_commands(self):
        """What writes files, and which. Their inputs are made first."""
        self.succeeds("capture", *SCENE, *SMALL, "-o", "in.rct")
        self.succeeds("export", "in.rct", "--launch", "0", "--format", "accel-sim", "-o", "in.traceg")
        self.path("pictures").mkdir()
        return {
            "capture": (["capture", *SCENE, *SMALL, "-o", "t.rct"], ["t.rct"]),
            "render": (["render", *SCENE, "--resolution", "16x16", "--spp", "1", "-o", "t.png"], ["t.png"]),
            "replay": (["replay", "in.rct", *GPU, "--save", "t"], ["t.csv", "t.json", "t.txt"]),
            "compare": (["compare", "--scene", *SCENE, *SMALL, *GPU, "--exact", "--save", "c"], ["c.csv", "c.json", "c.txt"]),
            "explain": (["explain", "in.rct", "in.rct", *GPU, "--heatmap", "h.exr"], ["h.exr", "h.png"]),
            "quality": ([*QUALITY, "--reference", "r.exr", "--output", "pictures"], ["pictures/index.png", "r.exr"]),
            "export": (["export", "in.rct", *SECTORS, "-o", "s.csv"], ["s.csv"]),
            "accel-sim": (["export", "in.rct", "--launch", "0", "--format", "accel-sim", "-o", "kernel.traceg.xz"],
                          ["kernel.traceg.xz"]),
            "import": (["import", "in.traceg", "-o", "i.rct"], ["i.rct"]),
            "recover": (["verify", "in.rct", "--recover", "v.rct"], ["v.rct"]),
            "samples": ([*POINTS, "--csv", "p.csv", "--picture", "p.png"], ["p.csv", "p.png"]),
        }

    def errors_of(self, result, code=1):
        """The lines that say what went wrong; other lines are warnings, or say what was written."""
        self.assertEqual(result.code, code, result)
        lines = [line for line in result.stderr.splitlines()
                 if not line.startswith(("raycache: warning: ", "raycache: wrote "))]
        for line in lines:
            self.assertTrue(line.startswith("raycache: error: "), result)
        return lines


class FullDisk(Faults):
    def test_no_table_is_lost_no_partial_file_stays_and_every_file_is_named(self):
        for name, (command, files) in self.writing_commands().items():
            with self.subTest(name):
                before = self.listing()
                full = self.run_program(*command, preexec_fn=at_most(10), env=self.environment)
                errors = self.errors_of(full)
                self.assertEqual(self.listing(), before)
                for file in files:
                    self.assertTrue(any(f"{file}: offset" in e and "File too large" in e for e in errors), full)
                table = self.run_program(*command, env=self.environment)
                self.assertEqual(table.code, 0, table)
                if name != "recover":  # whose table is about the file
                    self.assertEqual(full.stdout, table.stdout)

    def test_a_file_that_does_not_fit_does_not_prevent_the_others(self):
        self.succeeds("compare", "--scene", *SCENE, *SMALL, *GPU, "--exact", "--save", "whole")
        whole = {end: self.path("whole" + end).read_bytes() for end in (".csv", ".json", ".txt")}
        most = max(whole, key=lambda end: len(whole[end]))
        result = self.run_program("compare", "--scene", *SCENE, *SMALL, *GPU, "--exact", "--save", "c",
                                  preexec_fn=at_most(len(whole[most]) - 1))
        error, = self.errors_of(result)
        self.assertIn("c" + most, error)
        self.assertEqual(result.stdout, whole[".txt"])
        for end, content in whole.items():
            if end == most:
                self.assertFalse(self.path("c" + end).exists())
            else:
                self.assertEqual(self.path("c" + end).read_bytes(), content)
                self.assertIn(f"raycache: wrote c{end}, ", result.stderr)

    def test_a_reference_that_cannot_be_kept_in_the_cache_is_a_warning(self):
        self.path("cache").mkdir()
        whole = self.warns(*QUALITY, env={**os.environ, "XDG_CACHE_HOME": str(self.path("other"))})
        full = self.run_program(*QUALITY, preexec_fn=at_most(10), env=self.environment)
        self.assertEqual(full.code, 0, full)
        self.assertRegex(full.stderr, r"(?m)^raycache: warning: the reference is not kept: .*File too large")
        self.assertEqual(full.stdout.splitlines()[:3], whole.stdout.splitlines()[:3])
        self.assertEqual([f for f in self.path("cache").rglob("*") if f.is_file()], [])


class Scripts(Faults):
    """tools/report.py and tools/plot_sweep write as the program does."""

    def test_a_page_that_does_not_fit_leaves_the_old_one_and_no_partial_file(self):
        self.succeeds("compare", "--scene", *SCENE, *SMALL, *GPU, "--exact", "--save", "c")
        self.path("page.html").write_text("old")
        before = self.listing()
        command = [sys.executable, ROOT / "tools/report.py", "c.json", "-o", "page.html"]
        full = subprocess.run(command, cwd=self.folder, stderr=subprocess.PIPE, check=False, preexec_fn=at_most(1000))
        self.assertEqual(full.returncode, 1)
        self.assertRegex(full.stderr.decode(), r"\Areport\.py: error: [^\n]*File too large[^\n]*\n\Z")
        self.assertEqual(self.path("page.html").read_text(), "old")
        self.assertEqual(self.listing(), before)
        self.path("page.html").chmod(0o640)
        subprocess.run(command, cwd=self.folder, check=True)
        self.assertIn("<html", self.path("page.html").read_text())
        self.assertEqual(self.path("page.html").stat().st_mode & 0o777, 0o640)
        self.assertEqual(self.listing(), before)


    def test_their_input_may_come_through_a_pipe_and_one_that_nobody_writes_is_refused(self):
        self.succeeds("compare", "--scene", *SCENE, *SMALL, *GPU, "--exact", "--save", "c")
        command = [sys.executable, ROOT / "tools/report.py", "pipe", "-o", "page.html"]
        os.mkfifo(self.path("pipe"))
        writer = threading.Thread(target=lambda: self.path("pipe").write_bytes(self.path("c.json").read_bytes()))
        writer.start()
        subprocess.run(command, cwd=self.folder, check=True, timeout=60)
        writer.join()
        self.assertIn("<html", self.path("page.html").read_text())
        result = subprocess.run(command, cwd=self.folder, stderr=subprocess.PIPE, check=False, timeout=60)
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr.decode(), r"\Areport\.py: error: pipe: [^\n]*found none[^\n]*\n\Z")


class Streams(Faults):
    def tables(self):
        self.small_trace("t.rct")
        return [["info", "t.rct"], ["verify", "t.rct", "--json"], ["replay", "t.rct", *GPU], ["list"], POINTS,
                ["explain", "t.rct", "t.rct", *GPU], QUALITY, ["--help"], ["--version"], ["replay", "--help"],
                ["export", "t.rct", *SECTORS, "-o", "-"], ["capture", *SCENE, *SMALL, "-o", "-"]]

    def check(self, why, **streams):
        for command in self.tables():
            with self.subTest(" ".join(command)):
                result = self.run_program(*command, env=self.environment, **streams)
                error, = self.errors_of(result)
                self.assertIn("stdout", error)
                self.assertRegex(error, why)

    def test_a_full_stdout_is_an_error_of_one_line(self):
        with open("/dev/full", "wb") as full:
            self.check("No space left on device", stdout=full)

    def test_a_stdout_that_nobody_reads_is_an_error_of_one_line(self):
        end, written = os.pipe()
        os.close(end)
        try:
            self.check("Broken pipe", stdout=written)
        finally:
            os.close(written)

    def test_a_closed_stdout_is_an_error_of_one_line(self):
        self.check("Bad file descriptor|closed", preexec_fn=without(1))

    def test_files_are_written_all_the_same(self):
        self.small_trace("t.rct")
        with open("/dev/full", "wb") as full:
            self.errors_of(self.run_program("replay", "t.rct", *GPU, "--save", "t", stdout=full))
        self.succeeds("replay", "t.rct", *GPU, "--save", "whole")
        for end in (".csv", ".json", ".txt"):
            self.assertEqual(self.path("t" + end).read_bytes(), self.path("whole" + end).read_bytes())

    def test_no_file_takes_the_place_of_a_closed_stream(self):
        whole = self.capture("whole.rct").read_bytes()
        for closed in ((1,), (2,), (0, 1), (0, 1, 2)):
            done = subprocess.run([RAYCACHE, "capture", *SCENE, *LAUNCHES, "--spp", "64", "-o", "t.rct"], check=False,
                                  cwd=self.folder, preexec_fn=without(*closed), stdout=subprocess.DEVNULL,
                                  stderr=subprocess.DEVNULL, timeout=300)
            self.assertEqual(done.returncode, 0)
            self.assertEqual(self.path("t.rct").read_bytes(), whole)

    def test_words_that_stderr_cannot_take_do_not_end_the_work(self):
        with open("/dev/full", "wb") as full:
            done = subprocess.run([RAYCACHE, "compare", "--scene", *SCENE, *SMALL, *GPU, "--exact", "--spp", "4", "--save", "c"],
                                  check=False, cwd=self.folder, stdout=subprocess.PIPE, stderr=full, timeout=300)
        self.assertEqual(done.returncode, 0)
        self.assertEqual(self.path("c.txt").read_bytes(), done.stdout)


class Folders(Faults):
    # So much work that a refusal after it would not come in time.
    LONG = ["--resolution", "4096x4096", "--spp", "4096"]

    def long_commands(self, folder):
        self.small_trace("in.rct")
        return [["capture", *SCENE, *self.LONG, "--trace-samples", "512", "-o", f"{folder}/t.rct"],
                ["render", *SCENE, *self.LONG, "-o", f"{folder}/t.png"],
                ["compare", "--scene", *SCENE, *self.LONG, "--trace-samples", "512", *GPU, "--save", f"{folder}/t"],
                ["explain", "--scene", *SCENE, *self.LONG, *GPU, "--heatmap", f"{folder}/t.exr"],
                ["quality", *SCENE, *self.LONG, "--output", f"{folder}/t"],
                ["quality", *SCENE, *self.LONG, "--reference", f"{folder}/r.exr"],
                ["replay", "in.rct", *GPU, "--save", f"{folder}/t"],
                ["export", "in.rct", *SECTORS, "-o", f"{folder}/t.csv"],
                ["export", "in.rct", "--launch", "0", "--format", "accel-sim", "-o", f"{folder}/t"],
                ["verify", "in.rct", "--recover", f"{folder}/t.rct"],
                ["samples", "--csv", f"{folder}/t.csv"]]

    @unittest.skipIf(os.geteuid() == 0 and not shutil.which("setpriv"),
                     "setpriv is absent, and root may write everywhere; apt-get install util-linux")
    def test_a_read_only_folder_is_refused_before_the_work(self):
        commands = self.long_commands("closed")
        self.path("closed").mkdir(mode=0o555)
        # Root without its capabilities, above all that of writing everywhere.
        drop = ["setpriv", "--bounding-set", "-all", "--inh-caps", "-all"] if os.geteuid() == 0 else []
        for command in commands:
            with self.subTest(" ".join(command)):
                result = subprocess.run([*drop, RAYCACHE, *command], cwd=self.folder, stdout=subprocess.PIPE, timeout=60,
                                        stderr=subprocess.PIPE, check=False, env=self.environment)
                self.assertEqual(result.returncode, 1, result)
                self.assertRegex(result.stderr.decode(),
                                 r"\Araycache: error: [^\n]*closed/[^\n]*ermission denied[^\n]*\n\Z")
                self.assertEqual(result.stdout, b"")
        self.assertEqual(list(self.path("closed").iterdir()), [])

    def test_a_folder_that_does_not_exist_is_refused_before_the_work(self):
        for command in self.long_commands("no"):
            if command[0] != "quality" or "--reference" in command:  # it makes the folder of its pictures
                with self.subTest(" ".join(command)):
                    self.refuses(1, *command, mentions=["no/"], timeout=60, env=self.environment)


class Pipes(Faults):
    def refusals(self, *commands):
        """Of commands that run at the same time, for each waits a few seconds."""
        before, results = self.listing(), {}

        def run(number, command):
            results[number] = self.run_program(*command, timeout=60, env=self.environment)

        threads = [threading.Thread(target=run, args=item) for item in enumerate(commands)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for number, command in enumerate(commands):
            with self.subTest(" ".join(command)):
                error, = self.errors_of(results[number])
                self.assertIn("pipe", error)
                self.assertEqual(results[number].stdout, b"")
        self.assertEqual(self.listing(), before)

    def test_a_pipe_that_nobody_reads_is_refused_before_the_work(self):
        self.small_trace("in.rct")
        os.mkfifo(self.path("pipe"))
        os.mkfifo(self.path("pipe.png"))
        os.mkfifo(self.path("pipe.csv"))
        self.refusals(["capture", *SCENE, *Folders.LONG, "-o", "pipe"], ["export", "in.rct", *SECTORS, "-o", "pipe"],
                      ["render", *SCENE, *Folders.LONG, "-o", "pipe.png"],
                      ["compare", "--scene", *SCENE, *Folders.LONG, *GPU, "--save", "pipe"])

    def test_a_pipe_that_nobody_writes_is_refused(self):
        self.small_trace("in.rct")
        for name in ("pipe", "pipe.glb", "pipe.toml", "pipe.exr", "pipe.traceg"):
            os.mkfifo(self.path(name))
        self.refusals(["info", "pipe"], ["verify", "pipe"], ["replay", "pipe", *GPU], ["replay", "in.rct", "--gpu", "pipe.toml"],
                      ["compare", "pipe", "in.rct", *GPU], ["import", "pipe.traceg", "-o", "x.rct"], ["import", "pipe", "-o", "x.rct"],
                      ["render", "pipe.glb", "--resolution", "4x4", "--spp", "1", "-o", "x.png"],
                      [*QUALITY, "--reference", "pipe.exr"])

    def test_a_gpu_file_may_come_through_a_pipe(self):
        self.small_trace("in.rct")
        self.path("tiny.toml").write_text(GPU_FILE)
        os.mkfifo(self.path("pipe.toml"))

        def write_late():
            time.sleep(0.3)
            with open(self.path("pipe.toml"), "w", encoding="utf-8") as pipe:
                pipe.write(GPU_FILE[:100])
                pipe.flush()
                time.sleep(0.2)
                pipe.write(GPU_FILE[100:])

        writer = threading.Thread(target=write_late)
        writer.start()
        piped = self.succeeds("replay", "in.rct", "--gpu", "pipe.toml")
        writer.join()
        self.assertEqual(piped.stdout, self.succeeds("replay", "in.rct", "--gpu", "tiny.toml").stdout)

    def test_a_reader_that_goes_away_is_an_error_of_one_line(self):
        os.mkfifo(self.path("pipe"))

        def read_a_little():
            with open(self.path("pipe"), "rb") as pipe:
                pipe.read(10)

        reader = threading.Thread(target=read_a_little)
        reader.start()
        error, = self.errors_of(self.run_program("capture", *SCENE, "--resolution", "256x256", "--spp", "8", "-o", "pipe"))
        reader.join()
        self.assertIn("pipe: offset", error)
        self.assertIn("Broken pipe", error)


if __name__ == "__main__":
    main()
