// --set KEY=a,b and cache sizes: how many GPUs they make, of which geometry, and what they are called.
#include "tools/jobs/gpu_variants.hpp"

#include <catch2/catch.hpp>

#include <set>

#include "tests/tools/command_line.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

using Catch::Contains;
using Strings = std::vector<std::string>;
using test::refusal;
using test::words_of;

TEST_CASE("a list of values is split at its commas, but not within TOML's brackets and quotes") {
    CHECK(listed_changes("l1.ways=64,128") == Strings{"l1.ways=64", "l1.ways=128"});
    CHECK(listed_changes("l1.policy=lru,fifo") == Strings{"l1.policy=lru", "l1.policy=fifo"});
    CHECK(listed_changes("l2.slice_bits=[7, 8],[8, 9]") == Strings{"l2.slice_bits=[7, 8]", "l2.slice_bits=[8, 9]"});
    CHECK(listed_changes("a='x,y',\"z,[\"") == Strings{"a='x,y'", "a=\"z,[\""});
    CHECK(listed_changes("sms={value=4, source='me'}") == Strings{"sms={value=4, source='me'}"});
    CHECK(listed_changes("no assignment") == Strings{"no assignment"});
}

TEST_CASE("values of keys are decimal, and byte counts may have a unit") {
    CHECK(listed_changes("l1.ways=064") == Strings{"l1.ways=64"});
    CHECK(listed_changes("l1.ways=0") == Strings{"l1.ways=0"});
    CHECK(listed_changes("timing.clock_mhz=1500.5") == Strings{"timing.clock_mhz=1500.5"});
    CHECK(listed_changes("l1.carve_out_bytes=28KiB,1mib") ==
          Strings{"l1.carve_out_bytes=28672", "l1.carve_out_bytes=1048576"});
    for (const char* bad : {"l1.ways=0x40", "l1.ways=0o17", "l1.ways=0b1", "l1.ways=+4", "l1.ways=-4", "l1.ways=1_000",
                            "l1.ways=64,64", "l1.size=64KB", "l1.size=64 KiB", "l1.size=0", "l1.size=1.5MiB",
                            "l1.size=99999999999999999999", "l1.size=18014398509481984KiB"}) {
        INFO(bad);
        CHECK_THROWS_AS(listed_changes(bad), UsageError);
    }
    CHECK_THAT(refusal(words_of("raycache replay x.rct --gpu h100 --set l1.ways=4KiB")), Contains("l1.ways"));
    CHECK_THAT(refusal(words_of("raycache replay x.rct --gpu h100 --set l1.ways=")), Contains("l1.ways"));
    CHECK_THAT(refusal(words_of("raycache replay x.rct --gpu h100 --set timing.clock_mhz=inf")), Contains("clock_mhz"));
}

TEST_CASE("repeated lists make every combination, each with a name of its own") {
    const auto gpus = load_gpu_variants("rtx-3070", {{"l1.ways=64", "l1.ways=128"}, {"sms=4", "sms=8", "sms=16"}});
    REQUIRE(gpus.size() == 6);
    std::set<std::string> names;
    for (const auto& gpu : gpus) names.insert(gpu.name);
    CHECK(names.size() == 6);
    CHECK(gpus[0].name == "rtx-3070 (l1.ways=64, sms=4)");
    CHECK(gpus[5].name == "rtx-3070 (l1.ways=128, sms=16)");
    CHECK(gpus[5].l1().ways == 128);
    CHECK(gpus[5].sms == 16);
    CHECK(load_gpu_variants("rtx-3070", {}).size() == 1);
}

TEST_CASE("more than 256 combinations are refused before any is made") {
    Strings many;
    for (int i = 1; i <= 17; ++i) many.push_back("l1.ways=" + std::to_string(i));
    CHECK_THROWS_WITH(load_gpu_variants("rtx-3070", {many, many}), Contains("at most 256"));
    const std::vector<Strings> huge(9, Strings(1000, "sms=1"));  // 1000^9 is beyond 64 bits
    CHECK_THROWS_WITH(load_gpu_variants("rtx-3070", huge), Contains("at most 256"));
}

TEST_CASE("a cache of another size keeps its sets, or its ways where that gives no whole number") {
    const auto base = cachesim::load_gpu("rtx-3070");
    for (const std::uint64_t kib : {32, 64, 96, 128, 192}) {
        const auto gpu = load_gpu_variants("rtx-3070", {{"l1.size=" + std::to_string(kib) + "KiB"}}).front();
        CHECK(gpu.l1().bytes() == kib * 1024);
        CHECK(gpu.l1().sets == base.l1().sets);
        CHECK(gpu.levels[1].bytes() == base.levels[1].bytes());
        CHECK(gpu.name == "rtx-3070 (l1=" + std::to_string(kib) + " KiB)");
    }
    // 256 ways of 512 B: a size between is sets' only where ways are fixed.
    const auto sets = load_gpu_variants("rtx-3070", {{"l1.ways=64"}, {"l1.size=64KiB"}}).front();
    CHECK(sets.l1().ways == 64);
    CHECK(sets.l1().sets == 8);
    CHECK(sets.name == "rtx-3070 (l1.ways=64, l1=64 KiB)");
    const auto l2 = load_gpu_variants("rtx-3070", {{"l2.size=2MiB"}}).front();
    CHECK(l2.levels[1].bytes() == 2 << 20);
    CHECK(l2.name == "rtx-3070 (l2=2 MiB)");
}

TEST_CASE("every preset with a carve-out or without takes half and twice its L1, exactly") {
    for (const auto& preset : cachesim::gpu_presets()) {
        const auto base = cachesim::load_gpu(preset.name);
        for (const std::uint64_t bytes : {base.l1().bytes() * 2, base.l1().bytes()}) {
            INFO(preset.name << ' ' << bytes);
            const auto gpu = load_gpu_variants(preset.name, {{"l1.size=" + std::to_string(bytes)}}).front();
            CHECK(gpu.l1().bytes() == bytes);
        }
    }
}

TEST_CASE("a size that neither whole ways nor whole sets make is refused with the nearest") {
    CHECK_THROWS_WITH(load_gpu_variants("rtx-3070", {{"l1.size=1000"}}), Contains("l1") && Contains("nearest"));
    CHECK_THROWS_WITH(load_gpu_variants("rtx-3070", {{"l3.size=1MiB"}}), Contains("l3") && Contains("2"));
    CHECK_THROWS_AS(load_gpu_variants("rtx-3070", {{"l1.size=1000"}}), UsageError);
}

TEST_CASE("options make variants where a command takes several GPUs, and are refused where it takes one") {
    CHECK(refusal(words_of("raycache replay x.rct --gpu rtx-3070 --l1-kib 32,64 --set sms=4,8")).empty());
    CHECK(refusal(words_of("raycache compare courtyard --gpu rtx-3070,v100 --l1-kib 64 --l2-kib 4096")).empty());
    CHECK(refusal(words_of("raycache explain courtyard --gpu rtx-3070 --l1-kib 64")).empty());
    for (const char* line :
         {"explain courtyard --gpu rtx-3070 --set sms=4,8", "explain a.rct b.rct --gpu h100 --set sms=4,8",
          "export a.rct --format csv --sm 0 -o - --gpu h100 --l2-kib 2560,5120"})
        CHECK_THAT(refusal(words_of(std::string("raycache ") + line)), Contains("takes one GPU"));
    CHECK_THAT(refusal(words_of("raycache replay x.rct --gpu h100 --gpu H100")), Contains("twice"));
    CHECK_THAT(refusal(words_of("raycache replay x.rct --gpu h100 --set l1.wyas=4")),
               Contains("did you mean 'l1.ways'?"));
    CHECK_THAT(refusal(words_of("raycache replay x.rct --gpu h100 --l1-kib 0")), Contains("--l1-kib"));
}

}  // namespace
}  // namespace raycache::tools
