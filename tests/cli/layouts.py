#!/usr/bin/python3
"""--layout and --integrator: how the BVH lies in memory, and what is computed along the rays."""
from support import GPU, LAUNCHES, SCENE, ProgramTest, main

DEFAULT, OTHER = "bvh2", "bvh2-breadth-first"


class Layouts(ProgramTest):
    def names(self, topic):
        return [entry["name"] for entry in self.succeeds("list", topic, "--json").json["topics"][topic]]

    def test_a_trace_in_every_layout_is_whole_and_names_it(self):
        self.assertLess({DEFAULT, OTHER}, {*self.names("layouts"), "no layout"})
        for name in self.names("layouts"):
            trace = self.capture(name + ".rct", "--layout", name)
            self.succeeds("verify", trace)
            info = self.succeeds("info", trace, "--json")
            self.assertEqual(info.json["traces"][0]["layout"], name)
            self.assertEqual(f" --layout {name} " in info.text, name != DEFAULT)

    def test_the_default_layout_and_integrator_leave_the_bytes_of_a_trace_as_they_are(self):
        plain = self.capture("plain.rct").read_bytes()
        self.assertEqual(self.capture("named.rct", "--layout", DEFAULT, "--integrator", "path").read_bytes(), plain)
        one, two = (self.capture(f"{n}.rct", "--layout", OTHER, "--threads", n).read_bytes() for n in (1, 2))
        self.assertEqual(one, two)
        self.assertNotEqual(one, plain)

    def test_layouts_of_one_tree_make_the_same_steps_and_other_traffic(self):
        traces = [self.capture(name + ".rct", "--layout", name) for name in (DEFAULT, OTHER)]
        for command in (["compare", *traces], ["explain", *traces]):
            self.succeeds(*command, *GPU)
        rows = [self.succeeds("replay", trace, *GPU, "--json").json["rows"][0]["totals"] for trace in traces]
        for same in ("rays", "steps", "warp_accesses"):
            self.assertEqual(rows[0][same], rows[1][same])
        self.assertNotEqual(rows[0]["l2_sectors"], rows[1]["l2_sectors"])
        fused = self.succeeds("compare", *SCENE, *LAUNCHES, "--spp", "64", "--strategy", "micro-jitter", "--layout", OTHER,
                              *GPU, "--json").json
        self.assertEqual(fused["rows"][0]["totals"], rows[1])
        self.assertEqual(fused["traces"][0]["layout"], OTHER)

    def test_layouts_side_by_side_are_rows_of_each_strategy_held_against_the_baseline_in_the_first(self):
        both = ["--spp", "64", "--strategy", "cranley-patterson,micro-jitter", "--layout", "bvh2,bvh4,cwbvh8"]
        fused = self.succeeds("compare", *SCENE, *LAUNCHES, *both, *GPU, "--json").json
        names = [s + layout for s in ("cranley-patterson", "micro-jitter") for layout in ("", "/bvh4", "/cwbvh8")]
        self.assertEqual([row["strategy"] for row in fused["rows"]], names)
        self.assertEqual(fused["baseline"], "cranley-patterson")
        self.assertEqual([trace["layout"] for trace in fused["traces"]], ["bvh2", "bvh4", "cwbvh8"] * 2)
        totals = {row["strategy"]: row["totals"] for row in fused["rows"]}
        for name in names:  # the same paths, in fewer and larger steps
            self.assertEqual(totals[name]["rays"], totals[name.split("/")[0]]["rays"])
        steps = [totals["micro-jitter" + layout]["steps"] for layout in ("", "/bvh4", "/cwbvh8")]
        self.assertEqual(sorted(steps, reverse=True), steps)
        self.assertLess(steps[2], 0.6 * steps[0])
        trace = self.capture("wide.rct", "--layout", "cwbvh8", "--strategy", "micro-jitter")
        self.assertEqual(self.succeeds("replay", trace, *GPU, "--json").json["rows"][0]["totals"], totals["micro-jitter/cwbvh8"])
        one = self.succeeds("compare", *SCENE, *LAUNCHES, *both, "--baseline", "micro-jitter/cwbvh8", *GPU, "--json").json
        self.assertEqual(one["baseline"], "micro-jitter/cwbvh8")
        self.assertTrue(all("l2_bytes_ratio" in row for row in one["rows"] if row["strategy"] != one["baseline"]))

    def test_one_strategy_in_several_layouts_is_held_against_the_first(self):
        rows = self.succeeds("compare", *SCENE, *LAUNCHES, "--spp", "64", "--strategy", "micro-jitter/bvh4,micro-jitter/cwbvh8",
                             *GPU, "--json").json
        self.assertEqual(rows["baseline"], "micro-jitter/bvh4")
        text = self.succeeds("explain", *SCENE, *LAUNCHES, "--spp", "64", "--strategy", "micro-jitter/bvh2,micro-jitter/cwbvh8",
                             *GPU).text
        self.assertIn("micro-jitter/cwbvh8", text)

    def test_an_explanation_straight_from_a_scene_takes_a_layout(self):
        text = self.succeeds("explain", *SCENE, *LAUNCHES, "--spp", "64", "--layout", OTHER, *GPU, "--counts-only",
                             "--json").json
        self.assertEqual({trace["layout"] for trace in text["traces"]}, {OTHER})

    def test_a_picture_walks_no_layout(self):
        small = [*SCENE, "--resolution", "16x16", "--spp", "1"]
        warned = self.warns("render", *small, "--layout", OTHER, "-o", "a.png").stderr
        self.assertIn("--layout has no effect", warned)
        self.succeeds("render", *small, "--integrator", "path", "-o", "b.png")
        self.assertEqual(self.path("a.png").read_bytes(), self.path("b.png").read_bytes())

    def test_unknown_names_are_answered_with_the_valid_ones_and_the_closest(self):
        for option, topic, wrong, meant in (("--layout", "layouts", "bvh2-bredth-first", OTHER),
                                            ("--integrator", "integrators", "pth", "path")):
            for command in (["capture", *SCENE, "-o", "t.rct"], ["compare", *SCENE, *GPU], ["explain", *SCENE, *GPU],
                            ["quality", *SCENE], ["sweep", *SCENE, *GPU], ["render", *SCENE, "-o", "p.png"]):
                with self.subTest(f"{command[0]} {option}"):
                    line = self.refuses(2, *command, option, wrong, mentions=[wrong, option, *self.names(topic)])
                    self.assertTrue(line.endswith(f"did you mean '{meant}'?"), line)


if __name__ == "__main__":
    main()
