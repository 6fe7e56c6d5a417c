#!/usr/bin/python3
"""The end of a run that was not meant: kill -9 at any moment, two runs that write the same files, Ctrl-C and kill. A
file under its final name is always whole, and what else remains is said."""
import os
import pathlib
import random
import signal
import subprocess
import time

from support import GPU, LAUNCHES, RAYCACHE, SCENE, ProgramTest, main

SEED = int(os.environ.get("RAYCACHE_FAULT_SEED", random.SystemRandom().randrange(2**32)))
SMALL = ["--resolution", "24x24", "--spp", "8"]
COMMANDS = {
    "capture": ["capture", *SCENE, *SMALL, "-o", "t.rct"],
    "compare": ["compare", "--scene", *SCENE, *SMALL, "--trace-samples", "1", *GPU, "--save", "c"],
    "quality": ["quality", *SCENE, "--resolution", "24x24", "--spp", "1", "--reference-spp", "4", "--strategy", "coherent",
                "--output", "pictures"],
}
LONG = ["--resolution", "2048x2048", "--spp", "64", "--trace-samples", "64"]


class Ends(ProgramTest):
    def setUp(self):
        super().setUp()
        self.environment = {**os.environ, "XDG_CACHE_HOME": str(self.path("cache"))}

    def start(self, command, **keywords):
        return subprocess.Popen([RAYCACHE, *command], cwd=self.folder, env=self.environment, stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, **keywords)

    def files(self):
        return {f.relative_to(self.folder).as_posix(): f for f in self.folder.rglob("*") if f.is_file()}

    def partials(self):
        return sorted(name for name in self.files() if name.endswith(".partial"))

    def finished(self):
        """The files under their final names, and what they hold."""
        return {name: f.read_bytes() for name, f in self.files().items() if not name.endswith(".partial")}

    def wait_for_partial(self, process, known=(), lasting=0.0):
        """`lasting`: for how many seconds it must have been there, longer than the try whether the output can be written."""
        deadline, since = time.monotonic() + 120, {}
        while process.poll() is None and time.monotonic() < deadline:
            now = time.monotonic()
            since = {name: since.get(name, now) for name in set(self.partials()) - set(known)}
            if any(now - first >= lasting for first in since.values()):
                return
            time.sleep(0.0005)


class Killed(Ends):
    """A hundred times. Half of the kills come at any moment, half while a file is being written."""

    def kill_often(self, name, times):
        print(f"\n  RAYCACHE_FAULT_SEED={SEED} repeats these kills", flush=True)
        chance, command = random.Random(f"{SEED} {name}"), COMMANDS[name]
        start = time.monotonic()
        self.warns(*command, env=self.environment)
        duration, whole = time.monotonic() - start, self.finished()
        for _ in range(times):
            for file in self.finished():
                if chance.random() < 0.8:  # or a file of an earlier run is replaced
                    self.path(file).unlink()
            known = self.partials()
            process = self.start(command)
            if chance.random() < 0.5:
                self.wait_for_partial(process, known)
                time.sleep(chance.random() * 0.003)
            else:
                time.sleep(chance.random() * duration)
            process.kill()
            process.communicate()
            for file, content in self.finished().items():
                self.assertEqual(content, whole[file], f"{file} is not whole")
        for file in self.finished():
            self.path(file).unlink()  # so that all are written once more, the cached reference too
        left = self.partials()
        done = self.warns(*command, env=self.environment)
        for partial in left:
            self.assertIn(f"{partial}: left unfinished", done.stderr)
        self.assertEqual(self.finished(), whole)
        return left

    def test_a_killed_capture_leaves_no_damaged_trace(self):
        left = self.kill_often("capture", 34)
        self.succeeds("verify", "t.rct")
        self.assertTrue(left, "not one kill came while the trace was written")

    def test_a_killed_comparison_leaves_no_damaged_table(self):
        self.kill_often("compare", 33)

    def test_a_killed_quality_leaves_no_damaged_reference_nor_picture(self):
        self.kill_often("quality", 33)


class TwoWriters(Ends):
    def alone(self, command, files):
        self.warns(*command, env=self.environment)
        return [self.path(file).read_bytes() for file in files]

    def test_two_runs_with_one_output_both_write_a_whole_file_and_one_of_them_stays(self):
        pairs = [
            (["t.rct"], ["capture", *SCENE, "--resolution", "96x96", "-o", "t.rct", "--seed"]),
            (["t.csv", "t.json", "t.txt"],
             ["compare", "--scene", *SCENE, *SMALL, *GPU, "--exact", "--strategy", "micro-jitter", "--save", "t", "--seed"]),
            (["t.exr"], ["render", *SCENE, "--resolution", "96x96", "--spp", "1", "--strategy", "random", "-o", "t.exr", "--seed"]),
        ]
        for files, command in pairs:
            first, second = (self.alone([*command, seed], files) for seed in ("1", "2"))
            self.assertNotEqual(first, second)
            for pause in (0, 0.02, 0.1):
                with self.subTest(command[0], pause=pause):
                    runs = [self.start([*command, "1"])]
                    time.sleep(pause)
                    runs.append(self.start([*command, "2"]))
                    for run in runs:
                        _, words = run.communicate(timeout=300)
                        self.assertEqual(run.returncode, 0, words)
                        self.assertNotIn(b"left unfinished", words)  # what another run is writing is not left behind
                    for file, *contents in zip(files, first, second):
                        self.assertIn(self.path(file).read_bytes(), contents)
                    self.assertEqual(self.partials(), [])


class Interrupted(Ends):
    def interrupt(self, number, command, ready):
        process = self.start(command)
        self.wait_for_partial(process, lasting=0.3) if ready is None else ready(process)
        process.send_signal(number)
        stdout, stderr = process.communicate(timeout=60)
        self.assertEqual(process.returncode, -number, stderr)
        self.assertEqual(stdout, b"")
        lines = [line for line in stderr.decode().splitlines() if not line.startswith(("raycache: warning: ", "raycache: wrote"))]
        self.assertEqual(len(lines), 1, stderr)
        return lines[0]

    def test_a_signal_ends_the_run_by_that_signal_and_says_what_remains(self):
        for number, name in ((signal.SIGINT, "SIGINT"), (signal.SIGTERM, "SIGTERM"), (signal.SIGHUP, "SIGHUP")):
            with self.subTest(name):
                words = self.interrupt(number, ["capture", *SCENE, *LONG, "-o", "t.rct"], None)
                self.assertRegex(words, rf"\Araycache: [^;]*{name}[^;]*; no file was written; unfinished and removed: "
                                        r"t\.rct\.\d+-[0-9a-f]{8}\.partial; .*run the same command again\Z")
                self.assertEqual(self.listing(), [])

    def test_an_interrupted_quality_says_that_its_reference_is_kept(self):
        def reference_is_there(process):
            deadline = time.monotonic() + 120
            while process.poll() is None and time.monotonic() < deadline and not self.finished():
                time.sleep(0.01)
            time.sleep(0.2)

        words = self.interrupt(signal.SIGINT, ["quality", *SCENE, "--resolution", "64x64", "--reference-spp", "2", "--spp", "262144"],
                               reference_is_there)
        reference, = self.finished()
        self.assertRegex(words, rf"whole files: .*{reference}; the reference .*{reference} is kept: the same command")

    def test_a_signal_that_the_parent_ignores_stays_ignored(self):
        whole = self.capture("whole.rct").read_bytes()
        process = self.start(["capture", *SCENE, *LAUNCHES, "--spp", "64", "-o", "t.rct"],
                             preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
        self.wait_for_partial(process)
        process.send_signal(signal.SIGHUP)
        process.communicate(timeout=300)
        self.assertEqual(process.returncode, 0)
        self.assertEqual(self.path("t.rct").read_bytes(), whole)


if __name__ == "__main__":
    main()
