// What reports in JSON have in common.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "cachesim/report/report.hpp"
#include "cachesim/report/verdict.hpp"

namespace raycache::cachesim {

using Json = nlohmann::ordered_json;

/// The shortest digits that read back as the same double; null where there is no value.
inline Json json_of(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

inline Json json_of(const Estimate& e) {
    return {{"mean", json_of(e.mean)}, {"half_width_95", e.half_width ? json_of(*e.half_width) : Json(nullptr)}};
}
inline Json json_of(const std::optional<Estimate>& e) { return e ? json_of(*e) : Json(nullptr); }

inline Json json_of(const Verdict& v) {
    return {{"level", v.level ? Json(*v.level) : Json(nullptr)}, {"text", v.text}};
}

/// What a row is of: scene, strategy, GPU, group, sample indices.
inline Json row_names(const Row& row) {
    return {{"scene", row.scene},           {"strategy", row.strategy},
            {"sequence", row.sequence},     {"parameters", row.parameters},
            {"thread_map", row.thread_map}, {"gpu", row.gpu},
            {"group", row.group},           {"spp", row.spp},
            {"samples", row.samples}};
}

/// A row of a report without its names, as to_json(Report) has it.
Json traffic_json(const Report&, std::size_t row);

/// The value of "by".
inline const char* name_of(GroupBy by) {
    constexpr const char* names[] = {"none", "bounce", "ray", "object"};
    return names[static_cast<unsigned>(by)];
}

/// A name that is no UTF-8 shows U+FFFD instead of ending the program.
inline std::string dump(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n'; }

}  // namespace raycache::cachesim
