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

inline Json json_of(const WindowSample& w) {
    Json json{{"blocks", w.blocks}, {"indices_per_block", w.indices}, {"windows_per_block", w.windows}};
    if (w.timed_windows) json["timed_windows_per_block"] = w.timed_windows;
    if (w.all_indices) json["all_indices"] = true;
    json.update({{"unfilled_share", json_of(w.unfilled_share)},
                 {"last_cache_full", w.last_cache_full},
                 {"widening", json_of(w.widening)}});
    return json;
}

/// What a row is of: scene, strategy, GPU, and windows where it is an estimate from some.
inline Json names_of(const Origin& o) {
    Json json{{"scene", o.scene},           {"strategy", o.strategy},     {"sequence", o.sequence},
              {"parameters", o.parameters}, {"thread_map", o.thread_map}, {"gpu", o.gpu}};
    if (o.windows) json["windows"] = json_of(*o.windows);
    return json;
}
/// The same with group and sample indices.
inline Json row_names(const Row& row) {
    Json json = names_of(row);
    json.update({{"group", row.group}, {"spp", row.spp}, {"samples", row.samples}});
    return json;
}

/// A row of a report without its names, as to_json(Report) has it.
Json traffic_json(const Report&, std::size_t row);

/// What the figures of a report are: the value of "figures". `at`: the key of a row that holds those of the row;
/// null: the row itself.
Json figures_json(const Report&, const char* at);

/// One figure: its title, unit, meaning and the way it is shown. docs/json.md.
template <class Figure>
Json figure_json(const Figure& figure, const char* at) {
    constexpr const char* better[] = {nullptr, "lower", "higher"};
    const auto text = [](const char* t) { return t ? Json(t) : Json(nullptr); };
    Json path = figure.in_json() ? Json::array() : Json(nullptr);
    for (const char* key : {at, figure.object, figure.name})
        if (key && figure.in_json()) path.push_back(key);
    std::string divisor = figure.denominator ? figure.denominator->name : "";
    if (figure.per) divisor += std::string(" x ") + figure.per->name;
    Json json{{"key", figure.key},
              {"path", path},
              {"title", figure.title},
              {"unit", figure.unit},
              {"definition", figure.definition},
              {"numerator", figure.numerator.name},
              {"denominator", divisor.empty() ? Json(nullptr) : Json(divisor)},
              {"compared", figure.is_compared()},
              {"better", text(better[static_cast<unsigned>(figure.better)])},
              {"digits", figure.page_digits == about_four_digits ? Json(nullptr) : Json(figure.page_digits)},
              {"interval", figure.interval},
              {"page", figure.page}};
    if (figure.profiler) json["profiler"] = figure.profiler;
    return json;
}

/// The value of "by".
inline const char* name_of(GroupBy by) {
    constexpr const char* names[] = {"none", "bounce", "ray", "object"};
    return names[static_cast<unsigned>(by)];
}

/// A name that is no UTF-8 shows U+FFFD instead of ending the program.
inline std::string dump(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n'; }

}  // namespace raycache::cachesim
