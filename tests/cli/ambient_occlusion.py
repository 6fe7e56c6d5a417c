#!/usr/bin/python3
"""--integrator ao and ssao: pictures, traces and reports of them, their options, and what has no effect on them."""
from support import GPU, LAUNCHES, PICTURE, SCENE, ProgramTest, main

SSAO = ["--integrator", "ssao"]
FUSED = [*SCENE, *LAUNCHES, "--spp", "64", "--strategy", "cranley-patterson,micro-jitter"]
FORMATS = [["--depth-layout", layout, "--depth-bytes", size] for layout in ("linear", "tiled") for size in ("4", "2")]


class AmbientOcclusion(ProgramTest):
    def warned(self, *arguments):
        lines = [line.removeprefix("raycache: warning: ") for line in self.warns(*arguments).stderr.splitlines()]
        return {line.split(" has no effect: ")[0] for line in lines if " has no effect: " in line}

    def test_a_trace_of_the_screen_has_depths_and_normals_alone_whatever_the_number_of_threads(self):
        for form in FORMATS:
            traces = [self.capture(f"{n}.rct", *SSAO, *form, "--threads", n) for n in (1, 2)]
            self.assertEqual(traces[0].read_bytes(), traces[1].read_bytes())
            self.succeeds("verify", traces[0])
            regions = self.succeeds("info", traces[0], "--json").json["regions"]
            self.assertEqual([region["kind"] for region in regions], ["depth", "normal"])
            self.assertEqual(regions[0]["element_bytes"], int(form[3]))
            self.assertGreaterEqual(regions[0]["count"], 64 * 48)
        rows = self.succeeds("replay", traces[0], *GPU, "--by", "object", "--json").json["rows"]
        self.assertEqual({row["group"] for row in rows}, {"depth", "normal"})

    def test_a_trace_in_the_world_walks_the_bvh_with_a_camera_ray_and_one_more(self):
        traces = [self.capture(f"{n}.rct", "--integrator", "ao", "--threads", n) for n in (1, 2)]
        self.assertEqual(traces[0].read_bytes(), traces[1].read_bytes())
        rows = self.succeeds("replay", traces[0], *GPU, "--by", "ray", "--json").json["rows"]
        rays = {row["group"]: row["totals"]["rays"] for row in rows}
        self.assertEqual(rays["camera"], 2 * 64 * 48)
        self.assertTrue(0 < rays["shadow"] <= rays["camera"])
        self.assertEqual(set(rays), {"camera", "shadow"})

    def test_the_same_command_makes_the_same_trace_again(self):
        trace = self.capture("a.rct", *SSAO, "--radius", "0.5", "--steps", "3", "--thickness", "2", "--depth-bytes", "2")
        command = self.succeeds("info", trace, "--json").json["traces"][0]["command_line"].split()
        self.assertEqual(command[:2], ["raycache", "capture"])
        self.succeeds(*command[1:], "-o", "b.rct")
        self.assertEqual(trace.read_bytes(), self.path("b.rct").read_bytes())

    def test_compare_from_a_scene_counts_what_the_traces_of_it_count(self):
        fused = self.succeeds("compare", *FUSED, *SSAO, *GPU, "--json").json
        for row in fused["rows"]:
            trace = self.capture("t.rct", *SSAO, "--strategy", row["strategy"])
            self.assertEqual(self.succeeds("replay", trace, *GPU, "--json").json["rows"][0]["totals"], row["totals"])
            self.assertEqual(row["totals"]["steps"], 0)
            self.assertEqual(row["totals"]["rays"], 2 * 64 * 48)

    def test_strategies_are_compared_in_time_explained_and_mapped(self):
        for integrator in ("ao", "ssao"):
            what = [*FUSED, "--integrator", integrator]
            self.succeeds("compare", *what, "--gpu", "rtx-3070", "--timed")
            text = self.succeeds("explain", *what, *GPU, "--by", "ray", "--heatmap", "map.exr").text
            self.assertIn("depths" if integrator == "ssao" else "nodes", text)
            self.assertTrue(self.path("map.png").exists())
            quality = self.succeeds("quality", *SCENE, "--resolution", "16x16", "--spp", "4", "--reference-spp", "16",
                                    "--strategy", "cranley-patterson", "--integrator", integrator, "--json").json
            self.assertGreater(quality["rows"][0]["rmse"]["value"], 0)

    def test_estimates_from_windows_take_the_screen_too(self):
        rows = self.warns("compare", *SCENE, "--resolution", "128x96", "--spp", "4", *SSAO, "--windows", "2",
                             "--strategy", "cranley-patterson,coherent", *GPU, "--json").json["rows"]
        self.assertEqual({row["strategy"] for row in rows}, {"cranley-patterson", "coherent"})

    def test_a_picture_depends_on_the_radius(self):
        for integrator in ("ao", "ssao"):
            for radius in ("0.1", "1"):
                self.succeeds("render", *SCENE, *PICTURE, "--spp", "4", "--integrator", integrator, "--radius", radius,
                              "-o", f"{integrator}-{radius}.hdr")
            self.assertNotEqual(self.path(f"{integrator}-0.1.hdr").read_bytes(), self.path(f"{integrator}-1.hdr").read_bytes())

    def test_extremes_are_pictures_too(self):
        for options in (["--resolution", "1x1"], ["--radius", "0"], ["--radius", "1e18"], ["--steps", "1"],
                        ["--steps", "1024", "--resolution", "16x16"], ["--thickness", "0"],
                        ["--eye", "0,500,0", "--look-at", "0,900,1"]):  # the sky alone
            for form in FORMATS:
                options = options if "--resolution" in options else [*PICTURE, *options]
                self.succeeds("capture", *SCENE, *options, *form, *SSAO, "--spp", "4", "--trace-samples", "1",
                              "--strategy", "coherent", "-o", "t.rct")
                self.succeeds("replay", "t.rct", *GPU)

    def test_options_that_an_integrator_does_not_read_have_no_effect(self):
        small = [*SCENE, "--resolution", "16x16", "--spp", "4", "--trace-samples", "1", "-o", "t.rct"]
        light = {"--bounces": "2", "--bounces-diffuse": "1", "--bounces-transmission": "1", "--lights": "nee"}
        march = {"--steps": "4", "--thickness": "1", "--depth-layout": "tiled", "--depth-bytes": "2"}
        tree = {"--layout": "bvh4"}
        given = [word for pair in {**light, **march, **tree, "--radius": "1"}.items() for word in pair]
        given += ["--russian-roulette", "--spatial-splits"]
        self.assertEqual(self.warned("capture", *small, *given), {*march, "--radius"})
        self.assertEqual(self.warned("capture", *small, *given, "--integrator", "ao"), {*light, *march, "--russian-roulette"})
        self.assertEqual(self.warned("capture", *small, *given, *SSAO),
                         {*light, *tree, "--russian-roulette", "--spatial-splits"})
        text = self.warns("capture", *small, "--radius", "1").stderr
        self.assertIn("--radius has no effect: integrator path does not read it (ao, ssao do)", text)

    def test_values_that_cannot_be_are_refused_in_one_line(self):
        for option, value, mentions in (("--radius", "-1", ["0 to 1e+18", "auto"]), ("--radius", "wide", ["auto"]),
                                        ("--steps", "0", ["1 to 1024"]), ("--steps", "1025", ["1 to 1024"]),
                                        ("--steps", "2.5", ["1 to 1024"]), ("--thickness", "nan", ["auto"]),
                                        ("--depth-layout", "tield", ["linear, tiled", "did you mean 'tiled'?"]),
                                        ("--depth-bytes", "3", ["2, 4"])):
            for command in (["capture", *SCENE, "-o", "t.rct"], ["compare", *SCENE, *GPU], ["render", *SCENE, "-o", "p.png"]):
                self.refuses(2, *command, *SSAO, option, value, mentions=[option, *mentions])

    def test_what_cannot_be_had_of_them_is_refused(self):
        for integrator in ("ao", "ssao"):
            self.refuses(2, "capture", *SCENE, "--integrator", integrator, "--execution", "wavefront", "-o", "t.rct",
                         mentions=[integrator, "megakernel"])
        self.refuses(2, "measure", *SCENE, *SSAO, mentions=["ssao", "--integrator"])


if __name__ == "__main__":
    main()
