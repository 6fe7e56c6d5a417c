#include "cachesim/report/profiler.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cachesim/series.hpp"
#include "tests/folders.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;

namespace {

/// As if half of all load instructions sent a request to L2.
ProfiledSeries profiled(const std::string& strategy, std::vector<LaunchStatistics> launches) {
    ProfiledSeries made;
    static_cast<Series&>(made) = series(strategy, launches);
    for (LaunchStatistics& launch : launches) {
        for (RayGroup& group : launch.groups)
            for (Counters& c : group.by_kind) {
                if (c.loads == 0) continue;
                c.lane_accesses *= c.loads / c.warp_accesses;
                c.warp_accesses = c.loads;
                c.requests = c.loads / 2;
            }
        made.instructions.push_back(launch);
    }
    return made;
}

/// Of the first row, by name.
nlohmann::json metrics_of(const ProfilerReport& profile) {
    nlohmann::json metrics;
    const auto report = nlohmann::json::parse(to_json(profile));
    for (const auto& metric : report["rows"][0]["metrics"])
        metrics[metric["name"].get<std::string>()] = metric["value"];
    return metrics;
}

}  // namespace

TEST_CASE("the counters of a profiler are as computed by hand") {
    Counters c = counters(100, 4000, 800, 8000, 4000, 1000);
    c.loads = 3200;
    c.requests = 16000;
    const std::string text = to_text(
        make_profile({profiled("a", {{0, {RayGroup{traces::RayType::camera, 0, {c}, 100}}}})}, "", GroupBy::none));
    for (const char* line :
         {"room, a, N 64, gtx-980-ti\n", "l1tex__t_requests_pipe_lsu_mem_global_op_ld.sum 3200",
          "l1tex__t_sectors_pipe_lsu_mem_global_op_ld.sum 16000",
          "l1tex__t_sectors_pipe_lsu_mem_global_op_ld_lookup_hit.sum 12000",
          "l1tex__t_sectors_pipe_lsu_mem_global_op_ld_lookup_miss.sum 4000", "l1tex__t_sector_hit_rate.pct 75.00",
          "l1tex__t_sector_pipe_lsu_mem_global_op_ld_hit_rate.pct 75.00",  // 4000 of 16000 miss
          "l1tex__average_t_sectors_per_request_pipe_lsu_mem_global_op_ld.ratio 5.00",
          "l1tex__m_xbar2l1tex_read_sectors_mem_lg_op_ld.sum 4000", "lts__t_requests_srcunit_tex_op_read.sum 1600",
          "lts__t_sectors_srcunit_tex_op_read.sum 4000", "L2 sectors per read request 2.50",
          "lts__t_sectors_srcunit_tex_op_read_lookup_hit.sum 3000",
          "lts__t_sectors_srcunit_tex_op_read_lookup_miss.sum 1000", "lts__t_sector_op_read_hit_rate.pct 75.00",
          "lts__t_sector_hit_rate.pct 75.00", "dram__sectors_read.sum 1000", "dram__bytes_read.sum 32000",
          "smsp__thread_inst_executed_per_inst_executed.ratio 5.00"}) {
        std::string squeezed;
        for (const char letter : text)
            if (letter != ' ' || squeezed.back() != ' ') squeezed += letter;
        CHECK_THAT(squeezed, Catch::Contains(line));
    }
    CHECK_THAT(text, !Catch::Contains("op_write") && !Catch::Contains("op_st") && !Catch::Contains("per_second"));
    const ProfilerReport nothing = make_profile({profiled("a", {launch(0, {})})}, "", GroupBy::none);
    CHECK_THAT(to_text(nothing) + to_csv(nothing), !Catch::Contains("nan"));
    CHECK(metrics_of(nothing)["lts__t_sector_op_read_hit_rate.pct"].is_null());
}

TEST_CASE("rates and shares of peaks of a profiler are over the time that is predicted") {
    Counters c = counters(100, 4000, 800, 8000, 4000, 1000);
    c.loads = 3200;
    ProfiledSeries two = profiled("a", {launch(0, c), launch(1, c)});
    TimedStatistics t;
    t.cycles = 1000;
    t.seconds = 1e-6;
    t.dram_sectors = 250;
    t.levels[1].hits = 500;
    t.l1_port = {300, 2};
    t.l2_slices = {100, 4};
    t.dram = {400, 1};
    two.times = {t, t};
    const ProfilerReport profile = make_profile({two}, "", GroupBy::none);
    const auto metrics = metrics_of(profile);
    CHECK(metrics["gpu__time_duration.sum"] == 2000);
    CHECK(metrics["gpc__cycles_elapsed.max"] == 2000);
    CHECK(metrics["l1tex__throughput.avg.pct_of_peak_sustained_elapsed"] == Approx(15));
    CHECK(metrics["lts__throughput.avg.pct_of_peak_sustained_elapsed"] == Approx(2.5));
    CHECK(metrics["gpu__dram_throughput.avg.pct_of_peak_sustained_elapsed"] == Approx(40));
    CHECK(metrics["dram__bytes.sum.per_second"] == Approx(500 * 32 / 2e-6));
    CHECK(metrics["dram__bytes_read.sum.per_second"] == Approx(500 * 32 / 2e-6));
    CHECK(metrics["l1tex__m_xbar2l1tex_read_bytes.sum.per_second"] == Approx(1000 * 32 / 2e-6));
    const auto requests = metrics["l1tex__t_sectors_pipe_lsu_mem_global_op_ld.sum"].get<double>();
    CHECK(metrics["l1tex__t_bytes_pipe_lsu_mem_global_op_ld.sum.per_second"] == Approx(requests * 32 / 2e-6));
    CHECK_THAT(to_text(profile), Catch::Contains("Times are predicted"));
    CHECK(metrics_of(make_profile(two, 1))["gpu__time_duration.sum"] == 1000);
}

TEST_CASE("docs/counters.md has every metric with its unit and formula") {
    const std::string path = raycache::test::source_folder() + "docs/counters.md";
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    std::string page = text.str(), table = "| metric | unit | is, or is computed from | where |\n|---|---|---|---|\n";
    constexpr const char* needs[] = {"", "wavefront", "no wavefront", "`--timed`", "`--timed`, no wavefront"};
    for (const ProfilerMetric& m : profiler_metrics())
        table += fmt::format("| {} | {} | {} | {} |\n",
                             std::string(m.name).find("__") == std::string::npos ? m.name : fmt::format("`{}`", m.name),
                             m.unit, m.formula, needs[static_cast<unsigned>(m.need)]);
    const std::string mark = "<!-- metrics -->\n\n";
    const auto at = page.find(mark);
    REQUIRE(at != std::string::npos);
    const auto end = page.find("\n\n", at + mark.size());
    const std::string wanted = page.substr(0, at + mark.size()) + table + page.substr(end + 1);
    if (std::getenv("RAYCACHE_WRITE_DOCS")) std::ofstream(path) << wanted;
    INFO("RAYCACHE_WRITE_DOCS=1 cachesim_tests \"docs/counters.md*\" writes the table");
    CHECK((page == wanted || std::getenv("RAYCACHE_WRITE_DOCS")));
}

TEST_CASE("stores and sorts of a wavefront are not counted as loads of a profiler") {
    Counters loads = counters(0, 4000, 800, 8000, 4000, 1000), stores = counters(0, 640, 20, 400, 400, 150),
             sorts = counters(0, 320, 10, 700, 700, 700);
    loads.loads = 3200;
    loads.requests = 16000;
    stores.loads = 80;
    stores.requests = 800;
    stores.written_sectors = 150;
    sorts.sort_sectors = 700;
    RayGroup group{traces::RayType::bounce, 1, {}, 100};
    group.by_kind[static_cast<unsigned>(traces::ObjectKind::node)] = loads;
    group.by_kind[static_cast<unsigned>(traces::ObjectKind::hit_write)] = stores;
    group.by_kind[static_cast<unsigned>(traces::ObjectKind::sort)] = sorts;
    const auto wave = profiled("wave, a", {{0, {group}}});
    for (const GroupBy by : {GroupBy::none, GroupBy::ray, GroupBy::bounce}) {
        const ProfilerReport profile = make_profile({wave}, "", by);
        const auto json = nlohmann::json::parse(to_json(profile));
        REQUIRE(json["rows"].size() == 1);
        CHECK(json["rows"][0]["strategy"] == "wave, a");
        auto metrics = metrics_of(profile);
        CHECK(metrics["l1tex__t_sectors_pipe_lsu_mem_global_op_ld.sum"] == 16000);
        CHECK(metrics["l1tex__m_xbar2l1tex_read_sectors_mem_lg_op_ld.sum"] == 4000);
        CHECK(metrics["lts__t_sectors_srcunit_tex_op_read_lookup_miss.sum"] == 1000);
        CHECK(metrics["dram__bytes_read.sum"] == 32 * 1000);
        CHECK(metrics["l1tex__t_sectors_pipe_lsu_mem_global_op_st.sum"] == 800);
        CHECK(metrics["l1tex__average_t_sectors_per_request_pipe_lsu_mem_global_op_st.ratio"] == 10);
        CHECK(metrics["l1tex__m_l1tex2xbar_write_sectors_mem_lg_op_st.sum"] == 400);
        CHECK(metrics["lts__t_sectors_op_write.sum"] == 400);
        CHECK(metrics["dram__bytes_write.sum"] == 32 * 150);
        CHECK(metrics["dram__bytes.sum"] == 32 * (1000 + 150 + 700));
        // 5 lanes in 4 loads of each of 800 accesses, 32 in 4 stores of each of 20.
        CHECK(metrics["smsp__thread_inst_executed_per_inst_executed.ratio"] == (4 * 4000. + 4 * 640.) / (3200 + 80));
        CHECK(metrics["l1tex__t_requests_pipe_lsu_mem_global_op_st.sum"] == 80);
        CHECK(metrics["lts__t_requests_srcunit_tex_op_read.sum"] == 1600);
        CHECK(metrics["lts__t_requests_srcunit_tex_op_write.sum"] == 40);
        CHECK(metrics["L2 sectors per write request"] == 10);
        CHECK(metrics["lts__t_sectors_srcunit_tex_op_write.sum"] == 400);
        CHECK(metrics["l1tex__t_sector_hit_rate.pct"] == 100. * 12000 / 16800);  // no store hits
        CHECK(!metrics.contains("lts__t_sector_hit_rate.pct"));
        const std::string csv = to_csv(profile);
        CHECK_THAT(csv, Catch::Contains(",samples,l1tex__") && Catch::Contains("\nroom,\"wave, a\",sobol,") &&
                            Catch::EndsWith(",4800,59200\n"));
        CHECK_THAT(to_text(profile), Catch::Contains("sorting rays moves"));
    }
    const auto by_object = make_profile({wave}, "", GroupBy::object).report;
    REQUIRE(by_object.rows.size() == 3);
    CHECK(by_object.rows[1].stores.levels[1].sectors == 400);
    CHECK(by_object.rows[1].loads.levels[1].sectors + by_object.rows[2].loads.levels[1].sectors == 0);
}
