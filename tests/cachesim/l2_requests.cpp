// Requests to L2, against a count of single loads that is written anew here.
#include "cachesim/analysis/l2_requests.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "cachesim/replay/replay.hpp"
#include "random_launch.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;
using traces::ObjectKind;

namespace {

struct Both {
    LaunchStatistics counted, instructions;
};

Both replay_with_requests(const Gpu& gpu, const Launch& launch) {
    L2RequestCounter requests(gpu, launch.regions);
    Replay replay(gpu, launch.regions, 0);
    replay.observe(requests);
    for (const auto& warp : launch.warps) replay.push(warp);
    Both both{replay.finish(), {}};
    both.instructions = requests.in_instructions(both.counted);
    return both;
}

Launch one_access(const traces::Region& region, std::vector<std::uint32_t> elements) {
    auto warp = std::make_shared<traces::WarpTrace>();
    warp->records = {
        {static_cast<std::uint32_t>((std::uint64_t{1} << elements.size()) - 1), 0, traces::RayType::camera, 0, 0}};
    warp->elements = std::move(elements);
    return {{region}, {warp}};
}

std::uint64_t requests_of(const Gpu& gpu, const traces::Region& region, std::vector<std::uint32_t> elements) {
    const Both both = replay_with_requests(gpu, one_access(region, std::move(elements)));
    CHECK(both.counted.all().levels[1].sectors > 0);
    return both.instructions.all().requests;
}

/// The first access to each line sends load after load to a cache of endless size: groups of lanes in turn, a request
/// for each line of which a sector is not there.
std::uint64_t naive_requests(const Gpu& gpu, const Launch& launch) {
    std::set<std::uint64_t> present;
    std::uint64_t requests = 0;
    for (const auto& warp : launch.warps) {
        const std::uint32_t* element = warp->elements.data();
        for (const traces::Record& record : warp->records) {
            if (!record.is_access()) continue;
            const traces::Region& region = launch.regions[record.region];
            std::uint32_t bytes = gpu.front_end.load_bytes;
            while (bytes / 2 >= region.element_size) bytes /= 2;
            const unsigned lanes_together = bytes >= 16  ? gpu.front_end.lanes_per_request_16
                                            : bytes >= 8 ? gpu.front_end.lanes_per_request_8
                                                         : gpu.front_end.lanes_per_request_4;
            for (std::uint32_t from = 0; from < region.element_size; from += bytes) {
                for (unsigned group = 0; group < 32; group += lanes_together) {
                    std::map<std::uint64_t, std::set<std::uint64_t>> missing;  // by line
                    const std::uint32_t* of_lane = element;
                    for (unsigned lane = 0; lane < 32; ++lane) {
                        if (!(record.mask >> lane & 1)) continue;
                        const std::uint64_t first = region.address(*of_lane++) + from;
                        const std::uint64_t end = first + std::min(bytes, region.element_size - from);
                        if (lane / lanes_together != group / lanes_together) continue;
                        for (std::uint64_t s = first / 32; s * 32 < end; ++s)
                            if (!present.contains(s)) missing[s / 4].insert(s);
                    }
                    requests += missing.size();
                    for (const auto& [line, sectors] : missing) present.insert(sectors.begin(), sectors.end());
                }
            }
            element += record.lanes();
        }
    }
    return requests;
}

}  // namespace

TEST_CASE("a load that is the first to miss sectors of a line is one request to L2") {
    Gpu gpu = small_gpu();
    gpu.front_end.load_bytes = 16;
    gpu.front_end.lanes_per_request_16 = gpu.front_end.lanes_per_request_8 = gpu.front_end.lanes_per_request_4 = 32;
    const auto node = region(ObjectKind::node, 0x7f5000000000, 64, 64, 300);
    CHECK(requests_of(gpu, node, {0}) == 2);           // loads 0 and 2; 1 and 3 find what these fetched
    CHECK(requests_of(gpu, node, {0, 0, 0}) == 2);     // the same
    CHECK(requests_of(gpu, node, {0, 1}) == 2);        // two nodes of one line: each load reads a sector of both
    CHECK(requests_of(gpu, node, {0, 1, 2, 3}) == 4);  // two lines
    const auto triangle = region(ObjectKind::triangle, 0x7f5000000000, 48, 48, 300);
    CHECK(requests_of(gpu, triangle, {0}) == 2);     // its loads 0 and 2 begin sectors
    CHECK(requests_of(gpu, triangle, {1}) == 2);     // 48 to 95: loads 0 and 1 do
    CHECK(requests_of(gpu, triangle, {0, 1}) == 2);  // load 0 of both reads sectors 0 and 1, load 1 sector 2
    gpu.front_end.lanes_per_request_16 = 2;          // Pascal: lanes 0 and 1, 2 and 3 go together
    CHECK(requests_of(gpu, node, {0, 0, 1, 1}) == 4);
    CHECK(requests_of(gpu, region(ObjectKind::texel, 0x7f5000000000, 4, 4, 300), {0, 8, 16, 24}) == 1);
}

TEST_CASE("requests to L2 of random launches are those of single loads, where caches are large enough") {
    Gpu gpu = small_gpu();
    gpu.sms = 1;
    gpu.warps_per_sm = gpu.warps_per_cta = 1;  // warps one after the other
    gpu.levels[0].ways = 4096;                 // nothing is evicted
    gpu.front_end.lanes_per_request_16 = GENERATE(2u, 32u);
    gpu.front_end.lanes_per_request_8 = gpu.front_end.lanes_per_request_4 = 32;
    const Launch launch = random_launch({region(ObjectKind::node, 0x7f5000000000, 64, 64, 300),
                                         region(ObjectKind::triangle, 0x7f5000200000, 48, 48, 200),
                                         region(ObjectKind::texel, 0x10000000000, 4, 4, 3000)},
                                        12, 40, 11);
    const Both both = replay_with_requests(gpu, launch);
    CHECK(both.instructions.all().requests == naive_requests(gpu, launch));
    CHECK(both.instructions.all().requests > 100);
    CHECK(both.instructions.all().requests <= both.counted.all().levels[1].sectors);
    // And lanes of loads: 4 of a node, 3 of a triangle, 1 of a texel.
    std::uint64_t lanes = 0;
    for (const auto& warp : launch.warps)
        for (const traces::Record& record : warp->records)
            if (record.is_access()) lanes += record.lanes() * (4 - record.region - (record.region == 2));
    CHECK(both.instructions.all().lane_accesses == lanes);
    CHECK(both.instructions.all().warp_accesses == both.counted.all().loads);
}

TEST_CASE("lanes of loads are exact where one kind of object is read by different numbers of loads") {
    Gpu gpu = small_gpu();
    gpu.front_end.load_bytes = 16;
    auto warp = std::make_shared<traces::WarpTrace>();
    warp->records = {{0b1, 0, traces::RayType::camera, 0, 0}, {0b111, 1, traces::RayType::camera, 0, 0}};
    warp->elements = {5, 1, 2, 3};
    const Launch launch{
        {region(ObjectKind::node, 0x7f5000000000, 64, 64, 300), region(ObjectKind::node, 0x7f5000200000, 32, 32, 300)},
        {warp}};
    const Both both = replay_with_requests(gpu, launch);
    CHECK(both.instructions.all().warp_accesses == 4 + 2);
    CHECK(both.instructions.all().lane_accesses == 4 * 1 + 2 * 3);
}

TEST_CASE("stores ask L2 by single stores, whatever L1 has") {
    Gpu gpu = small_gpu();
    gpu.front_end.load_bytes = 16;
    gpu.front_end.lanes_per_request_16 = 32;
    const auto state = region(ObjectKind::hit_write, 0x7f5000000000, 32, 32, 300);
    const Both both = replay_with_requests(gpu, one_access(state, {0, 1, 2, 3, 4}));
    CHECK(both.counted.all().levels[1].sectors == 5);
    CHECK(both.instructions.all().requests == 2);  // the first store of all lanes, two lines
}
