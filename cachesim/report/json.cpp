#include "cachesim/report/cold_launches.hpp"
#include "cachesim/report/json_parts.hpp"

namespace raycache::cachesim {

namespace {

/// Counts over all sample indices; those of wavefronts only where there are any.
Json totals_of(const Row& row, bool l3) {
    Json json = Json::object();
    for (const TrafficFigure& figure : traffic_figures) {
        if (figure.of != Of::total || (figure.presence == Presence::three_levels && !l3)) continue;
        const std::uint64_t total = figure.total(row.totals, row.caches);
        if (figure.presence != Presence::wavefront || total != 0) json[figure.name] = total;
    }
    return json;
}

/// Null where there is no baseline. A level that the row's GPU lacks changes nothing: 1.
Json factors_of(const Row& row, bool l3) {
    if (!row.factors) return nullptr;
    Json json = Json::object();
    for (std::size_t i = 0; i < row.figures.size(); ++i) {
        const TrafficFigure& figure = traffic_figures[i];
        if (figure.object == nullptr || figure.of == Of::total || (figure.presence == Presence::three_levels && !l3))
            continue;
        json[figure.name] = json_of(row.figures[i].value_or(Estimate{1, {}}));
    }
    return json;
}

/// `l3`: whether the report says anything of an L3; where this row's GPU has none, it says null.
Json figures_of(const Row& row, bool l3) {
    Json json{{"totals", totals_of(row, l3)}};
    const auto add_part = [&](Presence part) {
        for (std::size_t i = 0; i < row.figures.size(); ++i) {
            const TrafficFigure& figure = traffic_figures[i];
            if (figure.of == Of::total || figure.presence != part || !figure.in_json()) continue;
            if (figure.object == nullptr)
                json[figure.name] = json_of(row.figures[i]);
            else if (!json.contains(figure.object))
                json[figure.object] = factors_of(row, l3);
        }
    };
    add_part(Presence::always);
    json["verdict"] = row["dram_bytes_ratio"] ? json_of(verdict(difference_of(row))) : Json(nullptr);
    if (row["written_bytes_per_ray"]) add_part(Presence::wavefront);
    if (l3) add_part(Presence::three_levels);
    return json;
}

}  // namespace

Json traffic_json(const Report& report, std::size_t row) { return figures_of(report.rows[row], report.has_l3()); }

Json figures_json(const Report& report, const char* at) {
    Json json = Json::array();
    for (const TrafficFigure& figure : traffic_figures)
        if (report.has(figure.presence)) json.push_back(figure_json(figure, at));
    return json;
}

std::string to_json(const Report& report) {
    Json json{{"baseline", report.baseline.strategy},
              {"baseline_gpu", report.baseline.gpu.empty() ? Json(nullptr) : Json(report.baseline.gpu)},
              {"by", name_of(report.by)}};
    json["rows"] = Json::array();
    for (std::size_t i = 0; i < report.rows.size(); ++i) {
        json["rows"].push_back(row_names(report.rows[i]));
        json["rows"].back().update(traffic_json(report, i));
        if (!report.cold.empty()) json["rows"].back()["cold_launches"] = cold_json(report.cold[i]);
    }
    json["notes"] = Json(report.notes);
    json["figures"] = figures_json(report, nullptr);
    return dump(json);
}

}  // namespace raycache::cachesim
