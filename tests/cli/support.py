"""What the tests of the command line share: running raycache in an empty folder, and what a refusal must look like."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
RAYCACHE = os.environ.get("RAYCACHE", str(ROOT / "build/release/raycache"))

os.environ.setdefault("RAYCACHE_PROGRESS_SECONDS", "0")  # a slow machine must not add lines to stderr
os.environ.pop("RAYCACHE_BVH_CACHE", None)  # nor a cache files

# Small enough for a sanitizer build.
SCENE = ["courtyard", "--detail", "50000"]
PICTURE = ["--resolution", "64x48"]
LAUNCHES = PICTURE + ["--trace-samples", "2"]
GPU = ["--gpu", "gtx-980-ti"]
# What every JSON document begins with.
ENVELOPE = ["schema_version", "program", "version", "command", "command_line", "settings", "gpus", "traces"]
# Two SMs, and no times.
GPU_FILE = """
name = "tiny"
description = "A GPU for tests"
sms = { value = 2, source = "assumed" }
warps_per_sm = { value = 4, source = "assumed" }
warps_per_cta = { value = 4, source = "assumed" }
l1_per_sm = { value = 1, source = "assumed" }
""" + "".join(f"""
[{level}]
sets = {{ value = {sets}, source = "assumed" }}
ways = {{ value = 4, source = "assumed" }}
line_bytes = {{ value = 128, source = "assumed" }}
sector_bytes = {{ value = 32, source = "assumed" }}
index = {{ value = "modulo", source = "assumed" }}
policy = {{ value = "lru", source = "assumed" }}
""" for level, sets in (("l1", 16), ("l2", 64)))


class Result:
    def __init__(self, done):
        self.code = done.returncode
        self.stdout = done.stdout
        self.stderr = done.stderr.decode("utf-8", "replace")

    @property
    def text(self):
        return self.stdout.decode("utf-8")

    @property
    def json(self):
        return json.loads(self.stdout)

    @property
    def report(self):
        """The JSON without its envelope: what was found, not what was asked for."""
        return {key: value for key, value in self.json.items() if key not in ENVELOPE}

    def __repr__(self):
        return f"exit code {self.code}\n--- stdout\n{self.stdout[:2000]!r}\n--- stderr\n{self.stderr[:4000]}"


class ProgramTest(unittest.TestCase):
    """Each test has a folder of its own, which is also the current directory of the program."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="raycache test ")  # a space, as in "My Documents"
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def path(self, name):
        return self.folder / name

    def run_program(self, *arguments, timeout=300, **keywords):
        command = [RAYCACHE, *map(str, arguments)]
        keywords.setdefault("stdout", subprocess.PIPE)
        keywords.setdefault("cwd", self.folder)
        done = subprocess.run(command, stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, timeout=timeout, check=False,
                              **keywords)
        if done.stdout is None:
            done.stdout = b""
        return Result(done)

    def succeeds(self, *arguments, **keywords):
        """Runs; exit code 0 and not a word on stderr but what was written. Returns the result."""
        result = self.warns(*arguments, **keywords)
        self.assertEqual(result.stderr, "", f"unexpected words on stderr: {arguments}")
        return result

    def warns(self, *arguments, **keywords):
        """Runs; exit code 0 and nothing but warnings on stderr. Returns the result, without the lines "raycache: wrote
        FILE, SIZE" in `stderr`: those are in `wrote`."""
        result = self.run_program(*arguments, **keywords)
        self.assertEqual(result.code, 0, f"{arguments}: {result}")
        lines = result.stderr.splitlines(keepends=True)
        result.wrote = [line for line in lines if line.startswith("raycache: wrote ")]
        result.stderr = "".join(line for line in lines if line not in result.wrote)
        for line in result.stderr.splitlines():
            self.assertTrue(line.startswith("raycache: warning: "), f"{arguments}: {result}")
        return result

    def refuses(self, code, *arguments, mentions=(), warnings=False, **keywords):
        """Runs; the exit code, one line on stderr, nothing on stdout, and no file came or went. Returns the line."""
        before = self.listing()
        result = self.run_program(*arguments, **keywords)
        what = f"{' '.join(map(str, arguments))}: {result}"
        self.assertEqual(result.code, code, what)
        lines = result.stderr.splitlines()
        if warnings:
            lines = [line for line in lines if not line.startswith("raycache: warning: ")]
        self.assertEqual(len(lines), 1, what)
        self.assertTrue(lines[0].startswith("raycache: error: "), what)
        self.assertTrue(result.stderr.endswith("\n"), what)
        self.assertGreater(len(lines[0]), len("raycache: error: ") + 10, what)
        self.assertEqual(result.stdout, b"", what)
        self.assertEqual(self.listing(), before, what)
        for word in mentions:
            self.assertIn(str(word), lines[0])
        return lines[0]

    def listing(self):
        return sorted(str(p.relative_to(self.folder)) for p in self.folder.rglob("*"))

    def capture(self, name="trace.rct", *arguments):
        self.succeeds("capture", *SCENE, *LAUNCHES, "--spp", "64", *arguments, "-o", name)
        return self.path(name)


def real_scene(name):
    """Path of a real scene, in RAYCACHE_SCENES or beside the clone: no part of the project, so it may not exist. CMake
    labels files that call this as tests to run where there are none (tests/CMakeLists.txt)."""
    return pathlib.Path(os.environ.get("RAYCACHE_SCENES") or ROOT.parent / "shared" / "scenes") / name


def main():
    """Runs the tests. Reasons to skip read "what is missing; how to get it"; each becomes a line 'SKIPPED {JSON}', which
    tools/test_summary.py counts."""
    result = unittest.main(verbosity=2, exit=False).result
    failed = {test.id() for test, _ in result.failures + result.errors}
    for test, reason in result.skipped:
        name = getattr(test, "test_case", test).id().removeprefix("__main__.")
        missing, _, remedy = reason.partition("; ")
        if test.id() not in failed:
            print("SKIPPED", json.dumps({"test": name, "missing": missing, "remedy": remedy or "see the test"}),
                  file=sys.stderr)
    sys.exit(not result.wasSuccessful())
