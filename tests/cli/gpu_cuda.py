#!/usr/bin/python3
"""The part of tools/gpu/ that runs on GPUs: it compiles, loads 16 bytes at a time through the read-only path, and says
in one line what is missing."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import unittest

from support import RAYCACHE, ROOT, ProgramTest, main

NVCC = shutil.which("nvcc")
needs_nvcc = unittest.skipIf(NVCC is None, "nvcc is absent; install NVIDIA's CUDA toolkit, 12 or 13")
MEASURE = ROOT / "tools/gpu/measure"


class GpuCuda(ProgramTest):
    def compiled(self, source, *arguments):
        command = [NVCC, "-std=c++20", "-fmad=false", "-arch=sm_86", "-I", ROOT, *arguments, "-o", self.path("out"),
                   ROOT / "tools/gpu" / source]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        self.assertEqual((done.returncode, done.stdout), (0, ""))
        return self.path("out")

    @needs_nvcc
    def test_every_source_compiles_without_a_warning(self):
        for source in sorted((ROOT / "tools/gpu/micro").glob("*.cu")):
            with self.subTest(source=source.name):
                self.compiled(source, "-c", "-O1", "-Xptxas", "-O0")

    @needs_nvcc
    def test_the_walk_loads_nodes_triangles_and_rays_16_bytes_wide_through_the_read_only_path(self):
        text = self.compiled("replay/cuda_backend.cu", "-ptx", "-O3").read_text()
        kernels = re.split(r"\.visible \.entry |\.entry ", text)[1:]
        self.assertEqual(len(kernels), 6)
        for kernel in kernels:
            # Three of a triangle, two of a ray, one of a batch, and those of the node.
            tree, loads = next((t, n) for t, n in (("WalkBvh2", 4), ("WalkBvh4", 7), ("WalkCwbvh8", 5)) if t in kernel)
            self.assertEqual(len(re.findall(r"ld\.global\.nc\.v4\.\w+", kernel)), loads + 3 + 2 + 1, tree)
            self.assertNotIn("fma.rn", kernel)  # it would visit other nodes than the trace

    def test_measure_says_in_one_line_what_is_missing(self):
        def refused(*words, mentions, path=os.environ["PATH"]):
            done = subprocess.run(["/usr/bin/python3", MEASURE, *map(str, words)], stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE, text=True, env={**os.environ, "PATH": path}, cwd=self.folder,
                                  check=False)
            self.assertEqual((done.returncode, done.stdout), (1, ""))
            lines = [line for line in done.stderr.splitlines() if "error: " in line]
            self.assertEqual(len(lines), 1, done.stderr)
            for word in mentions:
                self.assertIn(word, lines[0])

        refused("prepare", "p", "--build", "nowhere", mentions=["nowhere", "--build"])
        refused("run", "none", "-o", "r.json", mentions=["packages.json", "prepare"])
        refused("prepare", "p", "--build", pathlib.Path(RAYCACHE).parent,
                mentions=["nvcc", "CUDA toolkit"], path="/nowhere")
        # A folder whose program finds no device.
        programs = self.path("p") / "bin"
        programs.mkdir(parents=True, exist_ok=True)
        (self.path("p") / "packages.json").write_text("[]")
        (programs / "gpu_micro").write_text("#!/bin/sh\necho 'gpu_micro: error: no CUDA device' >&2\nexit 1\n")
        (programs / "gpu_micro").chmod(0o755)
        refused("run", "p", "-o", "r.json", mentions=["no CUDA device"])
        self.assertFalse(self.path("r.json").exists())

    def test_measure_makes_one_document_of_what_the_programs_say_and_names_what_it_left_out(self):
        folder = self.path("p")
        (folder / "bin").mkdir(parents=True)
        packages = [{"folder": name, "scene": "s", "spp": 64, "case": "coherent"} for name in ("good", "bad")]
        (folder / "packages.json").write_text(json.dumps(packages))
        for name, body in (("gpu_micro", 'echo \'{"device": {"name": "none"}, "series": []}\''),
                           ("gpu_replay", 'case "$1" in */bad) echo "damaged" >&2; exit 1;; esac; '
                                          'echo \'{"launches": []}\'')):
            (folder / "bin" / name).write_text(f"#!/bin/sh\n{body}\n")
            (folder / "bin" / name).chmod(0o755)
        subprocess.run(["/usr/bin/python3", MEASURE, "run", folder, "-o", "r.json"], cwd=self.folder, check=True,
                       stderr=subprocess.DEVNULL)
        result = json.loads(self.path("r.json").read_text())
        self.assertEqual([r["folder"] for r in result["replays"]], ["good"])
        self.assertIn({"folder": "bad", "scene": "s", "spp": 64, "case": "coherent", "what": "times", "why": "damaged"},
                      result["left_out"])
        self.assertEqual(result["device"], {"name": "none"})
        self.assertIn("measure run", result["command"])


if __name__ == "__main__":
    main()
