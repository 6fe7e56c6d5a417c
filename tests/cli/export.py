#!/usr/bin/python3
"""raycache export: what a cache is asked, for other tools."""
import csv

from support import GPU_FILE, PICTURE, SCENE, ProgramTest, main

H100 = ["--gpu", "h100"]


class Export(ProgramTest):
    def test_the_rows_of_all_sms_and_of_l2_add_up_to_the_replay(self):
        trace = self.capture("trace.rct", "--bounces", "1")
        self.path("tiny.toml").write_text("""name = "tiny"
description = "two SMs"
sms = 2
warps_per_sm = 8
warps_per_cta = 4
l1_per_sm = 1
[l1]
sets = 4
ways = 16
line_bytes = 128
sector_bytes = 32
index = "modulo"
policy = "lru"
[l2]
sets = 64
ways = 16
line_bytes = 128
sector_bytes = 32
index = "xor_fold"
policy = "lru"
""")
        totals = self.succeeds("replay", trace, "--gpu", "tiny.toml", "--json").json["rows"][0]["totals"]
        sums = {"sectors": 0, "l1_visit_hits": 0, "l2_sectors": 0, "l2_hits": 0}
        for launch in (0, 1):
            for sm in (["--sm", "0"], ["--sm", "1"], ["--level", "l2"]):
                self.succeeds("export", trace, "--gpu", "tiny.toml", *sm, "--launch", launch, "--format", "csv", "-o",
                              "x.csv")
                with open(self.path("x.csv"), encoding="ascii") as file:
                    rows = list(csv.DictReader(file))
                level = "l2" if "l2" in sm else "l1"
                sums["l2_sectors" if level == "l2" else "sectors"] += len(rows)
                sums["l2_hits" if level == "l2" else "l1_visit_hits"] += sum(row["hit"] == "1" for row in rows)
        totals["l2_hits"] = totals["l2_sectors"] - totals["dram_sectors"]
        self.assertEqual(sums, {key: totals[key] for key in sums})

    def test_what_the_second_levels_of_all_cores_lack_the_third_is_asked_for(self):
        trace = self.capture("trace.rct", "--bounces", "0")
        head = """name = "few"
description = "two cores"
sms = 2
warps_per_sm = 2
warps_per_cta = 1
l1_per_sm = 1
simd_width = 8
"""
        cache = """ways = 4
line_bytes = 64
sector_bytes = 64
index = "modulo"
policy = "fifo"
"""
        levels = [f"[l{level}]\nsets = {sets}\n{cache}" for level, sets in ((1, 8), (2, 32), (3, 256))]
        self.path("few.toml").write_text(head + "".join(levels))
        missing = 0
        for core in (0, 1):
            self.succeeds("export", trace, "--gpu", "few.toml", "--level", "l2", "--sm", core, "--launch", "0",
                          "--format", "csv", "-o", "x.csv")
            missing += sum(line.endswith(",0") for line in self.path("x.csv").read_text("ascii").splitlines())
        self.succeeds("export", trace, "--gpu", "few.toml", "--level", "l3", "--launch", "0", "--format", "u64", "-o",
                      "l3.u64")
        self.assertEqual(self.path("l3.u64").stat().st_size, 8 * missing)
        self.assertGreater(missing, 0)

    def test_a_request_file_of_dram_has_every_sector_of_the_timed_replay(self):
        trace = self.path("trace.rct")
        self.succeeds("capture", *SCENE, *PICTURE, "--spp", "64", "--bounces", "1", "--trace-samples", "1", "-o", trace)
        timed = self.succeeds("replay", trace, *H100, "--timed", "--json").json["rows"][0]
        export = ["export", trace, *H100, "--level", "dram", "--format"]
        files = {form: self.succeeds(*export, form, "-o", "-").text.splitlines() for form in ("ramulator", "ramulator2", "dramsim3")}
        lines = [line.split() for line in files["dramsim3"]]
        self.assertEqual(len(lines), timed["dram_sectors"])
        cycles = [int(cycle) for _, _, cycle in lines]
        self.assertEqual(cycles, sorted(cycles))
        self.assertLess(cycles[-1], timed["cycles"])
        self.assertEqual({what for _, what, _ in lines}, {"READ"})
        self.assertEqual(files["ramulator"], [f"{address} R" for address, _, _ in lines])
        self.assertEqual(files["ramulator2"], [f"LD {address}" for address, _, _ in lines])
        half = self.succeeds(*export, "dramsim3", "--cycle-mhz", "877.5", "--launch", "0", "-o", "-").text.splitlines()
        self.assertEqual([int(line.split()[2]) for line in half], [cycle // 2 for cycle in cycles])  # of 1755 MHz
        self.assertEqual({line.split()[0] for line in half}, {address for address, _, _ in lines})

    def test_stores_of_a_wavefront_are_writes_of_dram_and_sorts_are_left_out_aloud(self):
        trace = self.path("wave.rct")
        self.succeeds("capture", *SCENE, *PICTURE, "--spp", "64", "--trace-samples", "1", "--execution", "wavefront", "-o", trace)
        row = self.succeeds("replay", trace, *H100, "--timed", "--json").json["rows"][0]
        lines = self.succeeds("export", trace, *H100, "--level", "dram", "--format", "ramulator", "-o", "-").text.splitlines()
        self.assertEqual(len(lines), row["dram_sectors"])
        self.assertGreaterEqual(sum(line.endswith(" W") for line in lines), row["traffic"]["totals"]["written_sectors"])
        self.succeeds("capture", *SCENE, *PICTURE, "--spp", "64", "--trace-samples", "1", "--execution", "wavefront",
                      "--order", "morton", "-o", trace)
        row = self.succeeds("replay", trace, *H100, "--timed", "--json").json["rows"][0]
        done = self.warns("export", trace, *H100, "--level", "dram", "--format", "dramsim3", "-o", "s.trc")
        self.assertIn(f"{row['traffic']['totals']['sort_sectors']} sectors that sorts move are left out", done.stderr)

    def test_a_request_file_of_dram_needs_a_level_a_format_and_times_that_fit(self):
        trace = self.capture("trace.rct", "--bounces", "0")
        dram = ["export", trace, "-o", "x", "--level", "dram", "--format"]
        self.refuses(2, *dram, "csv", *H100, mentions=["--format csv", "dram", "dramsim3"])
        self.refuses(2, "export", trace, "-o", "x", *H100, "--sm", "0", "--format", "dramsim3", mentions=["--level dram"])
        self.refuses(2, *dram, "dramsim3", *H100, "--sm", "0", mentions=["--sm", "dram"])
        self.refuses(2, *dram, "ramulator", *H100, "--cycle-mhz", "1000", mentions=["--cycle-mhz", "dramsim3"])
        self.refuses(2, "export", trace, "-o", "x", *H100, "--sm", "0", "--format", "csv", "--cycle-mhz", "9", mentions=["--cycle-mhz"])
        self.refuses(2, *dram, "dramsim3", "--gpu", "xeon-8380", mentions=["xeon-8380", "time"])
        self.path("tiny.toml").write_text(GPU_FILE)
        self.refuses(1, *dram, "dramsim3", "--gpu", "tiny.toml", mentions=["tiny.toml", "timing"])

    def test_dinero_and_u64_files_hold_the_same_sectors_and_nothing_is_printed(self):
        trace = self.capture()
        for form in ("dinero", "u64"):
            done = self.succeeds("export", trace, *H100, "--sm", "3", "--launch", "0", "--format", form, "-o", form)
            self.assertEqual(done.stdout, b"")
        words = self.path("u64").read_bytes()
        wanted = "".join(f"0 {int.from_bytes(words[i:i + 8], 'little'):x}\n" for i in range(0, len(words), 8))
        self.assertEqual(self.path("dinero").read_text(), wanted)
        self.assertGreater(len(words), 8000)

    def test_of_several_launches_the_first_is_exported_with_a_warning_unless_one_is_asked_for(self):
        trace = self.capture()
        samples = self.succeeds("info", trace, "--json").json["traces"][0]["samples"]
        for form in (["u64", *H100, "--level", "l2"], ["accel-sim"]):
            export = ["export", trace, "--format", *form, "-o"]
            name = "x.traceg" if form[0] == "accel-sim" else "x"
            warning = self.warns(*export, name).stderr
            self.assertIn(f"only launch 0 of 2 is exported, sample index {samples[0]}; choose with --launch", warning)
            default = self.path(name).read_bytes()
            self.succeeds(*export, name, "--launch", "0")
            self.assertEqual(self.path(name).read_bytes(), default)
            self.succeeds(*export, name, "--launch", "1")
            self.assertNotEqual(self.path(name).read_bytes(), default)
        self.succeeds("capture", *SCENE, *PICTURE, "--trace-samples", "1", "-o", "one.rct")
        self.succeeds("export", "one.rct", *H100, "--level", "l2", "--format", "u64", "-o", "x")

    def test_a_changed_gpu_is_asked_what_a_file_with_these_values_is_asked(self):
        trace = self.capture("trace.rct", "--bounces", "0")
        export = ["export", trace, "--sm", "0", "--launch", "0", "--format", "csv", "-o"]
        self.succeeds(*export, "plain.csv", *H100)
        self.succeeds(*export, "changed.csv", *H100, "--set", "l1.ways=1", "--warps-per-sm", "8")
        self.succeeds(*export, "same.csv", *H100, "--set", "l1.ways=1", "--set", "warps_per_sm=8")
        self.assertEqual(self.path("changed.csv").read_bytes(), self.path("same.csv").read_bytes())
        self.assertNotEqual(self.path("changed.csv").read_bytes(), self.path("plain.csv").read_bytes())
        self.refuses(2, "export", trace, "--format", "accel-sim", "--set", "l1.ways=1", "-o", "x", mentions=["--set"])

    def test_a_choice_that_does_not_exist_is_refused(self):
        trace = self.capture()
        out = ["--format", "u64", "-o", "x"]
        self.refuses(2, "export", trace, *H100, "--sm", "114", *out, mentions=["--sm 114", "0 to 113"])
        self.refuses(2, "export", trace, *H100, *out, mentions=["--sm"])
        self.refuses(2, "export", trace, *H100, "--sm", "-1", *out)
        self.refuses(2, "export", trace, "--sm", "0", *out, mentions=["--gpu"])
        self.refuses(2, "export", trace, "--gpu", "gtx-970", "--sm", "0", *out, mentions=["gtx-970"])
        self.refuses(2, "export", trace, *H100, "--sm", "0", "--l1", "1", *out, mentions=["--l1 1"])
        self.refuses(2, "export", trace, "--gpu", "gtx-980-ti", "--sm", "0", *out, mentions=["--l1", "0 to 1"])
        self.refuses(2, "export", trace, *H100, "--level", "l3", *out, mentions=["l3"])
        self.refuses(2, "export", trace, *H100, "--level", "l2", "--sm", "0", *out, mentions=["--sm"])
        cpu = ["--gpu", "xeon-8380"]
        self.refuses(2, "export", trace, *cpu, "--level", "l2", *out, mentions=["--sm", "0 to 39"])
        self.refuses(2, "export", trace, *cpu, "--level", "l2", "--sm", "0", "--l1", "0", *out, mentions=["--l1"])
        self.refuses(2, "export", trace, *cpu, "--level", "l3", "--sm", "0", *out, mentions=["--sm"])
        self.refuses(2, "export", trace, *cpu, "--level", "l4", *out, mentions=["l4", "l1, l2, l3"])
        self.refuses(2, "export", trace, *H100, "--sm", "0", "--launch", "2", *out, mentions=["--launch 2", "0 to 1"])
        self.refuses(2, "export", trace, *H100, "--sm", "0", "--format", "vcd", "-o", "x", mentions=["vcd", "dinero"])

    def test_files_that_cannot_be_read_or_written_are_refused(self):
        trace = self.capture()
        what = [*H100, "--sm", "0", "--format", "u64", "-o"]
        self.refuses(1, "export", trace, *what, "no/such/folder/x", mentions=["no/such/folder/x"])
        self.path("folder").mkdir()
        self.refuses(1, "export", trace, *what, "folder", mentions=["folder"])
        self.refuses(1, "export", "missing.rct", *what, "x", mentions=["missing.rct"])
        self.path("cut.rct").write_bytes(trace.read_bytes()[:-100])
        self.refuses(1, "export", "cut.rct", *what, "x", mentions=["cut.rct"])


if __name__ == "__main__":
    main()
