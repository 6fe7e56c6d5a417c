#!/usr/bin/python3
"""The JSON of every command: one envelope, keys in snake_case, the settings as they were resolved, no trace of threads."""
import os
import re
import shlex

from support import ENVELOPE, GPU, LAUNCHES, ROOT, SCENE, ProgramTest, main

KEY = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*\Z")
FUSED = ["compare", "--scene", *SCENE, *LAUNCHES, "--spp", "64"]
QUALITY = [*SCENE, "--resolution", "16x16", "--spp", "4", "--reference-spp", "16", "--trace-samples", "1", "--bounces", "1"]


def keys_of(value):
    if isinstance(value, dict):
        for key, inner in value.items():
            yield key
            yield from keys_of(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from keys_of(inner)


class JsonDocuments(ProgramTest):
    def documents(self):
        """Command -> document, of every command and kind of report that the program prints as JSON."""
        base = self.capture("base.rct", "--strategy", "cranley-patterson")
        other = self.capture("other.rct", "--strategy", "micro-jitter")
        self.path("profile.csv").write_text('"ID","dram__bytes_read.sum"\n"","Kbyte"\n"0","1,024.5"\n')
        self.path("gpu.toml").write_text((ROOT / "cachesim/gpus/v100.toml").read_text())
        self.path("open.toml").write_text(re.sub(r'(?m)^(?!node_instr)(.*), (?:range|choices) = .* }$', r"\1 }",
                                                 self.path("gpu.toml").read_text()))
        wave = "cranley-patterson,cranley-patterson+wavefront,cranley-patterson+morton"
        commands = [
            ["list"], ["list", "thread-maps"], ["list", "gpus", "--details"], ["info", base], ["verify", base],
            ["verify", base, "--recover", "rest.rct"], ["replay", base, "--gpu", "gpu.toml", "--by", "bounce"],
            ["replay", base, "--gpu", "rtx-3070", "--timed"], ["replay", base, "--gpu", "xeon-8380"],
            ["replay", base, *GPU, "--counters", "ncu"], ["compare", base, other, *GPU, "--gpu", "h100"],
            [*FUSED, "--strategy", wave, *GPU, "--by", "object"], [*FUSED, "--strategy", wave, "--gpu", "v100", "--timed"],
            [*FUSED, "--strategy", wave, *GPU, "--counters", "ncu"],
            ["curve", base, other, *GPU, "--level", "l1"], ["counters", base, *GPU, "--against", "profile.csv"],
            ["measure", *SCENE, *LAUNCHES, "--repeats", "1", "--modes", "single", "--no-shuffled"],
            ["explain", base, other, *GPU, "--by", "ray"], ["explain", base, other, "--gpu", "xeon-8380", "--by", "bounce"],
            ["quality", *QUALITY, *GPU, "--pairs", "--repeats", "2", "--strategy", "cranley-patterson,micro-jitter"],
            ["sensitivity", *SCENE, *LAUNCHES, "--bounces", "0", "--gpu", "open.toml", "--samples", "1"],
            ["sweep", *QUALITY, *GPU, "--mu", "0.5,1"], ["samples"], ["samples", "--strategy", "coherent"],
            ["samples", "--table", "discrepancy"], ["samples", "--table", "jitter"]]
        return [(command, self.warns(*command, "--json").json) for command in commands]

    def test_every_document_begins_with_the_envelope_and_has_keys_in_snake_case_only(self):
        version = self.succeeds("--version").text.split()
        seen = set()
        for command, document in self.documents():
            with self.subTest(" ".join(map(str, command))):
                keys = list(document)
                self.assertEqual(keys[:6], ENVELOPE[:6])
                self.assertEqual(document["schema_version"], 1)
                self.assertEqual([document["program"], document["version"]], version)
                self.assertEqual(document["command"], command[0])
                self.assertEqual([key for key in keys_of(document) if not KEY.match(key)], [])
                self.assertEqual(("gpus" in document), "--gpu" in command)
                seen.add(command[0])
        offered = re.findall(r"(?m)^ {2,4}([a-z]+) ", self.succeeds("--help").text)
        with_json = {name for name in offered if name != "raycache" and "--json" in self.succeeds(name, "--help").text}
        self.assertEqual(seen, with_json, "a command with --json that this test does not try, or the other way round")

    def test_the_command_line_of_a_document_makes_the_same_document_again(self):
        trace = self.capture("a trace.rct")
        for command in (["replay", trace, "--gpu", "rtx-3070", "--set", "l1.ways=8", "--set", "l1.policy='fifo'"],
                        [*FUSED, "--strategy", "coherent,cranley-patterson", *GPU, "--threads", "2"],
                        ["samples", "--spp", "32", "--k", "1"]):
            first = self.succeeds(*command, "--json")
            words = shlex.split(first.json["command_line"])
            self.assertEqual(words[0], "raycache")
            self.assertNotIn("--json", words)
            self.assertNotIn("--threads", words)
            again = self.succeeds(*words[1:], "--threads", "1", "--json")
            self.assertEqual(again.stdout, first.stdout)

    def test_settings_hold_what_was_given_and_every_default(self):
        settings = self.succeeds(*FUSED, "--strategy", "micro-jitter", *GPU, "--k", "discrepancy", "--json").json["settings"]
        for key, value in (("scene", "courtyard"), ("detail", 50000), ("strategy", ["micro-jitter"]), ("sequence", ["sobol"]),
                           ("spp", [64]), ("k", ["discrepancy"]), ("s", 2), ("mu", None), ("resolution", "64x48"),
                           ("bounces", 3), ("lights", "auto"), ("seed", 1), ("execution", "megakernel"),
                           ("order", "none"), ("timed", False), ("gpu", ["gtx-980-ti"]), ("by", "none"),
                           ("trace_samples", 2)):
            self.assertEqual(settings[key], value, key)
        for key in ("threads", "json", "csv", "save", "help"):
            self.assertNotIn(key, settings)

    def test_traces_hold_the_settings_behind_each_row_with_and_without_files(self):
        trace = self.capture("mj.rct", "--strategy", "micro-jitter", "--k", "1")
        from_file = self.succeeds("compare", trace, *GPU, "--json").json["traces"]
        fused = self.succeeds(*FUSED, "--strategy", "micro-jitter", "--k", "1", *GPU, "--json").json["traces"]
        self.assertEqual((from_file[0]["file"], fused[0]["file"]), (str(trace), None))
        for key in ("scene", "scene_hash", "camera", "strategy", "sequence", "spp", "k", "s", "mu", "seed", "resolution",
                    "bounces", "thread_map", "execution", "order", "samples", "command_line"):
            self.assertEqual(from_file[0][key], fused[0][key], key)
        self.assertEqual((fused[0]["k"], fused[0]["mu"]), (1, 0.125))

    def test_a_changed_gpu_lists_its_changes(self):
        trace = self.capture()
        changed = ["--set", "l1.ways=2", "--warps-per-sm", "24"]
        gpu, = self.succeeds("replay", trace, *GPU, *changed, "--json").json["gpus"]
        self.assertEqual(gpu["name"], "gtx-980-ti (l1.ways=2, warps_per_sm=24)")
        self.assertEqual(gpu["changes"], [{"key": "l1.ways", "value": 2}, {"key": "warps_per_sm", "value": 24}])
        plain, = self.succeeds("replay", trace, *GPU, "--json").json["gpus"]
        self.assertEqual(plain["changes"], [])
        self.assertEqual((gpu["warps_per_sm"], plain["sms"]), (24, gpu["sms"]))
        self.assertLess(gpu["l1_bytes"], plain["l1_bytes"])

    def test_a_file_name_that_is_no_utf_8_does_not_end_the_program(self):
        trace = self.capture()
        odd = bytes(self.folder) + b"/\xff.rct"
        with open(odd, "wb") as file:
            file.write(trace.read_bytes())
        document = self.succeeds("info", os.fsdecode(odd), "--json").json
        self.assertIn("\ufffd.rct", document["traces"][0]["file"])


if __name__ == "__main__":
    main()
