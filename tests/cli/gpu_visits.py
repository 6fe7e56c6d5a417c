#!/usr/bin/python3
"""tools/gpu/visit_instructions: what GPU presets say of nodes of two, four and eight children is what nvcc makes of them."""
import re
import shutil
import subprocess
import unittest

from support import ROOT, main


class GpuVisits(unittest.TestCase):
    SCRIPT = str(ROOT / "tools/gpu/visit_instructions")

    @unittest.skipIf(shutil.which("nvcc") is None, "nvcc is absent; install NVIDIA's CUDA toolkit, 12 or 13")
    def test_instructions_of_presets_are_those_counted_and_a_loop_to_within_a_tenth(self):
        """A compiler of another version makes other code: a tenth."""
        done = subprocess.run([self.SCRIPT, "sm_86"], stdout=subprocess.PIPE, text=True, check=True)
        counted = [int(n) for n in done.stdout.split("sm_86")[1].split()]
        preset = (ROOT / "cachesim/gpus/rtx-3070.toml").read_text()
        loop = 8
        for count, key in zip(counted, ("node_instructions", "node4_instructions", "node8_instructions"), strict=True):
            value = int(re.search(rf"^{key} = {{ value = (\d+)", preset, re.MULTILINE)[1])
            self.assertAlmostEqual(count + loop, value, delta=value / 10, msg=key)

    def test_help_is_the_usage(self):
        done = subprocess.run([self.SCRIPT, "--help"], stdout=subprocess.PIPE, text=True, check=True)
        self.assertIn("Usage: tools/gpu/visit_instructions [ARCHITECTURE]...", done.stdout)


if __name__ == "__main__":
    main()
