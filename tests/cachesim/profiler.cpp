#include "cachesim/report/profiler.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/cachesim/series.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;

namespace {

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
    const std::string text = to_text(ProfilerReport{
        make_report({series("a", {{0, {RayGroup{traces::RayType::camera, 0, {c}, 100}}}})}, "", GroupBy::none)});
    for (const char* line :
         {"room, a, N 64, gtx-980-ti\n", "l1tex__t_sectors_pipe_lsu_mem_global_op_ld.sum 16000",
          "l1tex__t_sector_pipe_lsu_mem_global_op_ld_hit_rate.pct 75.00",  // 4000 of 16000 miss
          "l1tex__average_t_sectors_per_request_pipe_lsu_mem_global_op_ld.ratio 5.00",
          "l1tex__m_xbar2l1tex_read_sectors_mem_lg_op_ld.sum 4000",
          "lts__t_sectors_srcunit_tex_op_read_lookup_hit.sum 3000",
          "lts__t_sectors_srcunit_tex_op_read_lookup_miss.sum 1000", "lts__t_sector_op_read_hit_rate.pct 75.00",
          "dram__bytes_read.sum 32000", "smsp__thread_inst_executed_per_inst_executed.ratio 5.00"}) {
        std::string squeezed;
        for (const char letter : text)
            if (letter != ' ' || squeezed.back() != ' ') squeezed += letter;
        CHECK_THAT(squeezed, Catch::Contains(line));
    }
    CHECK_THAT(text, !Catch::Contains("write") && !Catch::Contains("op_st"));
    const ProfilerReport nothing{make_report({series("a", {launch(0, {})})}, "", GroupBy::none)};
    CHECK_THAT(to_text(nothing) + to_csv(nothing), !Catch::Contains("nan"));
    CHECK(metrics_of(nothing)["lts__t_sector_op_read_hit_rate.pct"].is_null());
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
    const auto wave = series("wave, a", {{0, {group}}});
    for (const GroupBy by : {GroupBy::none, GroupBy::ray, GroupBy::bounce}) {
        const ProfilerReport profile{make_report({wave}, "", by)};
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
        CHECK(metrics["smsp__thread_inst_executed_per_inst_executed.ratio"] == 4640. / 820);
        const std::string csv = to_csv(profile);
        CHECK_THAT(csv, Catch::Contains(",samples,l1tex__") && Catch::Contains("\nroom,\"wave, a\",sobol,") &&
                            Catch::EndsWith(",4800,59200\n"));
        CHECK_THAT(to_text(profile), Catch::Contains("sorting rays moves"));
    }
    const auto by_object = make_report({wave}, "", GroupBy::object);
    REQUIRE(by_object.rows.size() == 3);
    CHECK(by_object.rows[1].stores.levels[1].sectors == 400);
    CHECK(by_object.rows[1].loads.levels[1].sectors + by_object.rows[2].loads.levels[1].sectors == 0);
}
