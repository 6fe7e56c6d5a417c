// Who listens to a replay: several at once, in calls of many requests.
#include <catch2/catch.hpp>
#include <map>
#include <tuple>
#include <vector>

#include "cachesim/replay/replay.hpp"
#include "oracle.hpp"
#include "random_launch.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;
using traces::ObjectKind;

namespace {

struct Recorder final : RequestSink {
    using Request = std::tuple<std::size_t, std::uint64_t, std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t,
                               std::uint32_t, bool>;

    explicit Recorder(std::optional<std::size_t> chosen = {}) : level(chosen) {}

    bool wants(std::size_t l, std::uint32_t) const override { return !level || *level == l; }
    void issued(std::span<const IssuedAccess> accesses) override {
        ++calls;
        for (const IssuedAccess& a : accesses) {
            CHECK(warps.emplace(a.number, a.warp).second);  // no other of the window has the number
            lanes += a.record.lanes();
        }
    }
    void served(std::size_t l, std::span<const ServedRequest> batch) override {
        ++calls;
        for (const ServedRequest& r : batch) {
            REQUIRE(warps.count(r.access) == 1);
            requests.emplace_back(l, r.address, r.asked, r.missing, r.sm, r.cache, warps[r.access], r.counted);
        }
    }
    void end_window() override { warps.clear(); }

    std::optional<std::size_t> level;
    std::map<std::uint32_t, std::uint32_t> warps;  ///< by number of an access of this window
    std::vector<Request> requests;
    std::uint64_t lanes = 0, calls = 0;
};

}  // namespace

TEST_CASE("several sinks hear the same requests, each of the caches that it wants, and change no count") {
    const Launch launch = random_launch(
        {region(ObjectKind::node, 0x200000, 64, 64, 300), region(ObjectKind::triangle, 0x800000, 48, 48, 200)}, 60, 80,
        17);
    Gpu gpu = small_gpu();
    gpu.l1_per_sm = 2;
    Recorder first, second, only_l2(1);
    Replay replay(gpu, launch.regions, 0);
    replay.observe(first);
    replay.observe(second);
    replay.observe(only_l2);
    for (const auto& warp : launch.warps) replay.push(warp);
    const LaunchStatistics counts = replay.finish();
    CHECK(counts == naive_replay(gpu, launch));
    CHECK(first.requests == second.requests);
    CHECK(first.lanes == launch.lane_accesses());
    std::vector<Recorder::Request> l2;
    for (const Recorder::Request& r : first.requests)
        if (std::get<0>(r) == 1) l2.push_back(r);
    CHECK(only_l2.requests == l2);
    CHECK(only_l2.lanes == first.lanes);
    CHECK(l2.size() > 100);
    CHECK(first.calls < first.requests.size() / 4);  // many at once
}

TEST_CASE("sinks are told which requests are counted") {
    const Launch launch = random_launch({region(ObjectKind::node, 0x200000, 64, 64, 300)}, 30, 40, 18);
    Recorder all, some;
    for (Recorder* sink : {&all, &some}) {
        Replay replay(small_gpu(), launch.regions, 0);
        replay.observe(*sink);
        for (std::size_t w = 0; w < launch.warps.size(); ++w) {
            if (sink == &some && w == 10) replay.count_until_here();
            replay.push(launch.warps[w]);
        }
        replay.finish();
    }
    REQUIRE(all.requests.size() == some.requests.size());
    for (std::size_t i = 0; i < all.requests.size(); ++i) {
        CHECK(std::get<7>(all.requests[i]));
        CHECK(std::get<7>(some.requests[i]) == (std::get<6>(some.requests[i]) < 10));
        CHECK(std::get<3>(all.requests[i]) == std::get<3>(some.requests[i]));
    }
}
