// What the values of GPU files may be instead: ranges and choices, in presets and in files of users.
#include "cachesim/gpus/gpu_ranges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>

#include "cachesim/gpus/gpu_file.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::cachesim;

namespace {

constexpr const char* head = R"(name = "tiny"
description = "for tests"
warps_per_sm = 4
warps_per_cta = 2
l1_per_sm = 1
)";
constexpr const char* caches = R"([l1]
sets = 4
ways = 3
line_bytes = 128
sector_bytes = 32
index = "modulo"
policy = "lru"
[l2]
sets = 4
ways = 6
line_bytes = 128
sector_bytes = 32
index = "xor_fold"
policy = "lru"
)";

/// A GPU whose line 6 is this.
std::string file(const std::string& line) { return head + line + '\n' + caches; }

std::string error(const std::string& line) {
    try {
        parse_gpu(file(line), "f.toml");
    } catch (const UsageError&) {
        FAIL("a bad file is no bad command line");
    } catch (const Error& e) {
        return e.what();
    }
    return "accepted";
}

std::string sms(const std::string& others) { return "sms = { value = 4, source = \"s\", " + others + " }"; }

const GpuValue& value_of(const std::vector<GpuValue>& values, const std::string& key) {
    const auto found = std::find_if(values.begin(), values.end(), [&](const GpuValue& v) { return v.key == key; });
    REQUIRE(found != values.end());
    return *found;
}

}  // namespace

TEST_CASE("every value that a preset assumes has a range around it, and a reason for it") {
    unsigned ranges = 0;
    for (const GpuPreset& preset : gpu_presets())
        for (const GpuValue& value : gpu_values(preset.name)) {
            CAPTURE(preset.name, value.key, value.source);
            if (value.source.find("assumed") != std::string::npos) CHECK(value.range.has_value());
            if (!value.range) continue;
            CHECK(value.range->source.size() > 10);
            CHECK_FALSE(value.range->values.empty());
            ++ranges;
        }
    CHECK(ranges > 300);
}

TEST_CASE("every end and choice of a preset's ranges makes a GPU that can be replayed") {
    for (const GpuPreset& preset : gpu_presets())
        for (const GpuValue& value : open_values(preset.name))
            for (const std::string& other : value.range->values) {
                CAPTURE(preset.name, value.key, other);
                CHECK_NOTHROW(load_with(preset.name, {}, {{value.key, other}}));
            }
}

TEST_CASE("all lower ends together, and all upper ends, make GPUs too") {
    for (const GpuPreset& preset : gpu_presets()) {
        CAPTURE(preset.name);
        std::vector<ChosenValue> low, high;
        for (const GpuValue& value : open_values(preset.name)) {
            low.emplace_back(value.key, value.range->values.front());
            high.emplace_back(value.key, value.range->values.back());
        }
        CHECK(low.size() > 5);
        CHECK_NOTHROW(load_with(preset.name, {}, low));
        CHECK_NOTHROW(load_with(preset.name, {}, high));
    }
}

TEST_CASE("a range is read with its reason, and leaves the value as it was") {
    const std::string text = file(sms("range = [2, 9], range_source = \"why\""));
    CHECK(parse_gpu(text, "f.toml").sms == 4);
    const auto values = parse_gpu_values(text, "f.toml");
    const GpuValue& value = value_of(values, "sms");
    CHECK(value.value == "4");
    REQUIRE(value.range);
    CHECK_FALSE(value.range->listed);
    CHECK(value.range->values == std::vector<std::string>{"2", "9"});
    CHECK(value.range->source == "why");
    CHECK(value.range->leaves_open());
    CHECK_FALSE(value_of(values, "l1.ways").range);

    const auto listed = parse_gpu_values(
        file("sms = 4\nscheduler = { value = \"loose_round_robin\", source = \"s\", choices = [\"greedy_then_oldest\", "
             "\"loose_round_robin\"] }"),
        "f.toml");
    CHECK(value_of(listed, "scheduler").range->values ==
          std::vector<std::string>{"greedy_then_oldest", "loose_round_robin"});
    CHECK_FALSE(value_of(parse_gpu_values(file(sms("range = [4, 4]")), "f.toml"), "sms").range->leaves_open());
    CHECK_FALSE(value_of(parse_gpu_values(text, "f.toml", {"sms=5"}), "sms").range);
}

TEST_CASE("ranges that make no sense are refused with file, line and key") {
    using Catch::StartsWith;
    CHECK_THAT(error(sms("range = [9, 2]")),
               StartsWith("f.toml:6: sms.range: expected the lower end first, found 9 and 2; swap them"));
    CHECK_THAT(error(sms("range = [5, 9]")),
               StartsWith("f.toml:6: sms.range: expected ends around the value, 4, found"));
    CHECK_THAT(error(sms("range = [2, 5000]")), StartsWith("f.toml:6: sms.range: expected 1 to 4096, found 5000"));
    CHECK_THAT(error(sms("range = [0, 9]")), StartsWith("f.toml:6: sms.range: expected a positive whole number"));
    CHECK_THAT(error(sms("range = [2, 9.5]")), StartsWith("f.toml:6: sms.range: expected a positive whole number"));
    CHECK_THAT(error(sms("range = [\"2\", 9]")), StartsWith("f.toml:6: sms.range: expected a positive whole number"));
    CHECK_THAT(error(sms("range = [2]")),
               StartsWith("f.toml:6: sms.range: expected two numbers, [low, high], found 1"));
    CHECK_THAT(error(sms("range = 7")), StartsWith("f.toml:6: sms.range: expected a list of values, found integer"));
    CHECK_THAT(error(sms("choices = []")), StartsWith("f.toml:6: sms.choices: expected at least the value itself"));
    CHECK_THAT(error(sms("choices = [2, 3]")),
               StartsWith("f.toml:6: sms.choices: expected the value itself, 4, among"));
    CHECK_THAT(error(sms("choices = [4, 4]")), StartsWith("f.toml:6: sms.choices: expected each choice once, found 4"));
    CHECK_THAT(error(sms("choices = [4], range = [4, 5]")), StartsWith("f.toml:6: sms.choices: expected a range or"));
    CHECK_THAT(error(sms("rang = [4, 5]")),
               StartsWith("f.toml:6: sms.rang: expected one of the keys value, source, ra"));
    CHECK_THAT(error(sms("range_source = \"x\"")),
               StartsWith("f.toml:6: sms.range_source: expected it beside a range"));
    CHECK_THAT(error(sms("range = [4, 5], range_source = 7")),
               StartsWith("f.toml:6: sms.range_source: expected a str"));
    CHECK_THAT(error("sms = 4\nsimd_width = { value = 8, source = \"s\", range = [4, 16] }"),
               StartsWith("f.toml:7: simd_width.range: expected choices, since not all between"));
    CHECK_THAT(error("sms = 4\nscheduler = { value = \"loose_round_robin\", source = \"s\", choices = [\"fair\"] }"),
               StartsWith("f.toml:7: scheduler.choices: expected \"loose_round_robin\" or \"greedy_then_oldest\""));
}

TEST_CASE("every preset loads with whatever it says of its caches, all at once") {
    const auto some_of = [](const std::vector<GpuValue>& open, const std::string& key) {
        std::vector<std::string> values;
        for (const GpuValue& v : open) {
            if (v.key != key) continue;
            values = v.range->values;
            if (v.range->listed) continue;
            const std::uint64_t low = std::stoull(values[0]), high = std::stoull(values[1]);
            for (const std::uint64_t between : {low + 1, (low + high) / 2, high - 1})
                if (between > low && between < high) values.push_back(fmt::format("{}", between));
        }
        if (values.empty()) values.emplace_back();  // as the file has it
        return values;
    };
    std::size_t tried = 0;
    for (const GpuPreset& preset : gpu_presets()) {
        const auto open = open_values(preset.name);
        for (const std::string level : {"l1", "l2", "l3"})
            for (const auto& sets : some_of(open, level + ".sets"))
                for (const auto& slices : some_of(open, level + ".slices"))
                    for (const auto& ways : some_of(open, level + ".ways")) {
                        std::vector<ChosenValue> chosen;
                        if (!sets.empty()) chosen.emplace_back(level + ".sets", sets);
                        if (!slices.empty()) chosen.emplace_back(level + ".slices", slices);
                        if (!ways.empty()) chosen.emplace_back(level + ".ways", ways);
                        INFO(preset.name << ", " << level << ": " << sets << " sets, " << slices << " slices, "
                                         << ways);
                        CHECK_NOTHROW(load_with(preset.name, {}, chosen));
                        ++tried;
                    }
    }
    CHECK(tried > 100);
}

TEST_CASE("other sets of a cache keep its capacity, and a value that the user sets stays as it is") {
    const Gpu own = load_gpu("gtx-980-ti");
    const Gpu gpu = load_with("gtx-980-ti", {}, {{"l2.sets", "128"}, {"l2.slices", "12"}, {"timing.l1_latency", "90"}});
    CHECK(gpu.levels[1].sets == 128);
    CHECK(gpu.levels[1].slices == 12);
    CHECK(gpu.levels[1].bytes() == own.levels[1].bytes());
    CHECK(gpu.timing->l1_latency == 90);
    CHECK(gpu.name == "gtx-980-ti");

    CHECK(load_with("gtx-980-ti", {"l2.ways=8"}, {{"l2.sets", "128"}}).levels[1].ways == 8);
    const auto open = open_values("gtx-980-ti", {"l2.sets=128"});
    CHECK(std::none_of(open.begin(), open.end(), [](const GpuValue& v) { return v.key == "l2.sets"; }));
    const CacheGeometry seven = load_with("gtx-980-ti", {}, {{"l2.sets", "7"}}).levels[1];
    const std::uint64_t way = std::uint64_t{seven.slices} * 7 * seven.line_bytes;
    CHECK(seven.bytes() + way / 2 >= own.levels[1].bytes());  // to the nearest way
    CHECK(seven.bytes() <= own.levels[1].bytes() + way / 2);
    CHECK_THROWS_AS(load_with("gtx-980-ti", {}, {{"timing.l2_latency", "500"}}), UsageError);
}
