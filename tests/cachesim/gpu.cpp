#include "cachesim/gpus/gpu.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "cachesim/gpus/gpu_file.hpp"
#include "cachesim/gpus/limits.hpp"
#include "cachesim/gpus/presets.hpp"
#include "tests/folders.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::cachesim;

namespace {

const std::string good = R"(name = "tiny"
description = "for tests"
sms = 2
warps_per_sm = 4
warps_per_cta = 2
l1_per_sm = 1
[l1]
sets = 4
ways = 3
line_bytes = 128
sector_bytes = 32
index = "modulo"
policy = "lru"
[l2]
sets = 5
ways = { value = 6, source = "made up" }
line_bytes = 128
sector_bytes = 32
index = "xor_fold"
policy = "lru"
)";

/// The message for `good` with `from` replaced by `to`; must be one line.
std::string error(const std::string& from, const std::string& to) {
    std::string text = good;
    const auto at = text.find(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
    try {
        parse_gpu(text, "f.toml");
    } catch (const UsageError&) {
        FAIL("a bad file is no bad command line");
    } catch (const Error& e) {
        const std::string message = e.what();
        CHECK(message.find('\n') == std::string::npos);
        return message;
    }
    return "accepted";
}

}  // namespace

TEST_CASE("a GPU file gives every value") {
    const Gpu gpu = parse_gpu(good, "f.toml");
    CHECK(gpu.name == "tiny");
    CHECK(gpu.description == "for tests");
    CHECK(gpu.sms == 2);
    CHECK(gpu.warps_per_sm == 4);
    CHECK(gpu.warps_per_cta == 2);
    CHECK(gpu.l1_per_sm == 1);
    CHECK(gpu.levels[0].sets == 4);
    CHECK(gpu.levels[0].ways == 3);
    CHECK(gpu.levels[0].index == SetIndex::modulo);
    CHECK(gpu.levels[1].ways == 6);
    CHECK(gpu.levels[1].index == SetIndex::xor_fold);
    CHECK(gpu.levels[1].bytes() == 5 * 6 * 128);
}

TEST_CASE("every preset loads under its file name, with a source beside every number") {
    REQUIRE(gpu_presets().size() == preset_texts().size());
    for (const PresetText& preset : preset_texts()) {
        CAPTURE(preset.name);
        CHECK(load_gpu(preset.name).name == preset.name);
        const auto values = gpu_values(preset.name);
        CHECK(values.size() >= 16);
        for (const GpuValue& value : values) {
            CAPTURE(value.key);
            CHECK_FALSE(value.value.empty());
            CHECK_FALSE(value.source.empty());
        }
        const std::string path = raycache::test::source_folder() + "cachesim/gpus/" + preset.name + ".toml";
        CHECK(load_gpu(path).levels[1].bytes() == load_gpu(preset.name).levels[1].bytes());
    }
}

TEST_CASE("every preset has the SMs and capacities of the table of known GPUs") {
    struct Known {
        const char* name;
        unsigned sms, l1_per_sm, l1_kib;
        double l2_mib;
        unsigned warps_per_sm, most_warps_per_sm;
    };
    const Known table[] = {{"a100", 108, 1, 192, 40, 12, 64},       {"gtx-980-ti", 22, 2, 24, 3, 40, 64},
                           {"h100", 114, 1, 256, 50, 12, 64},       {"h100-sxm", 132, 1, 256, 50, 12, 64},
                           {"h200", 132, 1, 256, 60, 12, 64},       {"rtx-2060", 30, 1, 64, 3, 12, 32},
                           {"rtx-2080-ti", 68, 1, 64, 5.5, 12, 32}, {"rtx-3070", 46, 1, 128, 4, 12, 48},
                           {"rtx-3080-ti", 80, 1, 128, 6, 12, 48},  {"rtx-3090", 82, 1, 128, 6, 12, 48},
                           {"rtx-4090", 128, 1, 128, 72, 12, 48},   {"titan-x-pascal", 28, 1, 48, 3, 40, 64},
                           {"v100", 80, 1, 128, 6, 12, 64},         {"xeon-8380", 40, 1, 48, 1.25, 2, 2}};
    CHECK(gpu_presets().size() == std::size(table));
    for (const Known& known : table) {
        CAPTURE(known.name);
        const Gpu gpu = load_gpu(known.name);
        CHECK(gpu.sms == known.sms);
        CHECK(gpu.l1_per_sm == known.l1_per_sm);
        CHECK(gpu.levels[0].bytes() == known.l1_kib * 1024);
        CHECK(static_cast<double>(gpu.levels[1].bytes()) == known.l2_mib * 1024 * 1024);
        CHECK(gpu.warps_per_sm == known.warps_per_sm);
        CHECK(gpu.warps_per_sm <= known.most_warps_per_sm);
        const bool cpu = gpu.levels.size() == 3;
        CHECK(gpu.levels[0].line_bytes == (cpu ? 64 : 128));
        CHECK(gpu.levels[0].sector_bytes == (cpu ? 64 : 32));
        CHECK(gpu.simd_width == (cpu ? 8 : 32));
        if (cpu) CHECK(gpu.levels[2].bytes() == 60 * 1024 * 1024);
    }
}

TEST_CASE("presets count the instructions of a compiled kernel, and of processors of three levels no time") {
    for (const GpuPreset& preset : gpu_presets()) {
        CAPTURE(preset.name);
        const Gpu gpu = load_gpu(preset.name);
        REQUIRE(gpu.timing);
        const Timing& t = *gpu.timing;
        CHECK(no_time_note(gpu).empty() == (gpu.levels.size() == 2));
        if (gpu.levels.size() == 3) continue;
        const bool pairs = gpu.front_end.lanes_per_request_16 == 2;  // Maxwell, Pascal
        CHECK(t.node_instructions == (pairs ? 60 : 62));
        CHECK(t.triangle_instructions == (pairs ? 75 : 80));
        CHECK((t.leaf_instructions >= 24 && t.leaf_instructions <= 32));
        CHECK(t.shading_instructions == (pairs ? 450 : 400));
        CHECK((gpu.levels[0].index == SetIndex::xor_fold) == pairs);
    }
}

TEST_CASE("no preset says assumed and nothing else") {
    for (const GpuPreset& preset : gpu_presets())
        for (const GpuValue& value : gpu_values(preset.name)) {
            CAPTURE(preset.name, value.key);
            CHECK(value.source.size() > std::string("assumed: ").size());
        }
}

TEST_CASE("a third level is read like the others, and only its absence is no error") {
    const std::string third = R"([l3]
sets = 7
ways = 2
line_bytes = 128
sector_bytes = 32
index = "modulo"
policy = "random"
seed = 9
slices = 3
fill_bytes = 64
)";
    const Gpu gpu = parse_gpu("simd_width = 8\n" + good + third, "f.toml");
    REQUIRE(gpu.levels.size() == 3);
    CHECK(gpu.simd_width == 8);
    CHECK(gpu.levels[2].policy == "random");
    CHECK(gpu.levels[2].seed == 9);
    CHECK(gpu.levels[2].slices == 3);
    CHECK(gpu.levels[2].fill_bytes == 64);
    CHECK(gpu.levels[2].bytes() == 3 * 7 * 2 * 128);
    using Catch::StartsWith;
    CHECK_THAT(error("sms = 2\n", "sms = 2\nsimd_width = 12\n"), StartsWith("f.toml:4: simd_width: expected 1, 2, 4"));
    CHECK_THAT(error("\"lru\"\n", "\"lru\"\nfill_bytes = 48\n"),
               StartsWith("f.toml:14: l1.fill_bytes: expected a power of two, found 48"));
    CHECK_THAT(error("\"lru\"\n", "\"lru\"\nfill_bytes = 256\n"),
               StartsWith("f.toml:14: l1.fill_bytes: expected 32 to 128, found 256"));
    CHECK_THAT(error("\"lru\"\n", "\"random\"\nseed = -1\n"), StartsWith("f.toml:14: l1.seed: expected a whole"));
}

TEST_CASE("the values of a GPU file come with their sources, and without where the file gives none") {
    const auto values = parse_gpu_values(good, "f.toml");
    REQUIRE(values.size() == 16);
    CHECK(values[0].key == "sms");
    CHECK(values[0].value == "2");
    CHECK(values[0].source.empty());
    CHECK(values[11].key == "l2.ways");
    CHECK(values[11].value == "6");
    CHECK(values[11].source == "made up");
    CHECK(values[14].key == "l2.index");
    CHECK(values[14].value == "xor_fold");
}

TEST_CASE("an unknown preset is bad use and lists the valid names") {
    CHECK_THROWS_AS(load_gpu("gtx-970"), UsageError);
    CHECK_THROWS_WITH(load_gpu("gtx-970"), Catch::Contains("gtx-980-ti, h100") && Catch::Contains("\"gtx-970\""));
    CHECK_THROWS_AS(load_gpu(""), UsageError);
}

TEST_CASE("a file that cannot be read is named") {
    CHECK_THROWS_WITH(load_gpu("/nowhere/x.toml"),
                      Catch::StartsWith("/nowhere/x.toml: ") && Catch::Contains("expected a file"));
    CHECK_THROWS_WITH(load_gpu("/tmp/"), Catch::Contains("folder"));
    CHECK_THROWS_WITH(load_gpu("/dev/zero"), Catch::Contains("found a device"));
}

TEST_CASE("errors of a GPU file name file, line and key") {
    using Catch::StartsWith;
    CHECK_THAT(error("sms = 2\n", "sms = 0\n"), StartsWith("f.toml:3: sms: expected a positive"));
    CHECK_THAT(error("sms = 2\n", "sms = -2\n"), StartsWith("f.toml:3: sms: expected a positive"));
    CHECK_THAT(error("sms = 2\n", "sms = 2.5\n"), StartsWith("f.toml:3: sms: ") && Catch::Contains("found 2.5"));
    CHECK_THAT(error("sms = 2\n", "sms = \"2\"\n"), StartsWith("f.toml:3: sms: ") && Catch::Contains("found \"2\""));
    CHECK_THAT(error("sms = 2\n", "sms = nan\n"), StartsWith("f.toml:3: sms: "));
    CHECK_THAT(error("sms = 2\n", "sms = 4294967298\n"), StartsWith("f.toml:3: sms: "));
    CHECK_THAT(error("sms = 2\n", "sms = 5000\n"), StartsWith("f.toml:3: sms: expected 1 to 4096"));
    CHECK_THAT(error("sms = 2\n", "sms = 99999999999999999999\n"), StartsWith("f.toml:3: expected TOML"));
    CHECK_THAT(error("sms = 2\n", "sms = 2 2\n"), StartsWith("f.toml:3: expected the end of the line"));
    CHECK_THAT(error("sms = 2\n", "sms = \n"), StartsWith("f.toml:3: expected a number"));
    CHECK_THAT(error("sms = 2\n", ""), StartsWith("f.toml:1: sms: expected this key, found none"));
    CHECK_THAT(error("ways = 3\n", ""), StartsWith("f.toml:7: l1.ways: expected this key, found none"));
    CHECK_THAT(error("sms = 2\n", "sms = 2\nsmz = 2\n"), StartsWith("f.toml:4: smz: expected one of the keys"));
    CHECK_THAT(error("ways = 3\n", "ways = 3\nway = 3\n"), StartsWith("f.toml:10: l1.way: expected one of the keys"));
    CHECK_THAT(error("[l1]", "[[l1]]"), StartsWith("f.toml:7: l1: expected a table, found array"));
    CHECK_THAT(error("source = \"made up\"", "sauce = \"made up\""), StartsWith("f.toml:16: l2.ways.sauce: "));
    CHECK_THAT(error(", source = \"made up\"", ""), StartsWith("f.toml:16: l2.ways.source: expected this key"));
    CHECK_THAT(error("\"made up\"", "7"), StartsWith("f.toml:16: l2.ways.source: expected a string"));
    CHECK_THAT(error("\"tiny\"", "\"\""), StartsWith("f.toml:1: name: expected a text"));
    CHECK_THAT(error("\"modulo\"", "\"mod\""),
               StartsWith("f.toml:12: l1.index: expected \"modulo\", \"xor_fold\", \"ipoly\" or"));
    CHECK_THAT(error("\"lru\"", "\"mru\""),
               StartsWith("f.toml:13: l1.policy: expected one of: fifo, lru, random, tree_plru;"));
}

TEST_CASE("impossible caches are refused with the line of the value at fault") {
    using Catch::StartsWith;
    CHECK_THAT(error("line_bytes = 128", "line_bytes = 100"),
               StartsWith("f.toml:10: l1.line_bytes: expected a power of two, found 100; nearest below: 64"));
    CHECK_THAT(error("line_bytes = 128", "line_bytes = 96"), StartsWith("f.toml:10: l1.line_bytes: expected a power"));
    CHECK_THAT(error("sector_bytes = 32", "sector_bytes = 256"),
               StartsWith("f.toml:11: l1.sector_bytes: expected at most the line's 128"));
    CHECK_THAT(error("line_bytes = 128\nsector_bytes = 32", "line_bytes = 2048\nsector_bytes = 32"),
               StartsWith("f.toml:11: l1.sector_bytes: expected at most 32 sectors"));
    CHECK_THAT(error("sets = 4", "sets = 9223372036854775807"), StartsWith("f.toml:8: l1.sets: "));
    CHECK_THAT(error("sets = 4", "sets = 1099511627776"), Catch::Contains("2^40 bytes"));
    CHECK_THAT(error("sets = 4", "sets = 100000000"), Catch::Contains("2^26 lines"));
    CHECK_THAT(error("[l2]\nsets = 5\nways = { value = 6, source = \"made up\" }\nline_bytes = 128",
                     "[l2]\nsets = 5\nways = 6\nline_bytes = 64"),
               StartsWith("f.toml:17: l2.line_bytes: expected the line size of L1"));
}

TEST_CASE("a user's GPU file is read from a path") {
    const auto path = std::filesystem::temp_directory_path() / "raycache-test-gpu.toml";
    std::ofstream(path) << good;
    CHECK(load_gpu(path.string()).name == "tiny");
    std::filesystem::remove(path);
    CHECK(is_gpu_file(path.string()));
    CHECK_FALSE(is_gpu_file("h100"));
}

TEST_CASE("the name of a GPU says what was changed, the last value of each key in the order of the keys") {
    const auto name = [](const std::vector<std::string>& changes) { return parse_gpu(good, "f.toml", changes).name; };
    CHECK(name({}) == "tiny");
    CHECK(name({"warps_per_sm=8", "l1.ways=2"}) == "tiny (l1.ways=2, warps_per_sm=8)");
    CHECK(name({"l1.ways=2", "warps_per_sm = 8"}) == "tiny (l1.ways=2, warps_per_sm=8)");
    CHECK(name({"l1.ways=0x10", "l2.policy='fifo'"}) == "tiny (l1.ways=16, l2.policy=fifo)");
    CHECK(name({"l2.policy=fifo", "l2.policy=lru"}) == "tiny (l2.policy=lru)");
    CHECK(name({"name=mine", "sms=4"}) == "mine (sms=4)");
    CHECK(name({"l1.index=parity", "l1.index_masks=[128, 0x100]"}) == "tiny (l1.index=parity, l1.index_masks=128 256)");
}

TEST_CASE("a [timing] that contradicts itself is refused with line and key") {
    const std::string timing = R"(
[timing]
clock_mhz = 1000
schedulers = 4
node_instructions = 10
triangle_instructions = 10
texel_instructions = 10
instruction_latency = 4
l1_latency = 30
l2_latency = 200
dram_latency = 500
l1_mshrs = 256
l1_mshr_merges = 8
l2_mshrs = 192
l2_mshr_merges = 4
crossbar_bytes_per_cycle = 32
l2_bytes_per_cycle = 32
dram_channels = 4
dram_gb_s = 256
)";
    const auto message = [&](const std::string& from, const std::string& to) -> std::string {
        std::string text = timing;
        const auto at = text.find(from);
        REQUIRE(at != std::string::npos);
        text.replace(at, from.size(), to);
        try {
            parse_gpu(good + text, "f.toml");
        } catch (const Error& e) {
            return e.what();
        }
        return "accepted";
    };
    const Gpu gpu = parse_gpu(good + timing, "f.toml");
    REQUIRE(gpu.timing);
    CHECK(gpu.timing->l2_latency == 200);
    CHECK(gpu.timing->l2_far_latency == 200);  // no far partition
    CHECK(gpu.timing->dram_gb_s == 256);
    using Catch::Contains;
    CHECK_THAT(message("l2_latency = 200", "l2_latency = 20"), Contains("timing.l2_latency") && Contains("20"));
    CHECK_THAT(message("dram_latency = 500", "dram_latency = -5"), Contains("timing.dram_latency") && Contains("-5"));
    CHECK_THAT(message("dram_gb_s = 256", "dram_gb_s = 0"), Contains("timing.dram_gb_s") && Contains("positive"));
    CHECK_THAT(message("dram_gb_s = 256", "dram_gb_s = \"fast\""),
               Contains("timing.dram_gb_s") && Contains("\"fast\""));
    CHECK_THAT(message("schedulers = 4", "schedulers = 0"), Contains("timing.schedulers"));
    CHECK_THAT(message("schedulers = 4", ""), Contains("timing.schedulers") && Contains("add it"));
    CHECK_THAT(message("schedulers = 4", "sheduler = 4"), Contains("timing.sheduler") && Contains("unknown"));
    CHECK_THAT(message("l1_mshrs = 256", "l1_mshrs = 0"), Contains("timing.l1_mshrs"));
    CHECK_THAT(message("clock_mhz = 1000", "clock_mhz = 1e9"), Contains("timing.clock_mhz"));
    CHECK_THAT(message("node_instructions = 10", "node_instructions = 4000000000"),
               Contains("timing.node_instructions") && Contains("100000"));
    CHECK_THAT(message("l2_bytes_per_cycle = 32", "l2_bytes_per_cycle = 1e-9"), Contains("timing.l2_bytes_per_cycle"));
    CHECK_THAT(message("dram_gb_s = 256", "dram_gb_s = 1e-9"), Contains("timing.dram_gb_s") && Contains("channels"));
    CHECK_THAT(message("l2_latency = 200", "l2_latency = 200\nl2_far_latency = 300"),
               Contains("timing.l2_far_latency") && Contains("l2_partitions"));
    CHECK_THAT(message("l2_latency = 200", "l2_latency = 200\nl2_far_latency = 900\nl2_partitions = 2"),
               Contains("timing.dram_latency") && Contains("far partitions"));
    CHECK_THAT(message("dram_gb_s = 256", "dram_gb_s = 256\ndram_rcd = 3"), Contains("timing.dram_rcd: expected with"));
    CHECK_THAT(message("dram_gb_s = 256", "dram_gb_s = 256\ndram_bank_bits = [7, 64]\ndram_mhz = 100"),
               Contains("timing.dram_bank_bits") && Contains("64"));
    CHECK_THAT(message("dram_gb_s = 256", "dram_gb_s = 256\ndram_bank_bits = [7]"), Contains("timing.dram_mhz"));
    CHECK_THAT(message("l1_latency = 30", "l1_latency = 3\noperand_collectors = 2"), Contains("timing.l1_latency"));
    CHECK_THAT(message("schedulers = 4", "schedulers = 4\noperand_collectors = 33"),
               Contains("timing.operand_collectors"));
    CHECK_THAT(message("schedulers = 4", "schedulers = 4\nleaf_instructions = 100001"),
               Contains("timing.leaf_instructions") && Contains("100001"));
    CHECK_THAT(message("schedulers = 4", "schedulers = 4\nempty_request_cycles = 1001"),
               Contains("timing.empty_request_cycles") && Contains("1001"));
    CHECK_THAT(message("schedulers = 4", "schedulers = 4\nnot_predicted = true"),
               Contains("timing.not_predicted") && Contains("text"));
    CHECK(gpu.timing->leaf_instructions == 0);
    CHECK(gpu.timing->empty_request_cycles == 0);
    CHECK(no_time_note(gpu).empty());
    Gpu silent = gpu;
    silent.timing->not_predicted = "clock unknown";
    CHECK(no_time_note(silent) == "time: not predicted for tiny (clock unknown; see cachesim/MODEL.md)");
    silent.levels.push_back(silent.levels.back());
    CHECK_THAT(no_time_note(silent), Catch::StartsWith("CPU time: not predicted for tiny ("));
}

TEST_CASE("what is carved out of a cache takes whole ways") {
    const auto ways = [](const std::string& bytes) {
        std::string text = good;
        text.replace(text.find("ways = 3\n"), 9, "ways = 3\ncarve_out_bytes = " + bytes + "\n");
        return parse_gpu(text, "f.toml").levels[0].ways;
    };
    CHECK(ways("0") == 3);
    CHECK(ways("1") == 2);
    CHECK(ways("512") == 2);  // 4 sets x 128 B
    CHECK(ways("513") == 1);
    using Catch::StartsWith;
    CHECK_THAT(error("ways = 3\n", "ways = 3\ncarve_out_bytes = 1025\n"),
               StartsWith("f.toml:10: l1.carve_out_bytes: expected to leave at least one of 3 ways"));
    CHECK_THAT(error("sets = 4", "carve_out_bytes = 1\nsets = 144115188075855872"), Catch::Contains("l1.sets: "));
}

TEST_CASE("registers say how many warps are resident, unless the file does") {
    const auto warps = [](const std::string& of_sm, const std::string& keys, const std::string& tables) {
        std::string text = good;
        text.replace(text.find("warps_per_sm = 4\n"), 17, of_sm);
        return parse_gpu(keys + text + tables, "f.toml").warps_per_sm;
    };
    // 168 x 32 = 5376 = 21 x 256 registers of a warp; 65536 hold 12.
    const std::string table = "[registers]\nper_sm = 65536\nper_thread = 168\n";
    CHECK(warps("", "", table) == 12);
    CHECK(warps("warps_per_sm = 6\n", "", table) == 6);
    CHECK(warps("", "max_warps_per_sm = 9\n", table) == 8);  // whole CTAs of 2 warps
    CHECK(warps("", "", table + "allocation = 8192\n") == 8);
    CHECK_THAT(error("warps_per_sm = 4\n", ""), Catch::Contains("warps_per_sm"));
    const std::string small = "[registers]\nper_sm = 1024\nper_thread = 32\n";
    CHECK_THROWS_WITH(warps("", "", small), Catch::Contains("registers.per_thread: expected a CTA of 2 warps to fit"));
    CHECK_THAT(error("warps_per_sm = 4\n", "warps_per_sm = 4\nmax_warps_per_sm = 2\n"),
               Catch::Contains("warps_per_sm: expected at most the 2"));
}
