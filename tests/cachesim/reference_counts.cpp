// How far the replay is from a published simulator on the reference traces: cachesim/MODEL.md, "Measured".
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "oracle.hpp"
#include "tests/real_data.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;

namespace {

/// RESULTS.md of the reference: cycle-level counts of the RTX 3070 configuration.
struct Published {
    const char* trace;
    unsigned sms;
    std::uint64_t l1_ways, l1_misses, dram_sectors;
};

Gpu rtx_3070_like(unsigned sms, std::uint64_t l1_ways) {
    Gpu gpu;
    gpu.name = "reference";
    gpu.sms = sms;
    gpu.warps_per_sm = 32;
    gpu.warps_per_cta = 4;
    gpu.levels[0].sets = 4;
    gpu.levels[0].ways = l1_ways;
    gpu.levels[1].sets = 32 * 64;
    gpu.levels[1].ways = 16;
    gpu.levels[1].index = SetIndex::xor_fold;
    return gpu;
}

double percent_off(std::uint64_t ours, std::uint64_t theirs) {
    return 100 * (static_cast<double>(ours) / static_cast<double>(theirs) - 1);
}

}  // namespace

TEST_CASE("L1 misses and DRAM sectors stay close to a cycle-level simulator", "[slow][data]") {
    const auto published = GENERATE(values<Published>({{"coh", 8, 256, 653133, 153199},
                                                       {"cp", 8, 256, 1027940, 203588},
                                                       {"mj1_64", 8, 256, 791037, 166939},
                                                       {"mj1_1024", 8, 256, 700257, 155629},
                                                       {"coh", 2, 256, 644669, 148217},
                                                       {"cp", 2, 256, 1003143, 180349},
                                                       {"mj1_64", 2, 256, 781930, 159651},
                                                       {"mj1_1024", 2, 256, 687340, 150452},
                                                       {"cp", 46, 256, 833331, 203381},
                                                       {"mj1_1024", 46, 256, 462655, 154748},
                                                       {"hr_coh", 8, 256, 48553, 21353},
                                                       {"hr_cp", 8, 256, 748423, 128237},
                                                       {"hr_mj1_64", 8, 256, 292139, 61067},
                                                       {"hr_mj1_1024", 8, 256, 125353, 38640},
                                                       {"cp", 8, 64, 1575140, 203701},
                                                       {"mj1_1024", 8, 64, 1090504, 155652}}));
    const auto path = raycache::test::reference_trace(published.trace);
    if (!path) return;
    const Launch launch = read_rtwarp(*path);
    const Counters counts = replay(rtx_3070_like(published.sms, published.l1_ways), launch).all();
    CAPTURE(published.trace, published.sms, published.l1_ways, counts.levels[1].sectors, counts.dram_sectors);
    CHECK(std::fabs(percent_off(counts.levels[1].sectors, published.l1_misses)) < 4.5);
    CHECK(std::fabs(percent_off(counts.dram_sectors, published.dram_sectors)) < 1.2);
}

TEST_CASE("requests of the front end are as many as those of a cycle-level simulator", "[slow][data]") {
    struct Requests {
        const char* trace;
        std::uint64_t requests, loads;
    };
    const auto published = GENERATE(values<Requests>({{"cp", 6723021, 1528445},
                                                      {"coh", 4635930, 1147986},
                                                      {"mj1_64", 5389316, 1267332},
                                                      {"mj1_1024", 4917835, 1185806},
                                                      {"hr_coh", 1772352, 694703},
                                                      {"hr_cp", 6192580, 1486741},
                                                      {"hr_mj1_64", 3885537, 1036699},
                                                      {"hr_mj1_1024", 2820657, 883115}}));
    const auto path = raycache::test::reference_trace(published.trace);
    if (!path) return;
    const Counters counts = replay(rtx_3070_like(8, 256), read_rtwarp(*path)).all();
    CAPTURE(published.trace);
    CHECK(counts.requests == published.requests);
    CHECK(counts.loads == published.loads);
}
