#!/usr/bin/python3
"""cmake --install into an empty prefix: program, manuals, completion, documentation, report tools, Python package."""
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

from support import GPU, LAUNCHES, RAYCACHE, SCENE, ProgramTest, main

BUILD = pathlib.Path(RAYCACHE).resolve().parent
COMMANDS = ["render", "capture", "info", "verify", "replay", "compare", "explain", "quality", "sweep", "curve", "measure",
            "counters", "sensitivity", "export", "import", "samples", "list"]


@unittest.skipUnless((BUILD / "cmake_install.cmake").exists() and shutil.which("cmake"),
                     "the build folder of the program, or cmake; tools/build makes one")
class Install(ProgramTest):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="raycache install ")
        cls.addClassCleanup(folder.cleanup)
        cls.prefix = pathlib.Path(folder.name) / "a prefix"
        done = subprocess.run(["cmake", "--install", BUILD, "--prefix", cls.prefix], capture_output=True, text=True,
                              timeout=300, check=False)
        if done.returncode != 0:
            raise AssertionError(done.stdout + done.stderr)
        cls.words = done.stdout + done.stderr

    def installed(self, *command, **keywords):
        environment = {"PATH": f"{self.prefix}/bin:/usr/bin:/bin", "HOME": str(self.folder), "LANG": "C.UTF-8",
                       "MPLCONFIGDIR": str(self.folder)}
        environment.update({key: os.environ[key] for key in ("LSAN_OPTIONS", "UBSAN_OPTIONS") if key in os.environ})
        environment.update(keywords.pop("environment", {}))
        done = subprocess.run([str(word) for word in command], cwd=self.folder, env=environment, capture_output=True,
                              text=True, timeout=300, check=False, **keywords)
        self.assertEqual(done.returncode, 0, f"{command}: {done.stdout[-2000:]}{done.stderr[-2000:]}")
        return done.stdout

    def complete(self, *words):
        """What bash offers for the last of the words."""
        script = self.prefix / "share/bash-completion/completions/raycache"
        program = f'set -u; source "{script}"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _raycache || true; ' \
                  'printf "%s\\n" "${COMPREPLY[@]+"${COMPREPLY[@]}"}"'
        return self.installed("bash", "--noprofile", "--norc", "-c", program, "bash", "raycache", *words).split()

    def test_the_program_runs_from_any_folder_and_finds_what_it_loads(self):
        self.assertIn("gtx-980-ti", self.installed("raycache", "list", "gpus"))
        self.installed("raycache", "render", *SCENE, "--resolution", "16x16", "--spp", "1", "-o", "picture.png")
        self.assertTrue(self.path("picture.png").read_bytes().startswith(b"\x89PNG"))

    def test_manuals_of_the_program_and_of_every_subcommand_render(self):
        if not shutil.which("help2man") or not shutil.which("man"):
            self.assertIn("help2man is missing", self.words)
            self.skipTest("help2man or man; apt-get install help2man man-db")
        pages = sorted(page.name for page in (self.prefix / "share/man/man1").iterdir())
        self.assertEqual(pages, sorted(["raycache.1", *(f"raycache-{name}.1" for name in COMMANDS)]))
        for page in pages:
            text = self.installed("man", "--warnings", "-l", self.prefix / "share/man/man1" / page,
                                  environment={"MANWIDTH": "90", "MANPAGER": "cat"})
            name = page.removesuffix(".1")
            self.assertRegex(text, rf"NAME\n +{name} +- +\w")
            self.assertIn("SEE ALSO", text)
            self.assertRegex(text, r"EXAMPLES\n( +raycache .*\n)")
            if name != "raycache":
                command = name.removeprefix("raycache-")
                self.assertRegex(text, rf"raycache {command} ")
                for option in re.findall(r"--[a-z-]{3,}", self.succeeds(command, "--help").text.split("Examples:")[0]):
                    self.assertIn(option, text.replace("\u2010", "-"), name)

    def test_bash_completes_subcommands_options_names_and_files(self):
        self.assertEqual(set(self.complete("")), set(COMMANDS))
        self.assertEqual(self.complete("expl"), ["explain"])
        self.assertEqual(self.complete("compare", "--gpu", "gtx-9"), ["gtx-980-ti"])
        self.assertEqual(self.complete("compare", "--gpu", "=", "gtx-9"), ["gtx-980-ti"])
        self.assertEqual(self.complete("compare", "--strategy", "coherent,cran"), ["coherent,cranley-patterson"])
        self.assertIn("--trace-samples", self.complete("capture", "courtyard", "--tr"))
        self.assertIn("l1.ways=", self.complete("replay", "--set", "l1.w"))
        self.assertIn("courtyard", self.complete("render", "court"))
        self.path("my.rct").write_text("")
        self.path("my.txt").write_text("")
        self.assertEqual(self.complete("info", "my"), ["my.rct"])
        self.assertEqual(self.complete("list", "gp"), ["gpus"])
        self.assertEqual(self.complete("replay", "--counters", ""), ["ncu"])

    def test_bash_completes_every_option_of_every_subcommand(self):
        for command in COMMANDS:
            text = self.succeeds(command, "--help").text.split("Examples:")[0]
            options = set(re.findall(r"(?m)^ +(?:-\w,)?(--[a-z0-9-]+)", text))
            self.assertGreater(len(options), 0)
            self.assertEqual(options - set(self.complete(command, "--")), set(), command)

    def test_every_value_that_bash_offers_is_one_that_the_program_takes(self):
        for option in ("--strategy", "--baseline", "--sequence", "--gpu", "--sky", "--lights", "--thread-map", "--by",
                       "--execution"):
            values = self.complete("compare", option, "")
            self.assertGreater(len(values), 1, option)
            for value in values:
                gpu = [] if option == "--gpu" else GPU
                line = self.refuses_missing("compare", "--scene", "missing.glb", *gpu, option, value)
                self.assertIn("missing.glb", line, f"{option} {value}")
        for table in self.complete("samples", "--table", ""):
            self.assertIn(table, self.succeeds("samples", "--help").text)
        for topic in self.complete("list", ""):
            self.succeeds("list", topic)

    def refuses_missing(self, *command):
        result = self.run_program(*command)
        self.assertIn(result.code, (1, 2), command)
        return result.stderr.splitlines()[-1]

    @unittest.skipUnless(shutil.which("zsh"), "zsh; apt-get install zsh")
    def test_the_completion_of_zsh_loads(self):
        script = self.prefix / "share/zsh/site-functions/_raycache"
        self.installed("zsh", "-f", "-n", script)
        out = self.installed("zsh", "-f", "-c", f'fpath=("{script.parent}" $fpath); autoload -Uz compinit; compinit -u -D; '
                             'autoload +X _raycache && print -r -- ${_comps[raycache]}')
        self.assertEqual(out.strip(), "_raycache")

    def test_the_report_tools_run_as_commands(self):
        self.installed("raycache", "compare", "--scene", *SCENE, *LAUNCHES, *GPU, "--save", "study")
        self.installed("raycache-report", "study.json", "-o", "page.html")
        self.assertIn("</html>", self.path("page.html").read_text("utf-8"))
        self.assertIn("usage", self.installed("raycache-plot-sweep", "--help"))
        self.assertIn("usage", self.installed("raycache-plot-quality", "--help"))
        self.assertIn("usage", self.installed("raycache-plot-curve", "--help"))
        self.assertIn("usage", self.installed("raycache-plot-counters", "--help"))

    def test_python_imports_the_reader_of_traces(self):
        trace = self.capture()
        rays = self.succeeds("info", trace, "--json").json["rays"]
        program = "import sys, raycache.traces as t\n" \
                  "w = list(t.Trace(sys.argv[1]).warps())\n" \
                  "print(sum(bin(r[0]).count('1') for _, _, records in w for r in records if r[1] == t.RAY_START))"
        out = self.installed("/usr/bin/python3", "-c", program, trace,
                             environment={"PYTHONPATH": f"{self.prefix}/lib/python3/dist-packages"})
        self.assertEqual(int(out), rays)

    def test_the_documents_come_with_their_links(self):
        folder = self.prefix / "share/doc/raycache"
        for page in folder.rglob("*.md"):
            for link in re.findall(r"\]\(([^)#:]+\.(?:md|png))(?:#[^)]*)?\)", page.read_text("utf-8")):
                self.assertTrue((page.parent / link).exists(), f"{page.relative_to(folder)}: {link}")


if __name__ == "__main__":
    main()
