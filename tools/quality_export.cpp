// The machine-readable forms of a QualityReport.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "cachesim/report/csv_field.hpp"
#include "tools/quality_report.hpp"

namespace raycache::tools {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json measured(const tracer::Measured& m) { return {{"value", number(m.value)}, {"standard_error", number(m.error)}}; }

Json errors_json(const tracer::ErrorMeasures& e) {
    Json json{{"rmse", measured(e.rmse)},
              {"relative_rmse", measured(e.relative_rmse)},
              {"r8", measured(e.r8)},
              {"block_rmse", number(e.block_rmse)},
              {"mean_error", {{"value", number(e.mean_error)}, {"standard_error", number(e.mean_error_deviation)}}},
              {"z_pixels", number(e.z_pixels)},
              {"z_seeds", e.z_seeds ? number(*e.z_seeds) : Json(nullptr)}};
    const auto worst = tracer::worst_block(e);
    json["worst_block"] =
        worst ? Json{{"x", worst->x}, {"y", worst->y}, {"mean_error", number(worst->mean_error)}} : Json(nullptr);
    return json;
}

Json row_json(const QualityRow& row, const std::vector<QualityRow>& all) {
    const tracer::StrategySettings& s = row.strategy();
    Json json{{"label", label(row, all)},
              {"strategy", s.decorrelation},
              {"sequence", s.sequence},
              {"parameters", row.parameters},
              {"mu", s.parameters.mu ? Json(*s.parameters.mu) : Json(nullptr)},
              {"spp", row.spp()},
              {"seed", s.parameters.seed}};
    json.update(errors_json(row.errors));
    json["rmse_ratio"] =
        row.baseline ? number(row.errors.rmse.value / all[*row.baseline].errors.rmse.value) : Json(nullptr);
    if (!row.pairs.empty()) {
        for (const PairEffect& p : row.pairs)
            json["dimension_pairs"].push_back(
                {{"dimensions", {2 * p.pair, 2 * p.pair + 1}}, {"share_of_structured_error", number(p.share)}});
    }
    if (row.timing) {
        json["predicted_seconds"] = number(row.timing->seconds);
        const auto& up = row.timing->speed_up;
        json["speed_up"] = up ? Json{{"mean", number(up->mean)},
                                     {"half_width_95", up->half_width ? number(*up->half_width) : Json(nullptr)}}
                              : Json(nullptr);
    }
    if (row.equal_time) {
        json["equal_time"] = {{"spp", row.equal_time->spp}};
        json["equal_time"].update(errors_json(row.equal_time->errors));
    }
    return json;
}

std::string field(const std::string& text) { return cachesim::csv_field(text); }
std::string field(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

}  // namespace

std::string to_json(const QualityReport& report, const Recommendation* recommendation) {
    Json json{{"scene", report.scene},
              {"width", report.width},
              {"height", report.height},
              {"baseline", report.baseline},
              {"gpu", report.gpu.empty() ? Json(nullptr) : Json(report.gpu)},
              {"repeats", report.repeats},
              {"reference",
               {{"spp", report.reference_spp},
                {"rmse", number(report.rows.front().errors.reference_rmse)},
                {"mean_luminance", number(report.rows.front().errors.reference_luminance)},
                {"file", report.reference_path.empty() ? Json(nullptr) : Json(report.reference_path)}}}};
    if (recommendation) {
        json["recommendation"] = recommendation->text;
        json["recommended_mu"] = recommendation->mu ? Json(*recommendation->mu) : Json(nullptr);
        json["accepted"] = {{"r8", recommendation->max_r8}, {"rmse_ratio", recommendation->max_rmse}};
    }
    for (const QualityRow& row : report.rows) json["rows"].push_back(row_json(row, report.rows));
    json["notes"] = report.notes;
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_csv(const QualityReport& report) {
    std::string text =
        "scene,strategy,sequence,parameters,mu,spp,rmse,rmse_error,rmse_ratio,relative_rmse,r8,r8_error,block_rmse,"
        "mean_error,mean_error_deviation,z_pixels,z_seeds,worst_pair,worst_pair_share,gpu,predicted_seconds,speed_up,"
        "speed_up_ci95,equal_time_spp,equal_time_rmse,equal_time_r8\n";
    const double none = std::nan("");
    for (const QualityRow& row : report.rows) {
        const tracer::ErrorMeasures& e = row.errors;
        const tracer::StrategySettings& s = row.strategy();
        text += fmt::format("{},{},{},{},{},{}", field(report.scene), field(s.decorrelation), field(s.sequence),
                            field(row.parameters), field(s.parameters.mu.value_or(none)), row.spp());
        const double ratio = row.baseline ? e.rmse.value / report.rows[*row.baseline].errors.rmse.value : none;
        for (const double value :
             {e.rmse.value, e.rmse.error, ratio, e.relative_rmse.value, e.r8.value, e.r8.error, e.block_rmse,
              e.mean_error, e.mean_error_deviation, e.z_pixels, e.z_seeds.value_or(none)})
            text += fmt::format(",{}", field(value));
        const auto worst = row.worst_pair();
        text += worst ? fmt::format(",{}-{},{}", 2 * worst->pair, 2 * worst->pair + 1, field(worst->share)) : ",,";
        const auto speed_up = row.timing ? row.timing->speed_up : std::nullopt;
        text += fmt::format(",{},{},{},{}", field(report.gpu), field(row.timing ? row.timing->seconds : none),
                            field(speed_up ? speed_up->mean : none),
                            field(speed_up && speed_up->half_width ? *speed_up->half_width : none));
        const auto& same = row.equal_time;
        text +=
            same ? fmt::format(",{},{},{}\n", same->spp, field(same->errors.rmse.value), field(same->errors.r8.value))
                 : std::string(",,,\n");
    }
    return text;
}

}  // namespace raycache::tools
