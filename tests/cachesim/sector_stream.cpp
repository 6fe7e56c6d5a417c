// The exported addresses, fed to a cache that is written anew here, give the replay's own hits.
#include "cachesim/export/sector_stream.hpp"

#include <catch2/catch.hpp>
#include <cstring>
#include <list>
#include <map>
#include <set>

#include "cachesim/replay/replay.hpp"
#include "oracle.hpp"
#include "random_launch.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;
using traces::ObjectKind;

namespace {

const std::vector<traces::Region> regions{region(ObjectKind::node, 0x7f5000000000, 64, 64, 300),
                                          region(ObjectKind::triangle, 0x7f5000200000, 48, 48, 200),
                                          region(ObjectKind::texel, 0x10000000000, 4, 4, 3000)};

const SectorFormat& format(const std::string& name) {
    for (const SectorFormat& f : sector_formats())
        if (f.name == name) return f;
    throw std::runtime_error("no format " + name);
}

struct Exported {
    std::string bytes;
    Counters counts;
};

Exported export_launch(const Gpu& gpu, const Launch& launch, SectorStream::Choice choice, const std::string& name) {
    Exported exported;
    SectorStream stream(choice, format(name), gpu.levels[0].sector_bytes,
                        [&](std::string_view piece) { exported.bytes += piece; });
    Replay replay(gpu, launch.regions, 0);
    replay.observe(stream);
    for (const auto& warp : launch.warps) replay.push(warp);
    exported.counts = replay.finish().all();
    stream.flush();
    return exported;
}

std::vector<std::uint64_t> addresses(const std::string& bytes) {
    REQUIRE(bytes.size() % 8 == 0);
    std::vector<std::uint64_t> all(bytes.size() / 8);
    if (!all.empty()) std::memcpy(all.data(), bytes.data(), bytes.size());
    return all;
}

/// Hits of a sectored LRU cache that is asked for one sector at a time.
std::uint64_t hits(const CacheGeometry& geometry, const std::vector<std::uint64_t>& sectors) {
    struct Line {
        std::uint64_t tag;
        std::set<std::uint64_t> present;
    };
    std::map<std::uint64_t, std::list<Line>> sets;  // newest first
    std::uint64_t found = 0;
    for (const std::uint64_t address : sectors) {
        REQUIRE(address % geometry.sector_bytes == 0);
        const std::uint64_t tag = address / geometry.line_bytes;
        auto& set = sets[naive_set(geometry, tag)];
        auto line = set.begin();
        while (line != set.end() && line->tag != tag) ++line;
        if (line == set.end())
            set.push_front({tag, {}});
        else
            set.splice(set.begin(), set, line);
        if (set.size() > geometry.ways) set.pop_back();
        found += !set.front().present.insert(address).second;
    }
    return found;
}

Gpu test_gpu(unsigned sms, unsigned l1_per_sm) {
    Gpu gpu = small_gpu();
    gpu.sms = sms;
    gpu.l1_per_sm = l1_per_sm;
    gpu.levels[0].ways = 16;  // room for some hits
    gpu.levels[1].sets = 24;
    gpu.levels[1].index = SetIndex::xor_fold;
    return gpu;
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t at = 0, end; (end = text.find('\n', at)) != std::string::npos; at = end + 1)
        lines.push_back(text.substr(at, end - at));
    return lines;
}

}  // namespace

TEST_CASE("the sectors exported of every L1 give the replay's L1 hits in a cache written anew") {
    const auto [sms, l1_per_sm] = GENERATE(table<unsigned, unsigned>({{1, 1}, {1, 2}, {3, 1}, {5, 3}}));
    const Gpu gpu = test_gpu(sms, l1_per_sm);
    const Launch launch = random_launch(regions, 60, 300, 5);  // more than one batch of requests
    const Counters expected = naive_replay(gpu, launch).all();
    std::uint64_t found = 0, asked = 0;
    for (unsigned sm = 0; sm < sms; ++sm) {
        for (unsigned l1 = 0; l1 < l1_per_sm; ++l1) {
            const Exported one = export_launch(gpu, launch, {0, sm, l1}, "u64");
            CHECK(one.counts == expected);  // to listen changes nothing
            const auto sectors = addresses(one.bytes);
            asked += sectors.size();
            const std::uint64_t here = hits(gpu.levels[0], sectors);
            found += here;
            // The hits that the replay itself saw there, line by line.
            std::uint64_t told = 0;
            for (const std::string& line : lines_of(export_launch(gpu, launch, {0, sm, l1}, "csv").bytes))
                told += line.ends_with(",1");
            CHECK(told == here);
        }
    }
    CHECK(asked == expected.levels[0].sectors);
    CHECK(found == expected.levels[0].hits);
    CHECK(found > 0);
    CHECK(found < asked);
}

TEST_CASE("the sectors exported of L2 give the replay's L2 hits in a cache written anew") {
    const auto sms = GENERATE(1u, 2u, 7u);
    const Gpu gpu = test_gpu(sms, 1);
    const Launch launch = random_launch(regions, 60, 300, 6);
    const Counters expected = naive_replay(gpu, launch).all();
    const Exported exported = export_launch(gpu, launch, {1, 0, {}}, "u64");
    CHECK(exported.counts == expected);
    const auto sectors = addresses(exported.bytes);
    CHECK(sectors.size() == expected.levels[1].sectors);
    CHECK(hits(gpu.levels[1], sectors) == expected.levels[1].hits);
    CHECK(expected.levels[1].hits > 0);
    CHECK(expected.dram_sectors > 0);
}

TEST_CASE("the three formats tell the same addresses") {
    const Gpu gpu = test_gpu(2, 2);
    const Launch launch = random_launch(regions, 20, 40, 7);
    const auto sectors = addresses(export_launch(gpu, launch, {0, 1, {}}, "u64").bytes);
    const auto dinero = lines_of(export_launch(gpu, launch, {0, 1, {}}, "dinero").bytes);
    const auto csv = lines_of(export_launch(gpu, launch, {0, 1, {}}, "csv").bytes);
    REQUIRE(!sectors.empty());
    REQUIRE(dinero.size() == sectors.size());
    REQUIRE(csv.size() == sectors.size() + 1);
    CHECK(csv[0] == "address,cache,ray,bounce,kind,hit");
    for (std::size_t i = 0; i < sectors.size(); ++i) {
        CHECK(dinero[i].substr(0, 2) == "0 ");
        CHECK(std::stoull(dinero[i].substr(2), nullptr, 16) == sectors[i]);
        CHECK(std::stoull(csv[i + 1]) == sectors[i]);
    }
}

TEST_CASE("a row tells whose look-up it is, sectors of a line in ascending order") {
    Launch launch{regions, {}};
    auto warp = std::make_shared<traces::WarpTrace>();
    warp->records = {{3u, 0, traces::RayType::shadow, 2, 0}, {1u, 2, traces::RayType::camera, 0, 0}};
    warp->elements = {1, 0, 9};
    launch.warps = {warp};
    CHECK(export_launch(test_gpu(1, 1), launch, {0, 0, 0}, "csv").bytes ==
          "address,cache,ray,bounce,kind,hit\n"
          "139981574111232,0,shadow,2,node,0\n"
          "139981574111264,0,shadow,2,node,0\n"
          "139981574111296,0,shadow,2,node,0\n"
          "139981574111328,0,shadow,2,node,0\n"
          "1099511627808,0,camera,0,texel,0\n");
    CHECK(export_launch(test_gpu(2, 1), launch, {0, 1, 0}, "u64").bytes.empty());
}
