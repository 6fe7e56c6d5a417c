// What a kind of object means to replays and reports is its row in traces/object_kind.hpp, and nothing else.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "cachesim/analysis/explainer.hpp"
#include "cachesim/replay/replay.hpp"
#include "cachesim/report/explanation.hpp"
#include "cachesim/report/groups.hpp"
#include "cachesim/report/json_key.hpp"
#include "timed_cases.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;

namespace {

constexpr std::uint64_t node_charge = 1000, triangle_charge = 2000, texel_charge = 4000;

std::uint64_t charge_of(const traces::ObjectKindRole& role) {
    switch (role.charge) {
        case traces::Charge::node:
            return node_charge;
        case traces::Charge::triangle:
            return triangle_charge;
        case traces::Charge::texel:
            return texel_charge;
    }
    return 0;
}

/// Two lanes each access one sector of a region of the kind.
Launch one_access(traces::ObjectKind kind) {
    Launch launch = launch_of({{{0, 64}}});
    launch.regions = {region(kind, 0x200000, 32, 32, 1000)};
    return launch;
}

LaunchStatistics counted(const Launch& launch) {
    Replay replay(timed_gpu(), launch.regions, 0);
    for (const auto& warp : launch.warps) replay.push(warp);
    return replay.finish();
}

}  // namespace

TEST_CASE("an access counts as a step, a read, a write or a stream as the row of its kind says") {
    for (const traces::ObjectKindRole& role : traces::object_kind_roles) {
        INFO(role.name);
        const LaunchStatistics s = counted(one_access(role.kind));
        const Counters& c = s.groups.at(0).by_kind[static_cast<std::size_t>(role.kind)];
        CHECK(c.lane_accesses == 2);
        CHECK(c.steps == (role.is_step ? 2 : 0));
        CHECK(c.dram_sectors == 2);
        CHECK(c.written_sectors == (role.access == traces::AccessType::write ? 2 : 0));
        CHECK(c.sort_sectors == (role.access == traces::AccessType::stream ? 2 : 0));
        const auto groups = split({s}, GroupBy::object);
        REQUIRE(groups.size() == 1);
        CHECK(groups[0].name == role.name);
        CHECK(groups[0].loads.warp_accesses == (role.access == traces::AccessType::read ? 1 : 0));
        CHECK(groups[0].stores.warp_accesses == (role.access == traces::AccessType::write ? 1 : 0));
    }
}

TEST_CASE("a visit takes the instructions that the row of its kind charges; what needs no answer is no visit") {
    Gpu gpu = timed_gpu();
    gpu.timing->node_instructions = node_charge;
    gpu.timing->triangle_instructions = triangle_charge;
    gpu.timing->texel_instructions = texel_charge;
    for (const traces::ObjectKindRole& role : traces::object_kind_roles) {
        INFO(role.name);
        const TimedStatistics t = timed(gpu, one_access(role.kind));
        CHECK(t.instructions - t.loads == (role.access == traces::AccessType::read ? charge_of(role) : 0));
    }
}

TEST_CASE("requests of a launch can be followed unless a kernel leaves an object for the next") {
    for (const traces::ObjectKindRole& role : traces::object_kind_roles) {
        INFO(role.name);
        const Launch launch = one_access(role.kind);
        Replay replay(timed_gpu(), launch.regions, 0);
        const ElementDepth depth(launch.regions);
        Explainer explainer(timed_gpu(), launch.regions, depth);
        if (role.is_between_kernels)
            CHECK_THROWS_AS(replay.observe(explainer), Error);
        else
            CHECK_NOTHROW(replay.observe(explainer));
    }
}

TEST_CASE("an explanation has a row for each kind that was looked up") {
    for (const traces::ObjectKindRole& role : traces::object_kind_roles) {
        Explanation e;
        e.base.name = "plain";
        e.other.name = "clever";
        for (ExplainedTrace* side : {&e.base, &e.other}) {
            side->launches = {counted(one_access(role.kind))};
            side->findings.levels.resize(2);
            side->findings.levels[0].of_group(0, role.kind).lookups = 2;
        }
        const auto found = nlohmann::json::parse(to_json(e))["base"]["levels"]["l1"]["by_object"];
        REQUIRE(found.size() == 1);
        CHECK(found.begin().key() == snake_case(role.name));
        for (const traces::ObjectKindRole& other : traces::object_kind_roles)
            CHECK((to_text(e).find(std::string("\n") + other.plural + "  ") != std::string::npos) == (&other == &role));
    }
}
