#!/usr/bin/python3
"""raycache --help, --version and list."""
import re

from support import GPU, LAUNCHES, PICTURE, SCENE, ProgramTest, main

SUBCOMMANDS = ["render", "capture", "info", "verify", "replay", "compare", "counters", "explain", "export",
               "import", "list"]
TOPICS = ["strategies", "groups", "sequences", "gpus", "layouts", "integrators", "thread-maps", "orders", "scenes",
          "figures", "timed-figures"]


class HelpAndList(ProgramTest):
    def test_the_help_of_the_program_names_every_subcommand_and_shows_an_example(self):
        text = self.succeeds("--help").text
        for name in SUBCOMMANDS:
            self.assertRegex(text, rf"(?m)^ +{name} ")
        self.assertIn("raycache compare ", text)

    def test_the_help_of_every_subcommand_shows_examples_of_that_subcommand(self):
        for name in SUBCOMMANDS:
            with self.subTest(name):
                text = self.succeeds(name, "--help").text
                self.assertRegex(text, rf"(?s)Examples:.*\n +raycache {name}\b")

    def test_every_option_of_every_subcommand_has_a_description(self):
        for name in SUBCOMMANDS:
            for line in re.sub(r"\n {20,}", " ", self.succeeds(name, "--help").text).splitlines():
                if re.match(r"^  -{1,2}[a-z]", line):
                    option = r"^  \S+( [A-Z]+(:\S+)?(=\S+)?)?( in \[.*?\])?( REQUIRED)?( \.\.\.)?"
                    without_type = re.sub(option, "", line)
                    self.assertRegex(without_type, r"[a-zA-Z]{2}", f"{name}: {line!r}")

    def test_the_version_is_one_line_with_the_name_of_the_program(self):
        self.assertRegex(self.succeeds("--version").text, r"\Araycache \d+\.\d+\.\d+\n\Z")

    def test_list_without_a_topic_shows_all_topics(self):
        text = self.succeeds("list").text
        for topic in TOPICS:
            self.assertRegex(text, rf"(?m)^{topic}$")

    def test_list_gives_each_name_a_description_in_text_and_in_json(self):
        listed = self.succeeds("list", "--json").json["topics"]
        self.assertEqual(list(listed), [topic.replace("-", "_") for topic in TOPICS])
        text = self.succeeds("list").text
        for topic, entries in listed.items():
            name = topic.replace("_", "-")
            self.assertGreater(len(entries), 0, topic)
            for entry in entries:
                self.assertRegex(entry["name"], r"\A[a-z0-9_-]+\Z")
                self.assertGreater(len(entry["description"]), 10, entry)
                self.assertIn(f"  {entry['name']}", text if len(entries) <= 30 else self.succeeds("list", name).text)
            if len(entries) > 30:
                self.assertIn(f"  {len(entries)} of them: raycache list {name}", text)
            one = self.succeeds("list", name, "--json").report
            self.assertEqual(one, {"topics": {topic: entries}})

    def test_the_details_of_the_gpus_give_every_value_with_its_source_in_text_and_in_json(self):
        listed = self.succeeds("list", "gpus", "--json").json["topics"]["gpus"]
        gpus = self.succeeds("list", "gpus", "--details", "--json").json["gpu_presets"]
        self.assertEqual([gpu["name"] for gpu in gpus], [gpu["name"] for gpu in listed])
        text = self.succeeds("list", "gpus", "--details", "--wide").text
        for gpu in gpus:
            values = [gpu[key] for key in ("sms", "warps_per_sm", "warps_per_cta", "l1_per_sm")]
            for cache in [gpu[level] for level in ("l1", "l2", "l3") if level in gpu]:
                values += [cache[key] for key in ("sets", "ways", "line_bytes", "sector_bytes", "index", "policy")]
                slices = cache.get("slices", {"value": 1})["value"]
                self.assertEqual(cache["bytes"], slices * cache["sets"]["value"] * cache["ways"]["value"] *
                                 cache["line_bytes"]["value"])
            for value in values:
                self.assertGreater(len(value["source"]), 6, gpu["name"])
                self.assertIn(f"{value['value']}  {value['source']}\n", text)
            self.assertRegex(text, rf"(?m)^{gpu['name']} +{gpu['sms']['value']} .* {gpu['l1']['bytes'] // 1024} ")

    def test_the_keys_of_gpu_files_come_with_what_they_may_be_in_text_and_in_json(self):
        keys = self.succeeds("list", "gpus", "--keys", "--json").json["gpu_keys"]
        text = self.succeeds("list", "gpus", "--keys", "--wide").text
        for key in keys:
            self.assertIn(f"  {key['values']}", text)
            self.assertRegex(text, rf"(?m)^  {key['name']} .*{re.escape(key['meaning'])}$")
            self.assertEqual(key["default"] is None, key["needed"])
        ways, = (key for key in keys if key["name"] == "ways")
        self.assertEqual(ways["sections"], ["l1", "l2", "l3"])
        self.refuses(2, "list", "scenes", "--keys", mentions=["list gpus --keys"])
        self.refuses(2, "list", "gpus", "--keys", "--details", mentions=["list gpus --keys"])

    def test_details_are_refused_where_there_are_none(self):
        self.refuses(2, "list", "--details", mentions=["list gpus --details"])
        self.refuses(2, "list", "scenes", "--details", mentions=["scenes"])

    def test_every_listed_strategy_sequence_gpu_and_thread_map_works(self):
        listed = {topic: ",".join(entry["name"] for entry in entries)
                  for topic, entries in self.succeeds("list", "--json").json["topics"].items()}
        for options in (["--strategy", listed["strategies"], "--gpu", listed["gpus"]],
                        ["--strategy", "micro-jitter", "--sequence", listed["sequences"], *GPU]):
            report = self.succeeds("compare", "--scene", *SCENE, *LAUNCHES, *options, "--json").json
            for key, option in (("strategy", "--strategy"), ("sequence", "--sequence"), ("gpu", "--gpu")):
                if option in options:
                    wanted = set(options[options.index(option) + 1].split(","))
                    self.assertEqual({row[key] for row in report["rows"]}, wanted)
        for name in listed["thread_maps"].split(","):
            report = self.succeeds("compare", "--scene", *SCENE, *PICTURE, "--trace-samples", "32", "--bounces", "0",
                                   "--thread-map", name, "--strategy", "coherent", *GPU, "--json").json
            self.assertEqual({row["thread_map"].split(":")[0] for row in report["rows"]}, {name})

    def test_every_listed_scene_renders(self):
        for entry in self.succeeds("list", "scenes", "--json").json["topics"]["scenes"]:
            self.succeeds("render", entry["name"], "--resolution", "16x16", "--spp", "1", "-o", entry["name"] + ".png")


if __name__ == "__main__":
    main()
