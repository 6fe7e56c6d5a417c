// JSON and CSV of cache curves.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cachesim/gpus/choice.hpp"
#include "cachesim/report/csv_line.hpp"
#include "cachesim/report/curve_report.hpp"
#include "cachesim/report/json_parts.hpp"

namespace raycache::cachesim {

namespace {

const char* index_name(const CacheGeometry& geometry) { return name_of<SetIndex>(set_indices, geometry.index); }

Json point_json(const LevelCurve& level, const CurveRow& row, std::uint64_t ways) {
    std::uint64_t hits = 0, fetched = 0;
    for (const WaysCurve& launch : row.launches) {
        hits += launch.hits_of(ways);
        fetched += launch.fetched_of(ways);
    }
    return {{"bytes", ways * row.way_bytes()},
            {"ways", ways},
            {"hits", hits},
            {"fetched_sectors", fetched},
            {"hit_rate", json_of(hit_rate(level, row, ways))},
            {"bytes_per_ray", json_of(ratio_of_totals(level.bytes_per_ray(row, ways)))}};
}

/// Calls use(ways) for those of the table's sizes that are whole ways.
template <class Use>
void for_each_size(const CurveReport& report, std::size_t level, const CurveRow& row, const Use& use) {
    for (const std::uint64_t size : table_sizes(report, level))
        if (size >= row.least_ways() * row.way_bytes() && size % row.way_bytes() == 0) use(size / row.way_bytes());
}

Json organisation_json(const CurveReport& report, std::size_t l, const LevelCurve& level, std::size_t r) {
    const CurveRow& row = level.rows[r];
    const CacheGeometry& g = row.geometry;
    std::uint64_t asked = 0;
    for (const WaysCurve& launch : row.launches) asked += launch.asked;
    Json points = Json::array(), curve = Json::array();
    for_each_size(report, l, row, [&](std::uint64_t ways) { points.push_back(point_json(level, row, ways)); });
    for (const std::uint64_t ways : drawn_ways(row)) curve.push_back(point_json(level, row, ways));
    return {{"name", row_name(level, r)},  {"slices", g.slices},           {"sets", g.sets},
            {"index", index_name(g)},      {"way_bytes", row.way_bytes()}, {"asked_sectors", asked},
            {"points", std::move(points)}, {"curve", std::move(curve)}};
}

Json policies_json(const LevelCurve& level) {
    Json policies = Json::array();
    for (const PolicyRow& row : level.policies) {
        Json points = Json::array();
        for (std::size_t at = 0; at < row.ways.size(); ++at)
            points.push_back({{"bytes", row.ways[at] * level.rows.front().way_bytes()},
                              {"ways", row.ways[at]},
                              {"hit_rate", json_of(hit_rate(level, row, at))},
                              {"bytes_per_ray", json_of(ratio_of_totals(level.bytes_per_ray(row, at)))}});
        policies.push_back({{"policy", row.policy}, {"points", std::move(points)}});
    }
    return policies;
}

Json size_json(const EquivalentSize& e) {
    const auto bytes = [](const std::optional<std::uint64_t>& b) { return b ? Json(*b) : Json(nullptr); };
    return {{"bytes", bytes(e.size)},
            {"low_95", bytes(e.low)},
            {"high_95", bytes(e.high)},
            {"times", e.size ? json_of(e.times()) : Json(nullptr)}};
}

}  // namespace

std::string to_json(const CurveReport& report) {
    Json series = Json::array(), equivalents = Json::array();
    for (const CurveSeries& s : report.series) {
        Json json = names_of(s);
        Json levels = Json::array();
        for (std::size_t l = 0; l < s.levels.size(); ++l) {
            const LevelCurve& level = s.levels[l];
            const CurveRow& own = level.rows.front();
            Json rows = Json::array();
            for (std::size_t r = 0; r < level.rows.size(); ++r) rows.push_back(organisation_json(report, l, level, r));
            levels.push_back({{"level", level_name(level.level)},
                              {"fetched_from", traffic_name(level.level, s.caches.levels)},
                              {"own_bytes", own.geometry.ways * own.way_bytes()},
                              {"line_bytes", own.geometry.line_bytes},
                              {"look_ups", level.look_ups},
                              {"organisations", std::move(rows)},
                              {"policies", policies_json(level)}});
        }
        json.update({{"spp", s.spp}, {"samples", s.samples}, {"memory_bytes", s.memory_bytes}, {"levels", levels}});
        series.push_back(std::move(json));
    }
    for (const Equivalent& e : report.equivalents)
        equivalents.push_back({{"base", e.base},
                               {"other", e.other},
                               {"spp", e.spp},
                               {"level", level_name(e.level)},
                               {"own_bytes", e.bytes.of},
                               {"by_bytes_per_ray", size_json(e.bytes)},
                               {"by_hit_rate", size_json(e.misses)},
                               {"bandwidth", json_of(e.bandwidth)},
                               {"sentence", to_sentence(e)}});
    return dump({{"baseline", report.baseline.empty() ? Json(nullptr) : Json(report.baseline)},
                 {"series", std::move(series)},
                 {"equivalents", std::move(equivalents)},
                 {"notes", report.notes}});
}

std::string to_csv(const CurveReport& report) {
    CsvLine header;
    for (const char* title : {"scene",  "strategy", "sequence",      "parameters",    "thread_map",
                              "gpu",    "spp",      "samples",       "level",         "organisation",
                              "slices", "sets",     "index",         "policy",        "ways",
                              "bytes",  "hit_rate", "hit_rate_ci95", "bytes_per_ray", "bytes_per_ray_ci95"})
        header.text(title);
    std::string csv = header.end();
    for (const CurveSeries& s : report.series)
        for (std::size_t l = 0; l < s.levels.size(); ++l) {
            const LevelCurve& level = s.levels[l];
            const auto add = [&](std::size_t r, const std::string& policy, std::uint64_t ways, const Estimate& hits,
                                 const Estimate& bytes) {
                const CurveRow& row = level.rows[r];
                CsvLine line;
                for (const auto* name : {&s.scene, &s.strategy, &s.sequence, &s.parameters, &s.thread_map, &s.gpu})
                    line.text(*name);
                line.number(s.spp);
                line.text(fmt::format("{}", fmt::join(s.samples, " ")));
                line.text(level_name(level.level));
                line.text(row_name(level, r));
                line.number(std::uint64_t{row.geometry.slices});
                line.number(row.geometry.sets);
                line.text(index_name(row.geometry));
                line.text(policy);
                line.number(ways);
                line.number(ways * row.way_bytes());
                line.estimate(hits);
                line.estimate(bytes);
                csv += line.end();
            };
            for (std::size_t r = 0; r < level.rows.size(); ++r)
                for_each_size(report, l, level.rows[r], [&](std::uint64_t ways) {
                    add(r, "lru", ways, hit_rate(level, level.rows[r], ways),
                        ratio_of_totals(level.bytes_per_ray(level.rows[r], ways)));
                });
            for (const PolicyRow& row : level.policies)
                for (std::size_t at = 0; at < row.ways.size(); ++at)
                    add(0, row.policy, row.ways[at], hit_rate(level, row, at),
                        ratio_of_totals(level.bytes_per_ray(row, at)));
        }
    return csv;
}

}  // namespace raycache::cachesim
