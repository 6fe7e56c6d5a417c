#!/usr/bin/python3
"""RAYCACHE_INSTRUCTIONS: which vector instructions a replay runs."""
import os
import re

from support import GPU, LAUNCHES, SCENE, ProgramTest, main

COMPARE = ["compare", "--scene", *SCENE, *LAUNCHES, "--strategy", "coherent,cranley-patterson", *GPU]


def using(name):
    return {**os.environ, "RAYCACHE_INSTRUCTIONS": name}


class InstructionSets(ProgramTest):
    def test_every_instruction_set_of_the_processor_gives_the_same_report(self):
        line = self.refuses(2, *COMPARE, mentions=["RAYCACHE_INSTRUCTIONS", "mmx"], env=using("mmx"))
        names = re.search(r"expected one of (.*), which", line).group(1).split(", ")
        self.assertIn("scalar", names)
        self.assertGreater(len(names), 1)
        expected = self.succeeds(*COMPARE).text
        for name in ["", *names]:
            with self.subTest(name):
                self.assertEqual(self.succeeds(*COMPARE, env=using(name)).text, expected)

    def test_a_name_nearly_right_is_answered_with_the_right_one(self):
        self.refuses(2, *COMPARE, mentions=["did you mean 'scalar'?"], env=using("scaler"))


if __name__ == "__main__":
    main()
