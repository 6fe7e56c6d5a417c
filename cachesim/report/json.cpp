#include "cachesim/analysis/factor_terms.hpp"
#include "cachesim/report/json_parts.hpp"

namespace raycache::cachesim {

namespace {

Json counters(const Counters& c, bool l3) {
    Json json{{"rays", c.rays},
              {"steps", c.steps},
              {"lane_accesses", c.lane_accesses},
              {"warp_accesses", c.warp_accesses},
              {"loads", c.loads},
              {"l1_requests", c.l1_requests},
              {"l1_hits", c.l1_request_hits()},
              {"sectors", c.sectors},
              {"l1_visit_hits", c.l1_hits},
              {"l2_sectors", c.l2_sectors},
              {"l2_hits", c.l2_hits}};
    if (l3) json.update({{"l3_sectors", c.l3_sectors}, {"l3_hits", c.l3_hits}});
    json["dram_sectors"] = c.dram_sectors;
    json["dram_first_sectors"] = c.dram_first_sectors;
    if (c.written_sectors != 0) json["written_sectors"] = c.written_sectors;
    if (c.sort_sectors != 0) json["sort_sectors"] = c.sort_sectors;
    return json;
}

Json factors(const std::optional<Factors>& f, bool l3) {
    if (!f) return nullptr;
    Json json = Json::object();
    for (const FactorTerm& term : factor_terms(l3 ? 3 : 2)) json[term.key] = json_of((*f).*term.factor);
    return json;
}

/// `l3`: whether the report says anything of an L3; where this row's GPU has none, it says null.
Json figures_of(const Row& row, bool l3) {
    Json json = Json::object();
    json.update({{"totals", counters(row.totals, l3)},
                 {"rays", json_of(row.rays)},
                 {"steps_per_ray", json_of(row.steps_per_ray)},
                 {"active_lanes", json_of(row.active_lanes)},
                 {"sectors_per_access", json_of(row.sectors_per_access)},
                 {"l1_hit_rate", json_of(row.l1_hit_rate)},
                 {"l1_visit_hit_rate", json_of(row.l1_visit_hit_rate)},
                 {"l2_hit_rate", json_of(row.l2_hit_rate)},
                 {"l2_bytes_per_ray", json_of(row.l2_bytes_per_ray)},
                 {"dram_bytes_per_ray", json_of(row.dram_bytes_per_ray)},
                 {"dram_compulsory_share", json_of(row.dram_compulsory_share)},
                 {"l2_bytes_ratio", json_of(row.l2_bytes_ratio)},
                 {"dram_bytes_ratio", json_of(row.dram_bytes_ratio)},
                 {"factors", factors(row.factors, l3)},
                 {"equal_miss_rates", row.factors ? json_of(row.factors->equal_miss_rates) : Json(nullptr)},
                 {"cache_locality", row.factors ? json_of(row.factors->cache_locality) : Json(nullptr)},
                 {"verdict", row.dram_bytes_ratio ? json_of(verdict(difference_of(row))) : Json(nullptr)}});
    if (row.written_bytes_per_ray)
        json.update({{"written_bytes_per_ray", json_of(row.written_bytes_per_ray)},
                     {"sort_bytes_per_ray", json_of(row.sort_bytes_per_ray)}});
    if (l3)
        json.update({{"l3_hit_rate", json_of(row.l3_hit_rate)},
                     {"l3_bytes_per_ray", json_of(row.l3_bytes_per_ray)},
                     {"l3_bytes_ratio", json_of(row.l3_bytes_ratio)}});
    return json;
}

}  // namespace

Json traffic_json(const Report& report, std::size_t row) { return figures_of(report.rows[row], report.has_l3()); }

std::string to_json(const Report& report) {
    Json json{{"baseline", report.baseline}, {"by", name_of(report.by)}};
    json["rows"] = Json::array();
    for (std::size_t i = 0; i < report.rows.size(); ++i) {
        json["rows"].push_back(row_names(report.rows[i]));
        json["rows"].back().update(traffic_json(report, i));
    }
    json["notes"] = Json(report.notes);
    return dump(json);
}

}  // namespace raycache::cachesim
