#!/usr/bin/python3
"""--execution and --order: wavefronts from the command line, in files and without."""
import csv
import io
import subprocess

from support import GPU, LAUNCHES, ROOT, SCENE, ProgramTest, main

WAVES = ["cranley-patterson", "cranley-patterson+wavefront", "cranley-patterson+meister", "cranley-patterson+garanzha-loop"]
COMPARE = ["compare", "--scene", *SCENE, *LAUNCHES, *GPU, "--spp", "64"]


class Wavefront(ProgramTest):
    def test_a_megakernel_is_the_default_and_its_file_is_the_same_with_the_options_spelled_out(self):
        default = self.capture("default.rct").read_bytes()
        spelled = self.capture("spelled.rct", "--execution", "megakernel", "--order", "none").read_bytes()
        self.assertEqual(default, spelled)
        self.assertEqual(default[8], 1)  # version of the format
        self.assertNotIn("execution", self.succeeds("info", "default.rct").text)

    def test_a_wavefront_from_files_gives_the_numbers_of_the_same_without_files(self):
        fused = self.succeeds(*COMPARE, "--strategy", ",".join(WAVES), "--json").json["rows"]
        files = []
        for name in WAVES:
            self.succeeds("capture", *SCENE, *LAUNCHES, "--spp", "64", "--strategy", name, "-o", name + ".rct")
            files.append(name + ".rct")
        self.assertEqual(self.succeeds("compare", *files, *GPU, "--json").json["rows"], fused)
        self.assertEqual([row["strategy"] for row in fused], WAVES)

    def test_options_and_suffix_mean_the_same(self):
        suffix = self.succeeds(*COMPARE, "--strategy", "cranley-patterson+morton", "--json").json["rows"]
        options = self.succeeds(*COMPARE, "--strategy", "cranley-patterson", "--execution", "wavefront", "--order",
                                "morton", "--json").json["rows"]
        self.assertEqual(suffix, options)

    def test_sorts_and_writes_have_columns_of_their_own_and_count_in_the_total(self):
        mega, plain, sorted_, runs = self.succeeds(*COMPARE, "--strategy", ",".join(WAVES), "--json").json["rows"]
        for row in (plain, sorted_, runs):
            self.assertEqual(row["totals"]["rays"], mega["totals"]["rays"])
            self.assertEqual(row["totals"]["steps"], mega["totals"]["steps"])
            self.assertGreater(row["written_bytes_per_ray"]["mean"], 0)
        self.assertNotIn("written_bytes_per_ray", mega)
        self.assertEqual(plain["sort_bytes_per_ray"]["mean"], 0)
        self.assertGreater(sorted_["sort_bytes_per_ray"]["mean"], 10)
        # 108 B for each bounce ray.
        bounces = self.succeeds(*COMPARE, "--strategy", WAVES[2], "--by", "ray", "--json").json["rows"]
        rays = next(row["totals"]["rays"] for row in bounces if row["group"] == "bounce")
        self.assertAlmostEqual(sorted_["totals"]["sort_sectors"] * 32 / (rays * 108), 1, delta=0.001)
        objects = self.succeeds(*COMPARE, "--strategy", WAVES[2], "--by", "object", "--json").json["rows"]
        self.assertEqual(sum(row["totals"]["dram_sectors"] for row in objects), sorted_["totals"]["dram_sectors"])
        names = {row["group"] for row in objects}
        self.assertLessEqual({"node", "ray state", "ray state write", "hit", "hit write", "queue", "queue write", "sort"},
                             names)

    def test_columns_of_wavefronts_appear_only_with_wavefronts(self):
        text = self.succeeds(*COMPARE, "--strategy", "coherent,cranley-patterson").text
        self.assertNotIn("sort", text)
        header = next(csv.reader(io.StringIO(self.succeeds(*COMPARE, "--strategy", "coherent", "--csv").text)))
        self.assertNotIn("sort_sectors", header)
        text = self.succeeds(*COMPARE, "--strategy", "cranley-patterson,cranley-patterson+moon").text
        self.assertIn("written", text)
        self.assertIn("Wavefronts: ", text)

    def test_wavefronts_are_replayed_in_time_too(self):
        rows = self.succeeds(*COMPARE, "--strategy", ",".join(WAVES[:3]), "--timed", "--json").json["rows"]
        self.assertEqual([row["strategy"] for row in rows], WAVES[:3])
        self.assertEqual(len({row["rays"] for row in rows}), 1)
        self.assertEqual(len({row["cycles"] for row in rows}), 3)

    def test_the_table_of_the_docs_adds_up_to_the_report(self):
        strategies = ["--strategy", ",".join(WAVES[:3])]
        totals = [row["dram_bytes_per_ray"]["mean"] for row in self.succeeds(*COMPARE, *strategies, "--json").json["rows"]]
        by_object = self.succeeds(*COMPARE, *strategies, "--by", "object", "--json").stdout
        self.path("rows.json").write_bytes(by_object)
        text = subprocess.run([ROOT / "tools/wavefront_table", "--from", self.path("rows.json")], check=True,
                              stdout=subprocess.PIPE, text=True).stdout
        rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if "cranley" in line]
        self.assertEqual([row[0] for row in rows], WAVES[:3])
        for row, total in zip(rows, totals, strict=True):
            self.assertAlmostEqual(float(row[8]), total, delta=0.051)
            self.assertAlmostEqual(sum(map(float, row[4:8])), total, delta=0.21)

    def test_the_thread_count_changes_nothing(self):
        one = self.capture("one.rct", "--strategy", "cranley-patterson+moon", "--threads", "1").read_bytes()
        two = self.capture("two.rct", "--strategy", "cranley-patterson+moon", "--threads", "3").read_bytes()
        self.assertEqual(one, two)
        self.succeeds("verify", "one.rct")
        trace, = self.succeeds("info", "one.rct", "--json").json["traces"]
        self.assertEqual((trace["execution"], trace["order"], trace["kernels_per_launch"]), ("wavefront", "moon", 15))

    def test_what_makes_no_sense_is_refused_with_the_reason(self):
        capture = ["capture", *SCENE, *LAUNCHES, "-o", "x.rct"]
        self.refuses(2, *capture, "--order", "morton", mentions=["morton", "megakernel", "wavefront"])
        self.refuses(2, *capture, "--execution", "kernel", mentions=["'kernel'", "megakernel, wavefront"])
        self.refuses(2, *capture, "--execution", "wavefront", "--order", "hilbert", mentions=["'hilbert'", "meister-two-point"])
        self.refuses(2, *capture, "--strategy", "cranley-patterson+hilbert", mentions=["'hilbert'"])
        self.refuses(2, *capture, "--strategy", "nonsense+morton", mentions=["'nonsense'"])
        self.refuses(2, "capture", *SCENE, "--execution", "wavefront", "--resolution", "8192x8192", "-o", "x.rct",
                     mentions=["67108864 paths"])

    def test_commands_that_follow_a_warp_refuse_a_wavefront(self):
        self.capture("wave.rct", "--execution", "wavefront")
        self.capture("mega.rct")
        self.refuses(2, "explain", "mega.rct", "wave.rct", *GPU, mentions=["wave.rct", "wavefront", "megakernel"])
        self.refuses(2, "export", "wave.rct", *GPU, "--sm", "0", "--l1", "0", "--format", "csv", "-o", "x.csv",
                     mentions=["wave.rct", "wavefront"])
        self.refuses(2, "export", "wave.rct", "--format", "accel-sim", "-o", "x.traceg", mentions=["wavefront"])


if __name__ == "__main__":
    main()
