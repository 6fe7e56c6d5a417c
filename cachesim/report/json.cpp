
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
    Json json = row_names(row);
    json.update({{"totals", counters(row.totals, l3)},
                 {"rays", json_of(row.rays)},
                 {"steps_per_ray", json_of(row.steps_per_ray)},
                 {"active_lanes", json_of(row.active_lanes)},
                 {"sectors_per_access", json_of(row.sectors_per_access)},
                 {"l1_hit_rate", json_of(row.l1_hit_rate)},
                 {"l1_request_hit_rate", json_of(row.l1_request_hit_rate)},
                 {"l2_hit_rate", json_of(row.l2_hit_rate)},
                 {"l2_bytes_per_ray", json_of(row.l2_bytes_per_ray)},
                 {"dram_bytes_per_ray", json_of(row.dram_bytes_per_ray)},
                 {"l2_bytes_ratio", json_of(row.l2_bytes_ratio)},
                 {"dram_bytes_ratio", json_of(row.dram_bytes_ratio)},
                 {"factors", factors(row.factors, l3)}});
    if (row.written_bytes_per_ray)
        json.update({{"written_bytes_per_ray", json_of(row.written_bytes_per_ray)},
                     {"sort_bytes_per_ray", json_of(row.sort_bytes_per_ray)}});
    if (l3)
        json.update({{"l3_hit_rate", json_of(row.l3_hit_rate)}, {"l3_bytes_per_ray", json_of(row.l3_bytes_per_ray)}});
    return json;
}

}  // namespace

std::string to_json(const Report& report) {
    Json json{{"baseline", report.baseline}, {"by", name_of(report.by)}};
    json["rows"] = Json::array();
    for (const Row& row : report.rows) json["rows"].push_back(row_json(row, report.has_l3()));
    json["notes"] = Json(report.notes);
    return dump(json);
}

}  // namespace raycache::cachesim
