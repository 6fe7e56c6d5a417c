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
            self.succeeds("import", kernel, "--fuse", "-o", "back.rct")
            self.assertEqual(self.totals("back.rct"), expected)
        self.succeeds("import", "k.traceg.xz", "-o", "back.rct")
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
                    load.replace("00000003", "00000005"), load[:30] + "\n", load.replace("1 R4 LDG", "2 R4 LDG")):
            self.path("bad.traceg").write_text(HEAD + begin + bad + end)
            self.refuses(1, "import", "bad.traceg", "-o", "bad.rct", mentions=["bad.traceg: line 12: "])
        self.path("cut.traceg").write_text(HEAD + begin + load)
        self.refuses(1, "import", "cut.traceg", "-o", "bad.rct", mentions=["#END_TB"])


if __name__ == "__main__":
    main()
