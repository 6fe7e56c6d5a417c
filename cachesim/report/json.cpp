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

Json counters(const Counters& c) {
    return {{"rays", c.rays},
            {"steps", c.steps},
            {"lane_accesses", c.lane_accesses},
            {"warp_accesses", c.warp_accesses},
            {"sectors", c.sectors},
            {"l1_hits", c.l1_hits},
            {"l2_sectors", c.l2_sectors},
            {"l2_hits", c.l2_hits},
            {"dram_sectors", c.dram_sectors}};
}

Json factors(const std::optional<Factors>& f) {
    if (!f) return nullptr;
    return {{"work", f->work},
            {"simt_efficiency", f->simt_efficiency},
            {"coalescing", f->coalescing},
            {"l1_locality", f->l1_locality},
            {"l2_locality", f->l2_locality}};
}

Json row_json(const Row& row) {
    return {{"scene", row.scene},
            {"strategy", row.strategy},
            {"sequence", row.sequence},
            {"parameters", row.parameters},
            {"thread_map", row.thread_map},
            {"gpu", row.gpu},
            {"group", row.group},
            {"spp", row.spp},
            {"samples", row.samples},
            {"totals", counters(row.totals)},
            {"rays", estimate(row.rays)},
            {"steps_per_ray", estimate(row.steps_per_ray)},
            {"active_lanes", estimate(row.active_lanes)},
            {"sectors_per_access", estimate(row.sectors_per_access)},
            {"l1_hit_rate", estimate(row.l1_hit_rate)},
            {"l2_hit_rate", estimate(row.l2_hit_rate)},
            {"l2_bytes_per_ray", estimate(row.l2_bytes_per_ray)},
            {"dram_bytes_per_ray", estimate(row.dram_bytes_per_ray)},
            {"l2_bytes_ratio", estimate(row.l2_bytes_ratio)},
            {"dram_bytes_ratio", estimate(row.dram_bytes_ratio)},
            {"factors", factors(row.factors)}};
}

}  // namespace

std::string to_json(const Report& report) {
    constexpr const char* by[] = {"none", "bounce", "ray", "object"};
    Json json{{"baseline", report.baseline}, {"by", by[static_cast<unsigned>(report.by)]}};
    json["rows"] = Json::array();
    for (const Row& row : report.rows) json["rows"].push_back(row_json(row));
    json["notes"] = Json(report.notes);
    // A name that is no UTF-8 shows U+FFFD instead of ending the program.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace raycache::cachesim
