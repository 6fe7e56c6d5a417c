#!/usr/bin/python3
"""What docs/architecture.md says of adding a part: so many lines in the file it names, and every command knows it. In a
copy of the sources, of which only what the lines touch is compiled again."""
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import tempfile
import unittest

import support

BUILD = pathlib.Path(support.RAYCACHE).resolve().parent
FOLDERS = ["cachesim", "tools", "tracer", "traces"]


def output_of(command, folder=BUILD):
    return subprocess.run(command, cwd=folder, check=True, stdout=subprocess.PIPE, text=True).stdout


def sources_of(file):
    """The sources that a file of CMake's makes into one (CMAKE_UNITY_BUILD), or the file itself."""
    if "/Unity/" not in file:
        return [file]
    return re.findall(r'^#include "(.+)"$', pathlib.Path(file).read_text(encoding="utf-8"), re.MULTILINE)


class Copy:
    """The sources in a folder of their own, and the program that they make."""

    def __init__(self):
        self._temporary = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self._temporary.name) / "raycache"
        for folder in FOLDERS:
            shutil.copytree(support.ROOT / folder, self.root / folder)
        self._new, self._changed, self.lines_added, self._groups = [], [], 0, 0

    def close(self):
        self._temporary.cleanup()

    def read(self, name):
        return (self.root / name).read_text(encoding="utf-8")

    def write(self, name, text):
        assert not (self.root / name).exists(), name
        (self.root / name).write_text(text, encoding="utf-8")
        self._new.append(name)

    def insert(self, name, anchor, line):
        """Adds a line behind the one that holds `anchor`."""
        lines = self.read(name).split("\n")
        [at] = [i for i, text in enumerate(lines) if anchor in text]
        lines.insert(at + 1, line)
        (self.root / name).write_text("\n".join(lines), encoding="utf-8")
        self._changed.append(name)
        self.lines_added += 1

    def replace(self, name, old, new):
        """Changes one line: counts as one."""
        text = self.read(name)
        assert text.count(old) == 1, (name, old)
        (self.root / name).write_text(text.replace(old, new), encoding="utf-8")
        self._changed.append(name)
        self.lines_added += 1

    def in_copy(self, source):
        """What is compiled here instead of it."""
        if "/Unity/" not in source:
            return source.replace(str(support.ROOT), str(self.root))
        self._groups += 1
        group = self.root / f"group{self._groups}.cpp"
        text = pathlib.Path(source).read_text(encoding="utf-8")
        for folder in FOLDERS:  # but for what the build made
            text = text.replace(f'"{support.ROOT}/{folder}/', f'"{self.root}/{folder}/')
        group.write_text(text, encoding="utf-8")
        return str(group)

    def build(self):
        """Compiles what includes a changed file, and new sources; links it with the rest; returns the program."""
        commands = {entry["file"]: entry["command"] for entry in json.loads((BUILD / "compile_commands.json").read_text())}
        changed = {str(support.ROOT / name) for name in self._changed}
        program = output_of(["ninja", "-t", "commands", "raycache"]).strip().split("\n")[-1]
        objects, jobs = {}, []
        for block in output_of(["ninja", "-t", "deps"]).split("\n\n"):
            name, *files = block.strip().split("\n")
            files = [os.path.normpath(BUILD / file.strip()) for file in files]  # ccache makes them relative
            if not files or not changed.intersection(files) or files[0] not in commands:
                continue
            name = name.split(":")[0]
            if name in program or re.match(r"CMakeFiles/raycache_(traces|tracer|cachesim|jobs)\.dir/", name):
                objects[name] = self.root / f"object{len(objects)}.o"
                jobs.append((commands[files[0]], files[0], objects[name]))
        assert objects, "no object depends on what was changed"
        for name in self._new:
            if name.endswith(".cpp"):
                folder = (support.ROOT / name).parent
                sibling = next(file for file in commands if folder in {pathlib.Path(one).parent for one in sources_of(file)})
                objects[name] = self.root / f"object{len(objects)}.o"
                jobs.append((commands[sibling], sibling, objects[name], self.root / name))
        running = []
        for command, source, target, *other in jobs:
            words = shlex.split(command)
            words[words.index("-o") + 1] = str(target)
            words[words.index("-c") + 1] = str(other[0]) if other else self.in_copy(source)
            instead = {f"-I{support.ROOT}": f"-I{self.root}", "-O3": "-O0", "-O1": "-O0"}  # to compile fast
            words = [instead.get(word, word) for word in words]
            running.append(subprocess.Popen(words, cwd=BUILD))
            if len(running) >= (os.cpu_count() or 1):
                assert running.pop(0).wait() == 0, source
        assert all(process.wait() == 0 for process in running)
        words = [word for word in shlex.split(program) if word not in (":", "&&")]
        target = self.root / "program"
        words[words.index("-o") + 1] = str(target)
        words = [str(objects.pop(word)) if word in objects else word for word in words]
        # What is left stands in for members of libraries: those are then not asked for.
        first = next(i for i, word in enumerate(words) if word.endswith(".o"))
        words[first:first] = map(str, objects.values())
        subprocess.run(words, cwd=BUILD, check=True)
        shutil.copy(BUILD / "libraycache_images.so", self.root)
        return target


def lacking():
    if not (BUILD / "compile_commands.json").exists() or not shutil.which("ninja"):
        return f"{BUILD} is no build folder of ninja; tools/build release"
    return ""


@unittest.skipIf(lacking(), lacking())
class Extending(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        """All three at once: what they touch is compiled once."""
        cls.copy = Copy()
        cls.addClassCleanup(cls.copy.close)
        cls.lines = {}

        # A layout: bvh2 once more, under another name.
        like = cls.copy.read("tracer/bvh/layouts/bvh2_breadth_first.hpp")
        text = like.replace("Bvh2BreadthFirst", "Bvh2Again").replace("bvh2-breadth-first", "bvh2-again")
        cls.copy.write("tracer/bvh/layouts/bvh2_again.hpp", text.replace("<breadth_first>", "<depth_first>"))
        cls.count("layout", lambda copy: (
            copy.insert("tracer/bvh/layouts/list.hpp", '/bvh2.hpp"', '#include "tracer/bvh/layouts/bvh2_again.hpp"'),
            copy.replace("tracer/bvh/layouts/list.hpp", "LayoutList<Bvh2, ", "LayoutList<Bvh2, Bvh2Again, ")))

        # A policy: who came last goes first.
        rename = lambda text: text.replace("Fifo", "Lifo").replace("fifo", "lifo")
        policies = "cachesim/cache/policies"
        header = rename(cls.copy.read(f"{policies}/fifo.hpp"))
        cls.copy.write(f"{policies}/lifo.hpp", re.sub(r"(victim\(std::uint64_t)[^{]*\{.*?\n    \}", r"\1) { return ways_ - 1; }",
                                                     header, flags=re.DOTALL))
        cls.copy.write(f"{policies}/lifo.cpp", rename(cls.copy.read(f"{policies}/fifo.cpp")))
        [row] = [line for line in cls.copy.read("cachesim/cache/registry.cpp").split("\n") if '{"fifo"' in line]
        cls.count("policy", lambda copy: (
            copy.insert("cachesim/cache/registry.cpp", 'policies/fifo.hpp"', f'#include "{policies}/lifo.hpp"'),
            copy.insert("cachesim/cache/registry.cpp", '{"fifo"', rename(row))))

        # A figure.
        cls.count("figure", lambda copy: copy.insert(
            "cachesim/report/figures/traffic_figures.hpp", "traffic_figures[] = {",
            '{.key = "accesses_per_ray", .title = "accesses per ray", .unit = "accesses", .definition = "warp accesses for '
            'each ray", .numerator = counts::warp_accesses, .denominator = counts::rays, .column = "acc/ray"},'))
        cls.program = cls.copy.build()

    @classmethod
    def count(cls, what, add):
        before = cls.copy.lines_added
        add(cls.copy)
        cls.lines[what] = cls.copy.lines_added - before

    def run_program(self, *arguments):
        return output_of([str(self.program), *arguments], self.copy.root)

    def test_the_lines_are_those_that_the_documentation_says(self):
        page = (support.ROOT / "docs/architecture.md").read_text(encoding="utf-8")
        says = {}
        for kind, words in (("layout", "BVH layout"), ("policy", "replacement policy"), ("figure", "figure of a report")):
            [row] = [line for line in page.split("\n") if line.startswith(f"| {words} |")]
            says[kind] = 2 if "two lines" in row else 1
        self.assertEqual(self.lines, says)

    def test_a_layout_is_listed_traced_and_recorded(self):
        self.assertIn("bvh2-again", self.run_program("list", "layouts"))
        capture = ["capture", *support.SCENE, "--resolution", "32x32", "--spp", "4", "--trace-samples", "1"]
        self.run_program(*capture, "--layout", "bvh2-again", "-o", "again.rct")
        self.assertIn("bvh2-again", self.run_program("info", "again.rct"))
        self.assertIn("again.rct", self.run_program("verify", "again.rct"))

    def test_a_policy_is_offered_and_replayed(self):
        replay = ["compare", *support.SCENE, "--resolution", "32x32", "--spp", "4", "--trace-samples", "1", "--strategy",
                  "coherent,random", *support.GPU, "--json", "--set"]
        rates = {policy: json.loads(self.run_program(*replay, f"l1.policy={policy}"))["rows"] for policy in ("lifo", "lru")}
        self.assertNotEqual(rates["lifo"], rates["lru"])

    def test_a_figure_stands_in_text_csv_and_json(self):
        compare = ["compare", *support.SCENE, "--resolution", "32x32", "--spp", "4", "--trace-samples", "1", "--strategy",
                   "coherent,random", *support.GPU]
        self.assertIn("accesses_per_ray", self.run_program("list", "figures"))
        self.assertIn("acc/ray", self.run_program(*compare, "--wide"))
        self.assertIn("accesses_per_ray", self.run_program(*compare, "--csv").split("\n")[0])
        self.assertIn("accesses_per_ray", self.run_program(*compare, "--json"))


if __name__ == "__main__":
    support.main()
