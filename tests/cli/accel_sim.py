#!/usr/bin/python3
"""export --format accel-sim and import: warp instructions of Accel-Sim, there and back."""
from support import PICTURE, SCENE, ProgramTest, main

HEAD = "-kernel name = k\n-grid dim = (1,1,1)\n-block dim = (32,1,1)\n-accelsim tracer version = 5\n\n#traces format = x\n\n"
COUNTERS = ("lane_accesses", "warp_accesses", "loads", "l1_requests", "sectors", "l1_hits", "l2_sectors", "l2_hits", "dram_sectors")


class AccelSim(ProgramTest):
    def totals(self, trace):
        totals = self.succeeds("replay", trace, "--gpu", "h100", "--json").json["rows"][0]["totals"]
        return {key: totals[key] for key in COUNTERS}

    def test_export_and_import_give_the_same_replay_from_a_folder_and_from_xz(self):
        trace = "trace.rct"
        self.succeeds("capture", *SCENE, *PICTURE, "--trace-samples", "1", "--bounces", "1", "-o", trace)
        expected = self.totals(trace)
        for target, kernel in (("folder", "folder/kernel-1.traceg"), ("k.traceg.xz", "k.traceg.xz")):
            self.succeeds("export", trace, "--format", "accel-sim", "--warps-per-cta", "7", "-o", target)
            for fused in ([], ["--fuse"]):  # registers show that the loads of an object are independent
                self.succeeds("import", kernel, *fused, "-o", "back.rct")
                self.assertEqual(self.totals("back.rct"), expected)
        self.succeeds("import", "k.traceg.xz", "--no-fuse", "-o", "back.rct")
        split = self.totals("back.rct")
        self.assertEqual([split[key] for key in ("loads", "l1_requests")],
                         [expected[key] for key in ("loads", "l1_requests")])
        self.assertEqual([split[key] for key in ("warp_accesses", "sectors")],
                         [expected[key] for key in ("loads", "l1_requests")])

    def test_malformed_lines_are_refused_with_their_number(self):
        load = "0000 00000003 1 R4 LDG.E.SYS 1 R4 4 1 0x1000 4 0\n"
        begin, end = "#BEGIN_TB\nthread block = 0,0,0\nwarp = 0\ninsts = 1\n", "#END_TB\n"
        self.path("good.traceg").write_text(HEAD + begin + load + end)
        self.succeeds("import", "good.traceg", "-o", "good.rct")
        for bad in (load.replace("R4 LDG", "Q4 LDG"), load.replace("0x1000", "0x1002"), load.replace("4 1 0x", "4 3 0x"),
                    load.replace("00000003", "00000005"), load[:30] + "\n", load.replace("1 R4 LDG", "2 R4 LDG"),
                    load.replace("1 R4 4", "1 R256 4")):
            self.path("bad.traceg").write_text(HEAD + begin + bad + end)
            self.refuses(1, "import", "bad.traceg", "-o", "bad.rct", mentions=["bad.traceg: line 12: "])
        self.path("cut.traceg").write_text(HEAD + begin + load)
        self.refuses(1, "import", "cut.traceg", "-o", "bad.rct", mentions=["#END_TB"])

    def kernel(self, *lines):
        return (HEAD + f"#BEGIN_TB\nthread block = 0,0,0\nwarp = 0\ninsts = {len(lines)}\n" + "".join(l + "\n" for l in lines) +
                "#END_TB\n")

    def test_a_load_whose_lanes_lie_far_apart_is_one_load_in_every_replay(self):
        for opcode in ("LDG.E.U8", "LDG.E", "LDG.E.128"):
            self.path("k.traceg").write_text(self.kernel(f"0 3 1 R4 {opcode} 1 R2 4 0 0x7f0000000000 0xff00000000000000 0"))
            self.succeeds("import", "k.traceg", "-o", "k.rct")
            self.assertEqual([self.totals("k.rct")[key] for key in ("loads", "warp_accesses", "lane_accesses", "sectors")], [1, 1, 2, 2])
            row = self.succeeds("replay", "k.rct", "--gpu", "rtx-3070", "--timed", "--json").json["rows"][0]
            self.assertEqual([row["loads"], row["l1"]["requests"], row["dram_sectors"]], [1, 2, 2])
            self.warns("export", "k.rct", "--format", "accel-sim", "-o", "again.traceg")
            self.succeeds("import", "again.traceg", "-o", "k.rct")
            self.assertEqual(self.totals("k.rct")["sectors"], 2)

    def test_lanes_of_address_0_are_warned_about_and_left_out_as_asked(self):
        self.path("k.traceg").write_text(self.kernel("0 3 1 R4 LDG.E 1 R2 4 0 0x1000 0x0 0", "10 3 1 R4 LDG.E 1 R2 4 0 0x0 0x0 0"))
        for options, expected in (([], [1, 2]), (["--null-lanes", "drop-lanes"], [1, 1]), (["--null-lanes", "keep"], [2, 4])):
            result = self.warns("import", "k.traceg", *options, "-o", "k.rct")
            self.assertIn("3 lanes of 2 loads read address 0", result.stderr)
            self.assertEqual([self.totals("k.rct")[key] for key in ("loads", "lane_accesses")], expected)

    def test_stores_are_imported_where_asked_and_go_through_l1_to_l2(self):
        load, write = "0 ffffffff 1 R4 LDG.E 1 R2 4 1 0x1000 4 0", "10 ffffffff 0 STG.E 2 R2 R4 4 1 0x1000 4 0"
        self.path("k.traceg").write_text(self.kernel(load, write, load))
        result = self.warns("import", "k.traceg", "-o", "k.rct")
        self.assertIn("no loads of global memory (LDG, LDGSTS, LD) are left out: 1 STG", result.stderr)
        self.succeeds("import", "k.traceg", "--stores", "-o", "k.rct")
        rows = self.succeeds("replay", "k.rct", "--gpu", "v100", "--by", "object", "--json").json["rows"]
        of = {row["group"]: row["totals"] for row in rows}
        counts = {group: [totals[key] for key in ("sectors", "l1_hits", "l2_sectors", "l2_hits", "dram_sectors")]
                  for group, totals in of.items()}
        # The store finds nothing in L1 and leaves its line there; its four sectors go to DRAM once.
        self.assertEqual(counts, {"node": [8, 4, 4, 0, 4], "ray state write": [4, 0, 4, 0, 4]})
        self.path("a.din").write_text("0 7f5000000000\n")
        self.refuses(2, "import", "a.din", "--stores", "-o", "x.rct", mentions=["--stores", "expected an Accel-Sim trace"])

    def cycles(self, *lines, options=()):
        self.path("k.traceg").write_text(self.kernel(*lines, "f0 ffffffff 0 EXIT 0 0 0"))
        self.succeeds("import", "k.traceg", *options, "-o", "k.rct")
        row = self.succeeds("replay", "k.rct", "--gpu", "rtx-3070", "--timed", "--json").json["rows"][0]
        self.assertEqual(row["loads"], 2)
        return row["cycles"], row["instructions"]

    def test_loads_wait_for_what_their_registers_say_and_instructions_are_those_of_the_file(self):
        first, free = "0 1 1 R4 LDG.E 1 R2 4 0 0x100000 0", "10 1 1 R8 LDG.E 1 R6 4 0 0x900000 0"
        bound, add = free.replace("R6", "R4"), "8 1 1 R20 FADD 1 R4 0 0"
        (alone, count), (chained, _) = self.cycles(first, free), self.cycles(first, bound)
        self.assertEqual(count, 2)  # EXIT ends the warp
        self.assertTrue(self.succeeds("info", "k.rct", "--json").json["issue"])
        latency = chained - alone
        self.assertGreater(latency, 400)  # of DRAM: nothing is overlapped
        held_up, count = self.cycles(first, add, free)
        self.assertAlmostEqual(held_up, chained, delta=10)
        self.assertEqual(count, 3)
        busy, count = self.cycles(first, *["8 1 1 R20 FADD 1 R30 0 0"] * 2000, free)
        self.assertEqual(count, 2002)
        self.assertGreater(busy, alone + 1500)
        traversal, _ = self.cycles(first, free, options=["--traversal"])
        self.assertGreaterEqual(traversal, chained)
        self.assertFalse(self.succeeds("info", "k.rct", "--json").json["issue"])
        self.cycles(first, free)
        self.assertIn("each object waits for the one before",
                      self.warns("export", "k.rct", "--format", "accel-sim", "-o", "again.traceg").stderr)

    def test_a_list_of_kernels_is_a_launch_a_kernel(self):
        self.path("traces").mkdir()
        for i in (1, 2):
            self.path(f"traces/kernel-{i}.traceg").write_text(self.kernel(f"0 1 1 R4 LDG.E 1 R2 4 0 {4096 * i:#x} 0"))
        self.path("traces/kernelslist.g").write_text("MemcpyHtoD,0x1000,4\nkernel-1.traceg\nkernel-2.traceg\n")
        for name in ("traces", "traces/kernelslist.g"):
            self.succeeds("import", name, "-o", "k.rct")
            self.assertEqual(self.totals("k.rct")["loads"], 2)

    def test_addresses_are_guessed_or_named_and_other_files_refused_by_what_they_look_like(self):
        self.path("a.din").write_text("0 7f5000000000\n0 7f5000000020\n1 7f5000000040\n")
        result = self.warns("import", "a.din", "-o", "a.rct")
        self.assertIn("1 writes and 0 instruction fetches are left out", result.stderr)
        self.assertEqual(self.totals("a.rct")["loads"], 2)
        self.path("a.csv").write_text("time,obj,size\n1,0x7f50,32\n2,0x7f51,32\n")
        self.succeeds("import", "a.csv", "-o", "a.rct")
        self.path("words").write_bytes(bytes(8) + (1 << 40).to_bytes(8, "little"))
        self.refuses(1, "import", "words", "-o", "a.rct", mentions=["--format u64"])
        self.succeeds("import", "words", "--format", "u64", "-o", "a.rct")
        self.path("a.lackey").write_text("I  04001090,3\n L 1ffefffe50,8\n")
        self.refuses(1, "import", "a.lackey", "-o", "a.rct", mentions=["Lackey", "din, csv, u64"])
        self.refuses(2, "import", "a.din", "--fuse", "-o", "a.rct", mentions=["expected an Accel-Sim trace"])
        self.refuses(2, "export", "a.rct", "--format", "accel-sim", "--binary-version", "121", "-o", "x", mentions=["120"])
        self.refuses(2, "import", "a.din", "--traversal", "-o", "a.rct", mentions=["expected an Accel-Sim trace"])
        self.succeeds("export", "a.rct", "--format", "accel-sim", "--binary-version", "120", "-o", "x.traceg")


if __name__ == "__main__":
    main()
