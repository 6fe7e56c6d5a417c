#!/usr/bin/python3
"""raycache explain: the identity, miss classes, sharing, heat maps, and what it refuses."""
import struct
import zlib

from support import GPU, LAUNCHES, SCENE, ProgramTest, main

FUSED = ["explain", "--scene", *SCENE, *LAUNCHES, *GPU, "--counts-only"]
CLASSES = ("compulsory", "capacity", "conflict")


def exr_channels(data):
    """Names of the channels of an OpenEXR file: the 'channels' attribute of its header."""
    at = data.index(b"channels\0chlist\0") + len(b"channels\0chlist\0") + 4
    names = []
    while data[at] != 0:
        end = data.index(b"\0", at)
        names.append(data[at:end].decode())
        at = end + 1 + 16
    return names


def png_rows(data):
    """The scan lines of an RGB picture of 8 bits, filters undone."""
    width, height = struct.unpack(">II", data[16:24])
    at, stream = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        stream += data[at + 8:at + 8 + length] if kind == b"IDAT" else b""
        at += 12 + length
    raw, size = zlib.decompress(stream), 3 * width
    rows, above = [], bytes(size)
    for y in range(height):
        kind, row = raw[y * (size + 1)], bytearray(raw[y * (size + 1) + 1:(y + 1) * (size + 1)])
        for i in range(size if kind else 0):
            left, up, corner = (row[i - 3], above[i], above[i - 3]) if i >= 3 else (0, above[i], 0)
            nearest = min((left, up, corner), key=lambda v: abs(left + up - corner - v))
            row[i] = (row[i] + (left, up, (left + up) // 2, nearest)[kind - 1]) & 255
        above = bytes(row)
        rows.append(above)
    return rows


class Explain(ProgramTest):
    def traces(self):
        names = ("cranley-patterson", "coherent")
        return [self.path(f"{name}.rct") if self.path(f"{name}.rct").exists() else
                self.capture(f"{name}.rct", "--strategy", name) for name in names]

    def explained(self, *options):
        return self.succeeds("explain", *self.traces(), *GPU, "--counts-only", *options)

    def test_the_factors_multiply_to_the_ratio_of_dram_bytes_per_ray_that_compare_finds(self):
        base, other = self.traces()
        report = self.succeeds("explain", base, other, *GPU, "--counts-only", "--json").json
        product = 1
        for factor in report["factors"].values():
            product *= factor["factor"]["mean"]
            self.assertAlmostEqual(factor["other"] / factor["base"], factor["factor"]["mean"], delta=1e-12)
        self.assertAlmostEqual(product / report["dram_bytes_ratio"]["mean"], 1, delta=1e-9)
        rows = self.succeeds("compare", base, other, *GPU, "--json").json["rows"]
        for row, side in zip(rows, ("base", "other"), strict=True):
            for key, value in report[side]["totals"].items():
                self.assertEqual(row["totals"][key], value, key)
        self.assertEqual(rows[1]["dram_bytes_ratio"], report["dram_bytes_ratio"])

    def test_every_miss_is_in_one_class_and_every_hit_has_a_fetcher(self):
        report = self.explained("--json").json
        for side in ("base", "other"):
            totals, levels = report[side]["totals"], report[side]["levels"]
            self.assertEqual(levels["l1"]["all"]["lookups"], totals["sectors"])
            self.assertEqual(levels["l1"]["all"]["misses"], totals["l2_sectors"])
            self.assertEqual(levels["l2"]["all"]["lookups"], totals["l2_sectors"])
            self.assertEqual(levels["l2"]["all"]["misses"], totals["dram_sectors"])
            self.assertEqual(sum(report[side]["l1_hits_by_fetcher"].values()),
                             totals["sectors"] - totals["l2_sectors"])
            for level in levels.values():
                cuts = [[level["all"]], list(level["by_object"].values()), level["by_ray"]]
                for rows in cuts:
                    for row in rows:
                        self.assertEqual(sum(row[c] for c in CLASSES), row["misses"])
                    for key in ("lookups", "misses", *CLASSES, "lucky_hits"):
                        self.assertEqual(sum(row[key] for row in rows), level["all"][key], key)
                # Nodes and triangles have a depth, texels do not.
                deep = sum(row["misses"] for row in level["by_depth"])
                solid = sum(level["by_object"][kind]["misses"] for kind in ("node", "triangle"))
                self.assertEqual(deep, solid)
                self.assertEqual(level["by_depth"][0]["depth"], 0)

    def test_a_cpu_is_explained_over_its_three_levels(self):
        explained = ["explain", *self.traces(), "--gpu", "xeon-8380"]
        report = self.succeeds(*explained, "--json").json
        self.assertEqual({key for key in report["factors"] if key[0] == "l"}, {"l1_locality", "l2_locality", "l3_locality"})
        for side in ("base", "other"):
            totals, levels = report[side]["totals"], report[side]["levels"]
            for level, above, below in (("l1", "sectors", "l2_sectors"), ("l2", "l2_sectors", "l3_sectors"),
                                        ("l3", "l3_sectors", "dram_sectors")):
                self.assertEqual(levels[level]["all"]["lookups"], totals[above])
                self.assertEqual(levels[level]["all"]["misses"], totals[below])
        text = self.succeeds(*explained).text
        self.assertIn("L3   capacity", text)
        self.assertLessEqual(max(len(line) for line in text.splitlines()), 110)

    def test_the_groups_add_up_to_the_whole(self):
        for by in ("bounce", "ray"):
            report = self.explained("--by", by, "--json").json
            self.assertGreaterEqual(len(report["groups"]), 3)
            for side in ("base", "other"):
                for key, value in report[side]["totals"].items():
                    self.assertEqual(sum(group[side][key] for group in report["groups"]), value, key)

    def test_the_text_has_every_part_in_110_columns_and_ends_with_a_sentence(self):
        text = self.succeeds("explain", *self.traces(), *GPU, "--by", "bounce").text
        self.assertRegex(" ".join(text.split()), r"[\d.]+x ±[\d.]+ predicted[^;]*; [\d.]+x ±[\d.]+ would remain with perfect caches")
        for replay in ("as modelled", "perfect L1", "perfect L2", "infinite bandwidth", "no added latency", "full warps"):
            self.assertIn(replay, text)
        for part in ("coherent against cranley-patterson", "SIMT efficiency", "logarithmic", "share of the change",
                     "compulsory", "depth 0-3", "triangles", "shadow 0", "another CTA", "◄"):
            self.assertIn(part, text)
        self.assertLessEqual(max(len(line) for line in text.splitlines()), 110)
        self.assertNotIn("nan", text)
        self.assertRegex(" ".join(text.split()), r"coherent reads [\d.]+( ±[\d.]+)? % (fewer|more) (to [\d.]+ % more )?L2-to-L1 bytes per "
                                                 r"ray than cranley-patterson .*; with equal miss rates x")
        self.assertTrue(text.endswith(".\n"))

    def test_fused_and_from_files_with_any_threads_are_the_same(self):
        from_files = self.explained("--json").report
        fused = [*FUSED, "--strategy", "cranley-patterson,coherent", "--json"]
        one = self.succeeds(*fused, "--threads", "1")
        self.assertEqual(one.report, from_files)
        self.assertEqual(self.succeeds(*fused, "--threads", "3").stdout, one.stdout)
        self.assertEqual(self.succeeds(*fused, "--threads", "3", "--heatmap", "x.exr").report, from_files)

    def test_a_trace_explained_by_itself_has_only_ones(self):
        trace = self.capture()
        report = self.succeeds("explain", trace, trace, *GPU, "--counts-only", "--json").json
        self.assertEqual({factor["factor"]["mean"] for factor in report["factors"].values()}, {1})
        self.assertEqual(report["base"]["levels"], report["other"]["levels"])
        text = self.succeeds("explain", trace, trace, *GPU, "--counts-only").text
        self.assertIn("There is no difference: other reads as many bytes per ray as base", text)

    def test_a_heat_map_is_an_exr_of_six_channels_and_a_png_beside_it(self):
        printed = self.explained("--heatmap", "why.exr", "--threads", "2").text
        self.assertIn("Misses by class", printed)
        exr, png = self.path("why.exr").read_bytes(), self.path("why.png").read_bytes()
        self.assertEqual(sorted(exr_channels(exr)),
                         sorted(f"{layer}.{name}" for layer in ("base", "other")
                                for name in ("DRAM bytes", "L1 visit miss rate", "active lanes")))
        self.assertEqual(png[:8], b"\x89PNG\r\n\x1a\n")
        width, height = struct.unpack(">II", png[16:24])
        self.assertGreater(width, 3 * 384)
        self.assertGreater(height, 3 * 288)
        first = exr, png
        self.explained("--heatmap", "why.exr", "--threads", "1")
        self.assertEqual((self.path("why.exr").read_bytes(), self.path("why.png").read_bytes()), first)

    def test_no_label_of_a_heat_map_is_cut_off_however_long_the_names(self):
        sizes = []
        for changes in ([], ["--set", "l1.ways=2", "--set", "l1.policy=fifo", "--set", "l2.policy=tree_plru",
                             "--set", "l2.slice_hash=modulo", "--warps-per-sm", "16"]):
            self.explained("--heatmap", "why.exr", *changes)
            rows = png_rows(self.path("why.png").read_bytes())
            self.assertEqual(set(rows[0]), {255})
            self.assertEqual({value for row in rows for value in row[-3 * 8:]}, {255})  # nothing reaches the edge
            self.assertTrue(all(set(row) == {255} for row in rows[-8:]))
            sizes.append((len(rows), len(rows[0])))
        self.assertEqual(sizes[0][1], sizes[1][1])
        self.assertGreater(sizes[1][0], sizes[0][0])

    def test_a_warp_of_one_pixel_has_a_heat_map_too(self):
        self.succeeds(*FUSED, "--thread-map", "samples", "--heatmap", "s.exr")

    def test_a_scene_is_explained_from_windows_with_intervals_the_same_for_any_threads(self):
        windows = ["explain", "--scene", *SCENE, "--resolution", "64x48", "--windows", "4", "--spp", "16", "--gpu",
                   "gtx-980-ti", "--set", "sms=1", "--warps-per-sm", "8"]
        report = self.succeeds(*windows, "--json", "--threads", "1")
        self.assertEqual(self.succeeds(*windows, "--json", "--threads", "3").stdout, report.stdout)
        found = report.json
        self.assertEqual(found["windows"]["blocks"], 2)
        self.assertEqual(found["windows"]["windows_per_block"], 2)
        for factor in found["factors"].values():
            self.assertIsNotNone(factor["factor"]["half_width_95"])
        self.assertIsNotNone(found["timed"][0]["speed_up"]["half_width_95"])
        text = " ".join(self.succeeds(*windows, "--counts-only").text.split())
        self.assertIn("steady state, from 2 blocks of", text)
        self.assertIn("confidence interval over blocks of sample indices", text)
        self.assertIn("note: estimates of the steady state", text)
        self.assertNotIn("nan", text)
        rows = self.succeeds("compare", *windows[1:], "--strategy", "cranley-patterson,micro-jitter", "--json").json["rows"]
        for row, side in zip(rows, ("base", "other"), strict=True):
            self.assertEqual(row["windows"]["blocks"], 2)
            for key, value in found[side]["totals"].items():
                self.assertEqual(row["totals"][key], value, key)

    def test_a_heat_map_of_a_scene_is_of_whole_launches_and_says_so(self):
        scene = ["explain", "--scene", *SCENE, "--resolution", "32x24", "--spp", "4", *GPU, "--counts-only",
                 "--strategy", "cranley-patterson,coherent"]
        done = self.run_program(*scene, "--heatmap", "x.exr")
        self.assertEqual(done.code, 0)
        self.assertIn("warning: a heat map shows whole launches", done.stderr)
        self.assertEqual(done.stdout, self.succeeds(*scene, "--exact").stdout)
        self.refuses(2, *scene, "--heatmap", "x.exr", "--windows", "4", mentions=["--heatmap", "--windows"])

    def test_predicted_times_are_those_of_a_timed_comparison(self):
        base, other = self.traces()
        rows = self.succeeds("compare", base, other, *GPU, "--timed", "--json").json["rows"]
        report = self.succeeds("explain", base, other, *GPU, "--json").json
        as_modelled = report["timed"][0]
        self.assertEqual((as_modelled["base_cycles"], as_modelled["other_cycles"]), (rows[0]["cycles"], rows[1]["cycles"]))
        self.assertTrue(all(t["base_cycles"] <= as_modelled["base_cycles"] for t in report["timed"][1:]))
        self.assertIn("predicted", report["time_sentence"])

    def test_compare_ends_with_a_verdict_on_each_strategy(self):
        text = self.succeeds("compare", "--scene", *SCENE, *LAUNCHES, *GPU).text
        for name in ("coherent", "micro-jitter"):
            self.assertRegex(text, rf"(?m)^{name}, N 64, gtx-980-ti: (no certain difference; at most |[\d.]+ ±[\d.]+ % (fewer|more) )")

    def test_traces_of_different_pictures_are_refused_with_what_differs(self):
        base = self.capture("base.rct")
        for options, words in ((["--resolution", "32x32"], ["resolution", "64x48", "32x32"]),
                               (["--bounces", "1"], ["bounces"]),
                               (["--detail", "60000"], ["scene"]),
                               (["--thread-map", "samples"], ["thread map", "tile", "samples"]),
                               (["--trace-samples", "1"], ["sample indices", "--trace-samples"]),
                               (["--seed", "5"], ["sample indices", "--seed"])):
            self.path("other.rct").unlink(missing_ok=True)
            chosen = [option for option in (*SCENE, *LAUNCHES)]
            for flag, value in zip(options[::2], options[1::2]):
                if flag in chosen:
                    chosen[chosen.index(flag) + 1] = value
                else:
                    chosen += [flag, value]
            self.succeeds("capture", *chosen, "--spp", "64", "-o", "other.rct")
            line = self.refuses(1, "explain", base, "other.rct", *GPU, mentions=words)
            self.assertIn("other.rct: expected", line)

    def test_wrong_use_is_refused(self):
        base, other = self.traces()
        self.refuses(2, "explain", *GPU, mentions=["two trace files", "--scene"])
        self.refuses(2, "explain", base, *GPU, mentions=["two"])
        self.refuses(2, "explain", base, other, mentions=["--gpu"])
        self.refuses(2, "explain", base, other, "--gpu", "no-such", mentions=["no-such"])
        self.refuses(2, "explain", base, other, *GPU, "--by", "object", mentions=["--by"])
        self.refuses(2, "explain", base, other, *GPU, "--heatmap", "map.png", mentions=[".exr"])
        self.refuses(2, *FUSED, "--strategy", "coherent", mentions=["BASE,OTHER"])
        self.refuses(2, *FUSED, "--strategy", "coherent,nothing", mentions=["nothing"])
        self.refuses(1, "explain", base, "missing.rct", *GPU, mentions=["missing.rct"])
        self.refuses(1, "explain", base, other, *GPU, "--heatmap", "nowhere/map.exr", mentions=["nowhere/map.exr"])


if __name__ == "__main__":
    main()
