#!/usr/bin/python3
"""raycache quality, raycache sweep and tools/plot_sweep."""
import csv
import io
import json
import os
import pathlib
import subprocess
import sys
import tempfile

from lit_room import write_lit_room
from support import ROOT, SCENE, ProgramTest, main

FOLDER = tempfile.TemporaryDirectory()
SMALL = {"--resolution": "32x32", "--spp": "8", "--bounces": "1", "--reference-spp": "256",
         "--reference-strategy": "cranley-patterson"}
GPU = ["--gpu", "gtx-980-ti", "--trace-samples", "2"]
NAMED = [str(write_lit_room(pathlib.Path(FOLDER.name) / "room.gltf"))]


def small(*arguments):
    """The scene and the small settings, but for those that the arguments give."""
    settings = [word for option, value in SMALL.items() if option not in arguments for word in (option, value)]
    return [*NAMED, *settings, *arguments]


class QualityTest(ProgramTest):
    def setUp(self):
        super().setUp()
        os.environ["XDG_CACHE_HOME"] = str(self.path("cache"))
        self.addCleanup(os.environ.pop, "XDG_CACHE_HOME")

    def quality(self, *arguments, **keywords):
        return self.succeeds("quality", *small(*arguments), **keywords)

    def firefly_scene(self):
        """A floor, seen from above, lit by a panel and by a very bright lamp of 6 cm, both out of view, which bounce rays
        alone find (--lights bsdf): the lamp about once in a picture of 32x32 pixels with 4 samples each."""
        import base64
        import json
        import struct
        floor = [(-2, 0, -2), (2, 0, -2), (2, 0, 2), (-2, 0, 2)]
        square = lambda x, y, side: [(x - side, y, -side), (x + side, y, -side), (x + side, y, side), (x - side, y, side)]  # noqa: E731
        lamp, panel = square(1, 1, 0.03), square(-1.5, 1, 0.5)
        points = b"".join(struct.pack("<3f", *v) for v in floor + lamp + panel)
        indices = struct.pack("<6H", 0, 2, 1, 0, 3, 2)
        view = lambda at, size: {"buffer": 0, "byteOffset": at, "byteLength": size}  # noqa: E731
        accessor = lambda v, kind, count, shape, **more: {"bufferView": v, "componentType": kind, "count": count,  # noqa: E731
                                                          "type": shape, **more}
        box = lambda vs: {"min": [min(c) for c in zip(*vs)], "max": [max(c) for c in zip(*vs)]}  # noqa: E731
        mesh = lambda position, material: {"primitives": [{"attributes": {"POSITION": position}, "indices": 3,  # noqa: E731
                                                           "material": material}]}
        glow = lambda strength: {"emissiveFactor": [1, 1, 1], "doubleSided": True,  # noqa: E731
                                 "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": strength}}}
        scene = {
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2, 3]}],
            "nodes": [{"mesh": 0}, {"mesh": 1}, {"mesh": 2},
                      {"camera": 0, "translation": [0, 2, 0], "rotation": [-0.70710678, 0, 0, 0.70710678]}],
            "cameras": [{"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.01}}],
            "meshes": [mesh(0, 0), mesh(1, 1), mesh(2, 2)],
            "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0}},
                          glow(1000), glow(5)],
            "extensionsUsed": ["KHR_materials_emissive_strength"],
            "accessors": [accessor(0, 5126, 4, "VEC3", **box(floor)), accessor(1, 5126, 4, "VEC3", **box(lamp)),
                          accessor(2, 5126, 4, "VEC3", **box(panel)), accessor(3, 5123, 6, "SCALAR")],
            "bufferViews": [view(0, 48), view(48, 48), view(96, 48), view(144, 12)],
            "buffers": [{"byteLength": 156, "uri": "data:application/octet-stream;base64," +
                         base64.b64encode(points + indices).decode()}]}
        self.path("firefly.gltf").write_text(json.dumps(scene))
        return "firefly.gltf"

    def references(self):
        return sorted((self.path("cache") / "raycache/references").glob("*"))


class EqualError(QualityTest):
    """The speed-up times the variance ratio."""
    ARGUMENTS = ["--strategy", "cranley-patterson,owen,coherent", "--spp", "4,16", "--repeats", "2", *GPU]

    def test_every_row_has_its_gain_at_equal_error_over_each_baseline_or_says_why_there_is_none(self):
        rows = self.quality(*self.ARGUMENTS, "--json").json["rows"]
        for row in rows:
            others = [name for name in ("cranley-patterson", "owen") if name != row["strategy"]]
            self.assertEqual([e["baseline"] for e in row["equal_error"]], [f"{o} N={row['spp']}" for o in others])
            for e in row["equal_error"]:
                base = next(r for r in rows if r["label"] == e["baseline"])
                self.assertAlmostEqual(e["speed_up"]["mean"],
                                       base["predicted_seconds"] / row["predicted_seconds"], places=6)
                self.assertAlmostEqual(e["gain_by_rmse"]["mean"], e["speed_up"]["mean"] / e["rmse_ratio"]**2, places=9)
                self.assertEqual(e["gain"], e["gain_by_rmse"] if row["no_equal_error"] is None else None)
        shared = {row["spp"]: row["no_equal_error"] for row in rows if row["strategy"] == "coherent"}
        self.assertRegex(shared[16], "R8 .*, at most 2|bias: z seeds")
        text = self.quality(*self.ARGUMENTS, "--wide")
        self.assertRegex(text.text, r"coherent N=16 .* none +none\n")
        self.assertRegex(text.text, "coherent N=16: no time to an equal error: .*by its RMSE alone")
        table = list(csv.DictReader(io.StringIO(self.quality(*self.ARGUMENTS, "--csv").text)))
        self.assertEqual([row["gain_owen"] != "" for row in table],
                         [row["strategy"] != "owen" and row["no_equal_error"] is None for row in rows])
        self.assertEqual({row["gain_blue_noise"] for row in table}, {""})

    def test_times_may_be_of_a_larger_picture_and_of_windows_and_strategies_of_different_maps(self):
        report = self.quality("--strategy", "owen@samples,micro-jitter:k=1@rows,micro-jitter:k=4@tile", "--baseline",
                              "owen", "--gpu", "rtx-3070", "--set", "sms=1", "--time-resolution", "128x64", "--windows",
                              "16", "--spp", "64", "--json").json
        self.assertEqual(report["time_resolution"], "128x64")
        self.assertEqual([row["label"] for row in report["rows"]],
                         ["owen@samples", "micro-jitter k=1@rows", "micro-jitter k=4@tile"])
        for row in report["rows"][1:]:
            self.assertGreater(row["speed_up"]["half_width_95"], 0)
            self.assertAlmostEqual(row["equal_error"][0]["speed_up"]["mean"], row["speed_up"]["mean"])
        self.refuses(2, "quality", *small("--time-resolution", "64x64"), mentions=["--time-resolution", "--gpu"])

    def test_the_plot_of_error_against_time_is_drawn_and_needs_times(self):
        plot = [sys.executable, ROOT / "tools/plot_quality"]
        usual = {name: value for name, value in os.environ.items() if name != "XDG_CACHE_HOME"}
        for name, arguments, code in (("timed", self.ARGUMENTS, 0), ("untimed", self.ARGUMENTS[:4], 1)):
            self.path(f"{name}.json").write_bytes(self.quality(*arguments, "--json").stdout)
            done = subprocess.run([*plot, f"{name}.json", "-o", f"{name}.png"], cwd=self.folder, env=usual,
                                  capture_output=True, timeout=300, check=False)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertNotIn(b"Warning", done.stderr)
        self.assertIn(b"--gpu", done.stderr)
        self.assertEqual(self.path("timed.png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertFalse(self.path("untimed.png").exists())


class Quality(QualityTest):
    def test_the_table_has_a_row_per_strategy_and_says_what_its_columns_mean(self):
        text = self.quality("--strategy", "coherent,cranley-patterson").text
        lines = text.splitlines()
        self.assertIn("R8", lines[0])
        self.assertEqual([line.split()[0] for line in lines[2:4]], ["coherent", "cranley-patterson"])
        for words in ("R8: ", "z: ", "reference of 256 samples per pixel"):
            self.assertIn(words, text)

    def test_coherent_errors_are_shared_and_those_of_random_numbers_are_not(self):
        result = self.quality("--json", "--resolution", "64x64", "--spp", "64", "--bounces", "3").json
        rows = {r["strategy"]: r for r in result["rows"]}
        self.assertEqual(set(rows), {"coherent", "cranley-patterson", "micro-jitter", "random"})
        for name in ("cranley-patterson", "random"):
            self.assertGreater(rows["coherent"]["r8"]["value"], 2 * rows[name]["r8"]["value"])
            self.assertGreater(rows["coherent"]["z_pixels"], rows[name]["z_pixels"])
        self.assertEqual(rows["cranley-patterson"]["rmse_ratio"], 1)
        self.assertEqual(rows["cranley-patterson"]["rmse_ratio_half_width_95"], 0)
        self.assertTrue(rows["cranley-patterson"]["unbiased_by_construction"])
        self.assertFalse(rows["coherent"]["unbiased_by_construction"])
        self.assertLess(rows["cranley-patterson"]["rmse"]["value"], rows["random"]["rmse"]["value"])
        self.assertGreater(rows["random"]["rmse"]["half_width_95"], 0)

    def test_the_reference_is_kept_and_gives_the_same_result_again_for_any_number_of_threads(self):
        first = self.quality("--json", "--threads", "1").stdout
        kept = self.references()
        self.assertEqual(len(kept), 1)
        bytes_before, time_before = kept[0].read_bytes(), kept[0].stat().st_mtime_ns
        self.assertEqual(self.quality("--json", "--threads", "2").stdout, first)
        self.assertEqual(kept[0].stat().st_mtime_ns, time_before)
        self.assertEqual(kept[0].read_bytes(), bytes_before)
        kept[0].unlink()
        self.assertEqual(self.quality("--json", "--threads", "2").stdout, first)
        self.assertEqual(self.references()[0].read_bytes(), bytes_before)

    def test_a_damaged_cache_file_is_rendered_again_with_a_warning(self):
        first = self.quality("--csv").stdout
        path = self.references()[0]
        whole = path.read_bytes()
        for damaged in (whole[:len(whole) // 2], b"nonsense", whole[:-300] + bytes(100) + whole[-200:]):
            with self.subTest(len(damaged)):
                path.write_bytes(damaged)
                result = self.warns("quality", *small("--csv"))
                self.assertEqual(result.stdout, first)
                self.assertIn("rendered again", result.stderr)
                self.assertEqual(path.read_bytes(), whole)

    def test_another_scene_view_or_size_has_a_reference_of_its_own(self):
        self.quality("--strategy", "random")
        self.quality("--strategy", "random", "--fov", "20")
        self.quality("--strategy", "random", "--reference-spp", "32")
        self.assertEqual(len(self.references()), 3)

    def test_an_error_below_the_references_noise_is_bounded_and_never_0(self):
        noisy = ["--reference-spp", "4", "--reference-strategy", "random", "--spp", "256", "--strategy",
                 "cranley-patterson,owen"]
        result = self.quality("--json", *noisy).json
        for row in result["rows"]:
            self.assertIsNone(row["rmse"]["value"])
            self.assertGreater(row["rmse"]["below"], 0)
            self.assertIsNone(row["r8"]["value"])
            self.assertIsNone(row["rmse_ratio"])
            self.assertEqual(row["rmse_ratio_words"], "below the reference's noise")
        self.assertIn("below the reference's noise", str(result["notes"]))
        text = self.quality(*noisy).text
        self.assertRegex(text, r"owen +< 0\.\d+")
        self.assertIn("raise --reference-spp", text)
        rows = list(csv.DictReader(io.StringIO(self.quality("--csv", *noisy).text)))
        self.assertEqual(rows[0]["rmse"], "")
        self.assertGreater(float(rows[0]["rmse_below"]), 0)
        for form in (text, str(result)):
            self.assertNotRegex(form, r"(?i)\b(nan|inf)\b")

    def test_a_clamp_belongs_to_pictures_and_reference(self):
        free = self.quality("--json", "--strategy", "random").json
        clamped = self.quality("--json", "--strategy", "random", "--clamp", "0.05").json
        self.assertEqual(len(self.references()), 2)
        self.assertIsNone(free["clamp"])
        self.assertAlmostEqual(clamped["clamp"], 0.05, places=6)
        self.assertLess(clamped["reference"]["mean_luminance"], free["reference"]["mean_luminance"])
        self.assertIn("samples clamped to 0.05",
                      " ".join(self.quality("--strategy", "random", "--clamp", "0.05").text.split()))

    def test_a_ranking_that_a_few_pixels_decide_is_refused(self):
        firefly = self.firefly_scene()
        arguments = ["quality", firefly, "--resolution", "32x32", "--spp", "4", "--bounces", "2", "--lights", "bsdf",
                     "--reference-spp", "64", "--strategy", "cranley-patterson,random,owen,coherent"]
        rows = self.succeeds(*arguments, "--json").json["rows"]
        decided = [row for row in rows if row["decided_by_pixels"]]
        self.assertTrue(decided, rows)
        for row in decided:
            self.assertIsNone(row["rmse_ratio"])
            self.assertRegex(row["rmse_ratio_words"], r"decided by \d pixels?$")
        text = self.succeeds(*arguments).text
        self.assertIn("no ranking; use --clamp, or the robust error", " ".join(text.split()))
        clamped = self.succeeds(*arguments, "--clamp", "1", "--json").json["rows"]
        self.assertFalse([row for row in clamped if row["decided_by_pixels"]])

    def test_the_output_says_what_a_default_blender_does(self):
        notes = str(self.quality("--json", "--spp", "64", "--strategy", "scrambling-distance").json["notes"])
        self.assertIn("a default Blender has blue noise", notes)
        self.assertNotIn("Blender", str(self.quality("--json", "--strategy", "scrambling-distance", "--mu", "0.5").json))

    def test_a_named_reference_is_written_once_then_used_and_refused_where_it_does_not_fit(self):
        first = self.quality("--csv", "--reference", "mine.exr").stdout
        self.assertFalse(self.references())
        self.assertEqual(self.quality("--csv", "--reference", "mine.exr").stdout, first)
        self.refuses(1, "quality", *small("--reference", "mine.exr", "--resolution", "16x32"), mentions=["mine.exr"])
        self.path("mine.exr").write_bytes(b"nonsense")
        self.refuses(1, "quality", *small("--reference", "mine.exr"), mentions=["mine.exr"])
        self.assertEqual(self.path("mine.exr").read_bytes(), b"nonsense")
        self.refuses(2, "quality", *small("--reference", "mine.png"), mentions=[".exr"])

    def test_more_seeds_give_a_second_bias_test(self):
        result = self.quality("--json", "--repeats", "4", "--strategy", "cranley-patterson,coherent").json
        cp, coherent = result["rows"]
        self.assertLess(cp["z_seeds"], 2.5)
        self.assertGreater(coherent["z_seeds"], 2.5)
        self.assertIn("z seeds", self.quality("--repeats", "2").text)

    def test_pairs_name_the_dimensions_that_cause_shared_error(self):
        row = self.quality("--json", "--pairs", "--strategy", "coherent").json["rows"][0]
        pairs = row["dimension_pairs"]
        self.assertEqual([p["dimensions"] for p in pairs], [[2 * q, 2 * q + 1] for q in range(6)])
        self.assertGreater(max(p["share_of_structured_error"] for p in pairs), 0.1)
        self.assertIn("worst pair", self.quality("--pairs", "--strategy", "coherent").text)

    def test_pictures_show_every_strategy_at_equal_samples_and_at_equal_predicted_time(self):
        text = self.quality("--strategy", "cranley-patterson,micro-jitter", *GPU, "--output", "a/b", "--wide").text
        self.assertIn("speed-up", text)
        self.assertIn("N equal time", text)
        names = {p.name for p in self.path("a/b").iterdir()}
        stems = ["cranley-patterson", "micro-jitter"]
        self.assertEqual(names, {"index.png", "reference.png"} | {s + e for s in stems for e in (
            ".exr", ".png", "_error.exr", "_error.png", "_blocks.exr")})
        self.assertEqual((self.path("a/b") / "index.png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n")

    def test_csv_has_one_row_per_strategy_sequence_and_n(self):
        text = self.warns("quality", *small("--csv", "--sequence", "sobol,halton", "--spp", "4,8", "--strategy",
                                            "random")).text
        rows = list(csv.DictReader(io.StringIO(text)))
        self.assertEqual([(r["sequence"], r["spp"]) for r in rows],
                         [("sobol", "4"), ("sobol", "8"), ("halton", "4"), ("halton", "8")])
        self.assertEqual(rows[0]["rmse"], rows[2]["rmse"])  # random ignores the sequence
        self.assertGreater(float(rows[0]["rmse"]), float(rows[1]["rmse"]))

    def test_bad_input_is_refused_in_one_line(self):
        for arguments, word in ((["--spp", "0"], "0"), (["--strategy", "no-such"], "no-such"),
                                (["--sequence", "no-such"], "no-such"), (["--resolution", "0x32"], "0x32"),
                                (["--repeats", "0"], "--repeats"), (["--reference-spp", "1"], "--reference-spp"),
                                (["--bounces", "65"], "--bounces"), (["--baseline", "no-such"], "no-such"),
                                (["--crop", "0,0,8"], "--output"), (["--crop", "0,0,99", "--output", "x"], "--crop"),
                                (["--clamp", "0"], "--clamp"), (["--clamp", "nan"], "--clamp"),
                                (["--reference-strategy", "coherent"], "cranley-patterson, owen, random"),
                                (["--json", "--csv"], "--csv"), (["--gpu", "no-such"], "no-such"),
                                (["--seed", str(0x7265666572656e63)], "--seed")):
            with self.subTest(arguments):
                self.refuses(2, "quality", *small(*arguments), mentions=[word])
        self.path("file").write_text("")
        self.refuses(1, "quality", *small("--output", "file/folder"), mentions=["file/folder"])
        self.refuses(1, "quality", *small("--reference", "none/a.exr"), mentions=["none/a.exr"])


class Sweep(QualityTest):
    def sweep(self, *arguments):
        return self.succeeds("sweep", *small(*GPU, "--mu", "0,0.25,1", *arguments))

    def test_the_ends_of_the_sweep_are_coherent_and_as_good_as_cranley_patterson(self):
        result = self.sweep("--json").json
        rows = {(r["strategy"], r["mu"]): r for r in result["rows"]}
        zero, one = rows["micro-jitter", 0], rows["micro-jitter", 1]
        coherent, cp = rows["coherent", None], rows["cranley-patterson", None]
        self.assertEqual(zero["rmse"], coherent["rmse"])
        self.assertEqual(zero["speed_up"], coherent["speed_up"])
        self.assertAlmostEqual(one["speed_up"]["mean"], 1, delta=0.1)
        self.assertLess(one["r8"]["value"], zero["r8"]["value"])
        self.assertIsNone(cp["speed_up"])
        self.assertTrue(result["recommendation"])
        self.assertIsNotNone(result["recommended_mu"])  # mu = 1 is Cranley-Patterson, which nothing refuses
        best = rows["micro-jitter", result["recommended_mu"]]
        if best["mu"] < 1:
            self.assertLessEqual(best["r8"]["value"] + best["r8"]["half_width_95"], result["accepted"]["r8"])

    def test_the_recommendation_is_the_least_mu_with_an_acceptable_picture(self):
        self.assertIn("recommendation: micro-jitter with mu 0 ",
                      self.sweep("--clamp", "0.3", "--max-r8", "1e6", "--max-rmse", "1e6").text)
        self.assertIn("recommendation: no mu of this list has",
                      self.succeeds("sweep", *small(*GPU, "--mu", "0,0.1", "--clamp", "0.3", "--max-rmse", "1e-9")).text)

    def test_what_noise_hides_is_not_judged_but_answered_with_what_would_tell(self):
        result = self.sweep("--json", "--repeats", "2", "--max-r8", "4").json
        text = str(result["recommendation"])
        next_smaller = result["next_smaller"]
        if next_smaller["verdict"] == "too noisy to say":
            self.assertRegex(text, r"too noisy to say \(.*\): raise --[a-z-]+ from \d+ to \d+")
            self.assertGreater(next_smaller["raise"]["to"], next_smaller["raise"]["from"])
        else:
            self.assertEqual(next_smaller["verdict"], "rejected")

    def test_a_baseline_without_error_is_named_and_no_word_is_inf_or_nan(self):
        for arguments in (["--sequence", "random", "--reference-spp", "8"], ["--sky", "off", "--bounces", "0"],
                          ["--trace-samples", "1"]):
            for form in ([], ["--json"], ["--csv"]):
                settings = {**dict(zip(SMALL, SMALL.values())), "--spp": "4"}
                words = [w for o, v in settings.items() if o not in arguments for w in (o, v)]
                scene = SCENE if "--sky" in arguments else NAMED
                text = self.succeeds("sweep", *scene, *words, "--gpu", "gtx-980-ti", "--mu", "0,0.5,1",
                                     *([] if "--trace-samples" in arguments else ["--trace-samples", "2"]), *arguments,
                                     *form).text
                self.assertNotRegex(text, r"(?i)\b-?(inf|nan)\b", (arguments, form))
                if "--sky" in arguments and form != ["--csv"]:
                    self.assertIn("not defined: the baseline's error is 0", " ".join(text.split()))

    def test_the_plot_is_drawn_and_bad_input_to_it_refused(self):
        self.path("sweep.json").write_bytes(self.sweep("--json").stdout)
        plot = [sys.executable, ROOT / "tools/plot_sweep"]
        # matplotlib would look through all fonts again for a cache folder of its own.
        usual = {name: value for name, value in os.environ.items() if name != "XDG_CACHE_HOME"}
        document = json.loads(self.path("sweep.json").read_text())
        for row in document["rows"]:
            row["r8"] |= {"value": None, "half_width_95": None}
            row["rmse_ratio"] = row["rmse_ratio_half_width_95"] = None
        self.path("unknown.json").write_text(json.dumps(document))
        for name in ("sweep", "unknown"):
            with self.subTest(name):
                done = subprocess.run([*plot, f"{name}.json", "-o", "sweep.png"], cwd=self.folder, env=usual,
                                      capture_output=True, timeout=300, check=False)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertNotIn(b"Warning", done.stderr)
                self.assertEqual(self.path("sweep.png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.path("bad.json").write_text("{}")
        done = subprocess.run([*plot, "bad.json", "-o", "bad.png"], cwd=self.folder, env=usual, capture_output=True,
                              timeout=300, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertIn(b"bad.json", done.stderr)
        self.assertFalse(self.path("bad.png").exists())

    def test_bad_input_is_refused_in_one_line(self):
        for arguments, word in ((["--mu", "2"], "--mu"), (["--mu", "-0.1"], "--mu"), (["--mu", "nan"], "--mu"),
                                (["--swept", "no-such"], "no-such"), (["--baseline", "random"], "cranley-patterson"),
                                (["--spp", "0"], "0"), (["--max-r8", "nan"], "--max-r8"), (["--max-rmse", "-1"], "--max-rmse")):
            with self.subTest(arguments):
                self.refuses(2, "sweep", *small(*GPU, *arguments), mentions=[word])
        self.refuses(2, "sweep", *small(), mentions=["--gpu"])


if __name__ == "__main__":
    main()
