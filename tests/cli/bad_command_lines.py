#!/usr/bin/python3
"""Mistakes on the command line: exit code 2, one line that says what is wrong and what would be right."""
from support import GPU, ProgramTest, main

CAPTURE = ["capture", "courtyard", "-o", "trace.rct"]
RENDER = ["render", "courtyard", "-o", "picture.png"]
COMPARE = ["compare", "--scene", "courtyard", *GPU]
SMALL = {"--detail": "50000", "--resolution": "64x48", "--trace-samples": "2", "--spp": "16"}


class BadCommandLines(ProgramTest):
    def refuses_option(self, command, *options, **keywords):
        """Refuses options added to a small job: one that is accepted by mistake must not take for ever."""
        small = []
        for option, value in SMALL.items():
            if option not in options and (option != "--trace-samples" or command[0] != "render"):
                small += [option, value]
        self.refuses(2, *command, *small, *options, **keywords)

    def names(self, topic):
        return [entry["name"] for entry in self.succeeds("list", topic, "--json").json["topics"][topic.replace("-", "_")]]

    def test_no_subcommand_an_unknown_one_and_an_unknown_option(self):
        self.refuses(2)
        self.refuses(2, "trace")
        self.refuses(2, "list", "--colour")
        self.refuses_option(CAPTURE, "--bounce", "1")

    def test_what_nobody_knows_is_said_before_what_is_missing(self):
        self.refuses(2, "bogus", "--help", mentions=["bogus"])
        self.refuses(2, "--hlep", mentions=["--help"])
        self.refuses(2, "help", mentions=["--help"])
        self.refuses(2, "replay", "--set", "l1.wayz=3", mentions=["l1.wayz", "did you mean 'l1.ways'"])
        self.refuses(2, "replay", "no.rct", "--set", "foo=1", mentions=["foo"])
        for option, word in (("--strategy", "bogus"), ("--layout", "bogus"), ("--spp", "nan"), ("--sky", "dark")):
            self.refuses(2, "render", "no.glb", option, word, "-o", "p.png", mentions=[option, word])
        self.refuses(2, "capture", "no.glb", "--order", "bogus", "-o", "t.rct", mentions=["--order"])

    def test_a_misspelt_value_of_a_gpu_key_gets_a_suggestion(self):
        self.capture("t.rct")
        for change, meant in (("l1.policy=lur", "lru"), ("l1.index=xorfold", "xor_fold")):
            self.refuses(2, "replay", "t.rct", *GPU, "--set", change, mentions=[f"did you mean '{meant}'"])
        self.refuses(2, "replay", "t.rct", *GPU, "--set", "l1.ways=many", mentions=['"many"'])

    def test_a_missing_argument_is_named(self):
        self.refuses(2, "render", "courtyard", mentions=["--output"])
        self.refuses(2, "capture", "-o", "trace.rct", mentions=["SCENE"])
        self.refuses(2, "info", mentions=["TRACE"])
        self.refuses(2, "replay", "trace.rct", mentions=["--gpu"])
        self.refuses(2, "compare", "--scene", "courtyard", mentions=["--gpu"])

    def test_resolutions_that_are_zero_huge_or_no_resolution(self):
        for text in ("0x0", "0x48", "64x0", "100000x100000", "99999999999999999999x1", "64", "64x", "x48", "64x48x2",
                     "-64x48", "64x-48", "64.5x48", "64 x 48", "axb", ""):
            with self.subTest(text):
                self.refuses_option(CAPTURE, "--resolution", text, mentions=["--resolution", "WIDTHxHEIGHT"])
        self.refuses_option(RENDER, "--resolution", "0x0", mentions=["--resolution", "WIDTHxHEIGHT"])
        self.refuses_option(COMPARE, "--resolution", "100000x100000", mentions=["--resolution", "WIDTHxHEIGHT"])

    def test_sample_counts_that_are_zero_negative_or_no_number(self):
        for text in ("0", "-1", "1.5", "many", "99999999999999999999999", "nan", ""):
            with self.subTest(text):
                self.refuses_option(CAPTURE, "--spp", text)
                self.refuses_option(CAPTURE, "--trace-samples", text)
        for text in ("0", "-1", "many"):
            with self.subTest(text):
                self.refuses_option(RENDER, "--spp", text)
                self.refuses_option(COMPARE, "--spp", "16," + text)
        self.refuses_option(CAPTURE, "--spp", "4294967297")

    def test_other_numbers_that_are_out_of_range(self):
        for option, values in (("--bounces", ("-1", "65", "x")), ("--bounces-diffuse", ("-1", "65", "x")),
                               ("--bounces-transmission", ("-1", "65", "x")), ("--lights", ("sun", "")), ("--threads", ("0", "-2", "two", "100000")),
                               ("--k", ("-1", "nan", "inf", "k")), ("--s", ("0", "-1", "x")),
                               ("--mu", ("-0.5", "nan", "inf", "-nan", "half", "0.5x")),
                               ("--seed", ("-1", "x")), ("--fov", ("-1", "180", "nan", "wide")),
                               ("--detail", ("1", "-5", "99999999999", "fine"))):
            for value in values:
                with self.subTest(f"{option} {value}"):
                    self.refuses_option(CAPTURE, option, value)
        for value in ("-1", "x", "100000000"):
            with self.subTest(f"--warps-per-sm {value}"):
                self.refuses_option(COMPARE, "--warps-per-sm", value)

    def test_an_unknown_name_is_answered_with_the_valid_ones(self):
        for topic, option in (("strategies", "--strategy"), ("sequences", "--sequence"),
                              ("thread-maps", "--thread-map")):
            for command in (CAPTURE, COMPARE):
                with self.subTest(f"{command[0]} {option}"):
                    self.refuses_option(command, option, "nonsense", mentions=["nonsense", *self.names(topic)])
        self.refuses_option(COMPARE, "--gpu", "gtx-9999", mentions=["gtx-9999", *self.names("gpus")])
        self.refuses(2, "capture", "atrium", "-o", "trace.rct", mentions=["atrium", *self.names("scenes")])
        self.refuses(2, "list", "colours", mentions=["colours", "strategies", "sequences", "gpus", "scenes"])
        self.refuses_option(COMPARE, "--by", "colour", mentions=["colour", "none", "bounce", "ray", "object"])
        self.refuses_option(COMPARE, "--baseline", "random", mentions=["random", "coherent", "cranley-patterson"])
        self.refuses_option(CAPTURE, "--sky", "blue", mentions=["blue", "auto", "on", "off"])

    def test_an_unknown_camera_is_answered_with_the_cameras_of_the_scene(self):
        for camera in ("nonsense", "99", "-1"):
            with self.subTest(camera):
                self.refuses_option(CAPTURE, "--camera", camera, mentions=[camera])

    def test_a_number_with_leading_zeros_is_decimal(self):
        small = [word for option, value in SMALL.items() if option != "--spp" for word in (option, value)]
        self.succeeds(*CAPTURE, *small, "--spp", "064")
        info = self.succeeds("info", "trace.rct", "--json").text
        self.assertIn("--spp 64 ", info)

    def test_numbers_that_are_no_plain_decimals_are_refused(self):
        for word in ("", " 16", "16 ", "+16", "0x10", "1e1", "1_6"):
            for option in ("--spp", "--bounces", "--seed", "--trace-samples", "--threads", "--interleave"):
                with self.subTest(f"{option} '{word}'"):
                    self.refuses_option(CAPTURE, option, word, mentions=[option])

    def test_what_is_misspelt_is_said_before_what_is_missing(self):
        for command, meant in ((["compre", "courtyard"], "compare"), (["capture", "--bounce", "1"], "--bounces"),
                               (["compare", "--strategy", "micro-jiter"], "micro-jitter"),
                               (["capture", "courtyrd"], "courtyard"), (["replay", "--gpu", "3070"], "rtx-3070")):
            self.assertTrue(self.refuses(2, *command).endswith(f"did you mean '{meant}'?"), command)

    def test_views_that_make_no_sense(self):
        self.refuses_option(CAPTURE, "--eye", "1,2,3")
        self.refuses_option(CAPTURE, "--look-at", "1,2,3")
        self.refuses_option(CAPTURE, "--eye", "1,2,3", "--look-at", "1,2,3")
        for text in ("1,2", "1,2,3,4", "1;2;3", "a,b,c", "1,2,nan", "inf,2,3", ""):
            with self.subTest(text):
                self.refuses_option(CAPTURE, "--eye", text, "--look-at", "0,0,0")

    def test_conflicting_or_missing_inputs_of_compare(self):
        self.refuses(2, "compare", *GPU, mentions=["--scene"])
        trace = self.capture()
        self.refuses(2, "compare", trace, "--scene", "courtyard", *GPU, mentions=["--scene"])
        self.refuses(2, *COMPARE, trace, mentions=["--scene"])
        self.refuses_option(COMPARE, "--json", "--csv", mentions=["--json", "--csv"])
        self.refuses_option(CAPTURE, "--seed", "1", "--seed", "2", mentions=["--seed"])
        self.refuses(2, "replay", trace, *GPU, "--json", "--csv", mentions=["--json", "--csv"])

    def test_a_picture_name_without_a_known_ending_is_refused_before_the_work(self):
        for name in ("picture", "picture.gif", "picture.png.txt", ".png.", ""):
            with self.subTest(name):
                self.refuses(2, "render", "courtyard", "--resolution", "4096x4096", "--spp", "4096", "-o", name,
                             timeout=30)

    def test_a_name_with_control_characters_does_not_reach_the_terminal(self):
        line = self.refuses(2, "capture", "evil\x1b[31m\nname", "-o", "trace.rct")
        self.assertNotIn("\x1b", line)


if __name__ == "__main__":
    main()
