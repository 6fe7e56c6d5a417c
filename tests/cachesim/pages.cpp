// Regions of pages: what lies at the same addresses is the same to both replays, whatever region says so.
#include <catch2/catch.hpp>

#include "oracle.hpp"
#include "timed_cases.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;
using traces::ObjectKind;
using traces::PageTable;

namespace {

constexpr std::uint64_t base = 0x7f5000000000, page = PageTable::page_bytes;

/// Pages one behind the other from `base` on.
traces::Region in_pages(traces::Region region) {
    std::vector<std::uint64_t> numbers;
    for (std::uint64_t byte = 0; byte < std::uint64_t{region.count} * region.stride; byte += page)
        numbers.push_back((region.base + byte) / page);
    region.base = 0;
    region.pages = PageTable(numbers);
    return region;
}

}  // namespace

TEST_CASE("a region of pages that lie one behind the other counts and takes time as one without pages") {
    for (const std::uint32_t stride : {4u, 16u, 64u, 128u}) {
        Launch plain =
            random_launch({region(ObjectKind::node, base, std::min(stride, 64u), stride, 5000)}, 24, 40, stride);
        Launch paged = plain;
        paged.regions = {in_pages(plain.regions[0])};
        INFO(stride);
        CHECK((replay(small_gpu(), plain).all() == replay(small_gpu(), paged).all()));
        CHECK(timed(cramped_gpu(8), plain).cycles == timed(cramped_gpu(8), paged).cycles);
    }
}

TEST_CASE("lanes at both ends of memory are one access of as many sectors as they read") {
    traces::Region far = region(ObjectKind::node, 0, 32, 32, 2 * 128);
    far.pages = PageTable({0, ~std::uint64_t{0} / page});
    auto warp = std::make_shared<traces::WarpTrace>();
    warp->records.push_back({3, 0, traces::RayType::camera, 0, 0});
    warp->elements = {255, 0};
    const Counters counts = replay(small_gpu(), {{far}, {warp}}).all();
    CHECK(counts.warp_accesses == 1);
    CHECK(counts.loads == 2);
    CHECK(counts.requests == 4);
    CHECK(counts.levels[0].sectors == 2);
    CHECK(counts.dram_sectors == 2);
    CHECK(timed(timed_gpu(), {{far}, {warp}}).levels[0].requests() == 4);
}
