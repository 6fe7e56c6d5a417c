#include <cmath>
#include <nlohmann/json.hpp>

#include "cachesim/report/report.hpp"

namespace raycache::cachesim {

namespace {

using Json = nlohmann::ordered_json;

/// The shortest digits that read back as the same double; null where there is no value.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json estimate(const std::optional<Estimate>& e) {
    if (!e) return nullptr;
    return {{"mean", number(e->mean)}, {"half_width_95", e->half_width ? number(*e->half_width) : Json(nullptr)}};
}

Json counters(const Counters& c, bool l3) {
    Json json{{"rays", c.rays},
              {"steps", c.steps},
              {"lane_accesses", c.lane_accesses},
              {"warp_accesses", c.warp_accesses},
              {"loads", c.loads},
              {"l1_requests", c.l1_requests},
              {"sectors", c.sectors},
              {"l1_hits", c.l1_hits},
              {"l2_sectors", c.l2_sectors},
              {"l2_hits", c.l2_hits}};
    if (l3) json.update({{"l3_sectors", c.l3_sectors}, {"l3_hits", c.l3_hits}});
    json["dram_sectors"] = c.dram_sectors;
    if (c.written_sectors != 0) json["written_sectors"] = c.written_sectors;
    if (c.sort_sectors != 0) json["sort_sectors"] = c.sort_sectors;
    return json;
}

Json factors(const std::optional<Factors>& f, bool l3) {
    if (!f) return nullptr;
    Json json{{"work", f->work},
              {"simt_efficiency", f->simt_efficiency},
              {"coalescing", f->coalescing},
              {"l1_locality", f->l1_locality},
              {"l2_locality", f->l2_locality}};
    if (l3) json["l3_locality"] = f->l3_locality;
    return json;
}

/// `l3`: whether the report says anything of an L3; where this row's GPU has none, it says null.
Json row_json(const Row& row, bool l3) {
    Json json{{"scene", row.scene},
              {"strategy", row.strategy},
              {"sequence", row.sequence},
              {"parameters", row.parameters},
              {"thread_map", row.thread_map},
              {"gpu", row.gpu},
              {"group", row.group},
              {"spp", row.spp},
              {"samples", row.samples},
              {"totals", counters(row.totals, l3)},
              {"rays", estimate(row.rays)},
              {"steps_per_ray", estimate(row.steps_per_ray)},
              {"active_lanes", estimate(row.active_lanes)},
              {"sectors_per_access", estimate(row.sectors_per_access)},
              {"l1_hit_rate", estimate(row.l1_hit_rate)},
              {"l1_request_hit_rate", estimate(row.l1_request_hit_rate)},
              {"l2_hit_rate", estimate(row.l2_hit_rate)},
              {"l2_bytes_per_ray", estimate(row.l2_bytes_per_ray)},
              {"dram_bytes_per_ray", estimate(row.dram_bytes_per_ray)},
              {"l2_bytes_ratio", estimate(row.l2_bytes_ratio)},
              {"dram_bytes_ratio", estimate(row.dram_bytes_ratio)},
              {"factors", factors(row.factors, l3)}};
    if (row.written_bytes_per_ray)
        json.update({{"written_bytes_per_ray", estimate(row.written_bytes_per_ray)},
                     {"sort_bytes_per_ray", estimate(row.sort_bytes_per_ray)}});
    if (l3)
        json.update({{"l3_hit_rate", estimate(row.l3_hit_rate)}, {"l3_bytes_per_ray", estimate(row.l3_bytes_per_ray)}});
    return json;
}

}  // namespace

std::string to_json(const Report& report) {
    constexpr const char* by[] = {"none", "bounce", "ray", "object"};
    Json json{{"baseline", report.baseline}, {"by", by[static_cast<unsigned>(report.by)]}};
    json["rows"] = Json::array();
    for (const Row& row : report.rows) json["rows"].push_back(row_json(row, report.has_l3()));
    json["notes"] = Json(report.notes);
    // A name that is no UTF-8 shows U+FFFD instead of ending the program.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace raycache::cachesim
