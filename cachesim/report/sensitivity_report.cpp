#include "cachesim/report/sensitivity_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cachesim/report/csv_line.hpp"
#include "cachesim/report/format.hpp"
#include "cachesim/report/json_parts.hpp"

namespace raycache::cachesim {

namespace {

constexpr double quantiles[] = {0, 0.05, 0.25, 0.5, 0.75, 0.95, 1};

std::string verdict_text(const Sensitivity& s) {
    const SensitivityVerdict index = verdict_of(s, Per::index), ray = verdict_of(s, Per::ray);
    if (index.text == ray.text) return fmt::format("Verdict: {}.\n", index.text);
    return fmt::format("Verdict per sample index: {}.\nVerdict per ray: {}.\n", index.text, ray.text);
}

std::string effects_table(const Sensitivity& s, std::size_t width) {
    using Align = TextTable::Align;
    TextTable table;
    table.column("value", Align::left);
    table.column("low", Align::right);
    table.column("speed-up", Align::right);
    table.column("file", Align::right);
    table.column("speed-up", Align::right, 1);
    table.column("high", Align::right);
    table.column("speed-up", Align::right);
    table.column("swing", Align::right);
    for (const Effect& e : ranked_effects(s))
        table.row({e.key, e.low_value, with_interval(e.low, 3), e.value, with_interval(s.per_index, 3), e.high_value,
                   with_interval(e.high, 3), fmt::format("{:.3f}{}", e.swing, e.certain ? "" : "?")});
    return table.text(width);
}

std::string row_text(const SensitivityReport& report, const Sensitivity& s, std::size_t width) {
    std::string text =
        break_lines(fmt::format("{}, {} over {}: {} per sample index, {} per ray (predicted; {}{}{})\n", s.gpu,
                                s.strategy, s.baseline, with_interval(s.per_index, 3), with_interval(s.per_ray, 3),
                                report.sample, report.model.empty() ? "" : "; changes by a ", report.model),
                    width);
    if (!s.hypercube.empty())
        text += break_lines(
            fmt::format(
                "{} points of the hypercube, per sample index: {:.3f} to {:.3f}; 5 % to 95 %: {:.3f} to {:.3f}, "
                "median {:.3f}\n",
                s.hypercube.size(), hypercube_quantile(s, 0), hypercube_quantile(s, 1), hypercube_quantile(s, 0.05),
                hypercube_quantile(s, 0.95), hypercube_quantile(s, 0.5)),
            width);
    text += break_lines(verdict_text(s), width, 4);
    if (!s.open.empty()) text += '\n' + effects_table(s, width);
    if (!s.unread.empty())
        text += break_lines(
            fmt::format("\nNot read by these replays, so without effect: {}\n", fmt::join(s.unread, ", ")), width, 4);
    return text;
}

Json values_json(const std::vector<ChosenValue>& values) {
    Json json = Json::array();
    for (const auto& [key, value] : values) json.push_back({{"key", key}, {"value", value}});
    return json;
}

Json varied_point_json(const VariedPoint& p) {
    return {{"values", values_json(p.values)},
            {"change", json_of(p.change)},
            {"speed_up_per_index", json_of(p.per_index)},
            {"speed_up_per_ray", json_of(p.per_ray)}};
}

const char* word(Outcome outcome) {
    return outcome == Outcome::faster ? "faster" : outcome == Outcome::slower ? "slower" : "not_known";
}

Json verdict_json(const SensitivityVerdict& v) { return {{"outcome", word(v.outcome)}, {"text", v.text}}; }

Json sensitivity_json(const Sensitivity& s) {
    Json spread = Json::array();
    if (!s.hypercube.empty())
        for (const double p : quantiles)
            spread.push_back({{"share", p}, {"speed_up_per_index", json_of(hypercube_quantile(s, p))}});
    Json effects = Json::array();
    for (const Effect& e : ranked_effects(s)) {
        const auto value =
            std::find_if(s.open.begin(), s.open.end(), [&](const GpuValue& v) { return v.key == e.key; });
        Json points = Json::array();
        for (const std::size_t i : e.points) points.push_back(varied_point_json(s.one_by_one[i]));
        effects.push_back({{"key", e.key},
                           {"value", e.value},
                           {value->range->listed ? "choices" : "range", value->range->values},
                           {"range_source", value->range->source},
                           {"swing", json_of(e.swing)},
                           {"certain", e.certain},
                           {"points", std::move(points)}});
    }
    Json hypercube = Json::array();
    for (const VariedPoint& p : s.hypercube) hypercube.push_back(varied_point_json(p));
    return {{"gpu", s.gpu},
            {"strategy", s.strategy},
            {"baseline", s.baseline},
            {"speed_up_per_index", json_of(s.per_index)},
            {"speed_up_per_ray", json_of(s.per_ray)},
            {"verdict_per_index", verdict_json(verdict_of(s, Per::index))},
            {"verdict_per_ray", verdict_json(verdict_of(s, Per::ray))},
            {"quantiles", std::move(spread)},
            {"effects", std::move(effects)},
            {"hypercube", std::move(hypercube)},
            {"unread", s.unread}};
}

}  // namespace

std::string to_text(const SensitivityReport& report, std::size_t width) {
    std::string text;
    for (const Sensitivity& s : report.rows) {
        if (!text.empty()) text += '\n';
        text += row_text(report, s, width);
    }
    return text + '\n' +
           break_lines(
               "low, high: ends of a range, or the slowest and the fastest of choices; swing: largest less smallest "
               "speed-up; ?: no value changes the speed-up for certain\n",
               width);
}

std::string to_json(const SensitivityReport& report) {
    Json rows = Json::array();
    for (const Sensitivity& s : report.rows) rows.push_back(sensitivity_json(s));
    return Json{{"sample", report.sample}, {"model", report.model}, {"sensitivities", std::move(rows)}}.dump(2) + "\n";
}

std::string to_csv(const SensitivityReport& report) {
    CsvLine titles;
    for (const char* title :
         {"gpu", "strategy", "baseline", "kind", "values", "change", "change_ci95", "speed_up_per_index",
          "speed_up_per_index_ci95", "speed_up_per_ray", "speed_up_per_ray_ci95"})
        titles.text(title);
    std::string text = titles.end();
    for (const Sensitivity& s : report.rows) {
        const auto add = [&](const char* kind, const VariedPoint& p) {
            std::string values;
            for (const auto& [key, value] : p.values)
                values += fmt::format("{}{}={}", values.empty() ? "" : " ", key, value);
            CsvLine line;
            for (const std::string& name : {s.gpu, s.strategy, s.baseline, std::string(kind), values}) line.text(name);
            for (const Estimate& e : {p.change, p.per_index, p.per_ray}) line.estimate(e);
            text += line.end();
        };
        add("file", {{}, {1, 0.0}, s.per_index, s.per_ray});
        for (const VariedPoint& p : s.one_by_one) add("one", p);
        for (const VariedPoint& p : s.hypercube) add("hypercube", p);
    }
    return text;
}

}  // namespace raycache::cachesim
