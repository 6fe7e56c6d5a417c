// The machine-readable forms of a QualityReport.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cachesim/report/csv_field.hpp"
#include "tools/jobs/quality_report.hpp"

namespace raycache::tools {
namespace {

using Json = nlohmann::ordered_json;

Json json_number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json optional(const std::optional<double>& value) { return value ? json_number(*value) : Json(nullptr); }
Json estimate_json(const cachesim::Estimate& e) {
    if (!std::isfinite(e.mean)) return nullptr;
    return {{"mean", e.mean}, {"half_width_95", optional(e.half_width)}};
}
/// `below`: the reference's noise hides the figure; it is less than that.
Json measured(const tracer::Measured& m) {
    return {
        {"value", json_number(m.value)}, {"half_width_95", json_number(m.half_width)}, {"below", optional(m.below)}};
}

Json errors_json(const tracer::ErrorMeasures& e, std::uint32_t width) {
    Json json{{"rmse", measured(e.rmse)},
              {"relative_rmse", measured(e.relative_rmse)},
              {"robust_rmse", measured(e.robust_rmse)},
              {"r8", measured(e.r8)},
              {"block_rmse", measured(e.block_rmse)},
              {"mean_error",
               {{"value", json_number(e.mean_error.value)}, {"half_width_95", json_number(e.mean_error.half_width)}}},
              {"z_pixels", json_number(e.z_pixels)},
              {"z_seeds", e.z_seeds ? json_number(*e.z_seeds) : Json(nullptr)}};
    const auto worst = tracer::worst_block(e);
    json["worst_block"] =
        worst ? Json{{"x", worst->x}, {"y", worst->y}, {"mean_error", json_number(worst->mean_error)}} : Json(nullptr);
    const auto& few = e.few_pixels;
    json["half_of_squared_error"] = few ? Json{{"pixels", few->count},
                                               {"share", json_number(few->share)},
                                               {"x", few->largest % width},
                                               {"y", few->largest / width}}
                                        : Json(nullptr);
    return json;
}

/// `rmse_ratio`: null where it is not known; then below, above, decided_by_pixels or the words say why.
Json ratio_json(const std::optional<tracer::RmseRatio>& ratio) {
    const tracer::RmseRatio none{{std::nan(""), std::nan("")}, {std::nan(""), std::nan("")}, {}, false};
    const tracer::RmseRatio& r = ratio ? *ratio : none;
    return {{"rmse_ratio", json_number(r.value.value)},
            {"rmse_ratio_half_width_95", json_number(r.value.half_width)},
            {"rmse_ratio_below", optional(r.value.below)},
            {"rmse_ratio_above", optional(r.value.above)},
            {"robust_rmse_ratio", json_number(r.robust.value)},
            {"decided_by_pixels", r.decided_by_pixels ? Json(*r.decided_by_pixels) : Json(nullptr)},
            {"rmse_ratio_words", ratio ? Json(tracer::ratio_text(r)) : Json(nullptr)}};
}

Json row_json(const QualityRow& row, const std::vector<QualityRow>& all) {
    const tracer::StrategySettings& s = row.strategy();
    Json json{{"label", label(row, all)},
              {"strategy", s.decorrelation},
              {"sequence", s.sequence},
              {"parameters", row.parameters},
              {"mu", s.parameters.has("mu") ? Json(*s.parameters.number("mu")) : Json(nullptr)},
              {"spp", row.spp()},
              {"seed", s.samples.seed}};
    json["unbiased_by_construction"] = tracer::find_decorrelation(s.decorrelation).independent_pixels;
    json.update(errors_json(row.errors, row.settings.width));
    json.update(ratio_json(row.ratio));
    if (!row.pairs.empty()) {
        for (const PairEffect& p : row.pairs)
            json["dimension_pairs"].push_back(
                {{"dimensions", {2 * p.pair, 2 * p.pair + 1}}, {"share_of_structured_error", json_number(p.share)}});
    }
    if (row.timing) {
        json["predicted_seconds"] = json_number(row.timing->seconds);
        const auto& up = row.timing->speed_up;
        json["speed_up"] = up ? estimate_json(*up) : Json(nullptr);
    }
    for (const EqualError& against : row.equal_error) {
        const Json by_rmse = estimate_json(against.gain);
        json["equal_error"].push_back({{"baseline", label(all[against.baseline], all)},
                                       {"speed_up", estimate_json(against.speed_up)},
                                       {"rmse_ratio", json_number(against.ratio.value.value)},
                                       {"rmse_ratio_half_width_95", json_number(against.ratio.value.half_width)},
                                       {"gain_by_rmse", by_rmse},
                                       {"gain", row.no_equal_error.empty() ? by_rmse : Json(nullptr)}});
    }
    if (!row.equal_error.empty())
        json["no_equal_error"] = row.no_equal_error.empty() ? Json(nullptr) : Json(row.no_equal_error);
    if (row.equal_time) {
        json["equal_time"] = {{"spp", row.equal_time->spp}};
        json["equal_time"].update(errors_json(row.equal_time->errors, row.settings.width));
    }
    return json;
}

const char* to_string(tracer::Verdict verdict) {
    return verdict == tracer::Verdict::accepted   ? "accepted"
           : verdict == tracer::Verdict::rejected ? "rejected"
                                                  : "too noisy to say";
}

Json recommendation_json(const Recommendation& r) {
    Json json{{"recommendation", r.text},
              {"recommended_mu", optional(r.advice.mu)},
              {"accepted", {{"r8", r.limits.r8}, {"rmse_ratio", r.limits.rmse_ratio}}},
              {"next_smaller", nullptr}};
    if (!r.advice.blocked_by) return json;
    const auto& raise = r.advice.why.raise;
    json["next_smaller"] = {
        {"mu", *r.advice.blocked_by},
        {"verdict", to_string(r.advice.why.verdict)},
        {"reason", r.advice.why.reason},
        {"raise", raise ? Json{{"option", raise->option}, {"from", raise->from}, {"to", raise->to}} : Json(nullptr)}};
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
              {"time_resolution", report.time_resolution.empty() ? Json(nullptr) : Json(report.time_resolution)},
              {"repeats", report.repeats},
              {"clamp", report.clamp ? json_number(*report.clamp) : Json(nullptr)},
              {"reference",
               {{"spp", report.reference_spp},
                {"rmse", json_number(report.rows.front().errors.reference_rmse)},
                {"mean_luminance", json_number(report.rows.front().errors.reference_luminance)},
                {"file", report.reference_path.empty() ? Json(nullptr) : Json(report.reference_path)}}}};
    if (recommendation) json.update(recommendation_json(*recommendation));
    for (const QualityRow& row : report.rows) json["rows"].push_back(row_json(row, report.rows));
    json["notes"] = report.notes;
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_csv(const QualityReport& report) {
    std::string text =
        "scene,strategy,sequence,parameters,mu,spp,rmse,rmse_ci95,rmse_below,rmse_ratio,rmse_ratio_ci95,"
        "rmse_ratio_below,rmse_ratio_above,decided_by_pixels,robust_rmse,robust_rmse_ratio,relative_rmse,r8,r8_ci95,"
        "r8_below,block_rmse,mean_error,mean_error_ci95,z_pixels,z_seeds,worst_pair,worst_pair_share,gpu,"
        "predicted_seconds,speed_up,speed_up_ci95,equal_time_spp,equal_time_rmse,equal_time_r8,no_equal_error";
    for (std::string name : equal_error_baselines()) {
        std::replace(name.begin(), name.end(), '-', '_');
        text += fmt::format(",gain_{0},gain_{0}_ci95", name);
    }
    text += "\n";
    const double none = std::nan("");
    for (const QualityRow& row : report.rows) {
        const tracer::ErrorMeasures& e = row.errors;
        const tracer::StrategySettings& s = row.strategy();
        const tracer::RmseRatio r = row.ratio.value_or(tracer::RmseRatio{{none, none}, {none, none}, {}, false});
        text += fmt::format("{},{},{},{},{},{}", field(report.scene), field(s.decorrelation), field(s.sequence),
                            field(row.parameters), field(s.parameters.number("mu").value_or(none)), row.spp());
        for (const double value :
             {e.rmse.value, e.rmse.half_width, e.rmse.below.value_or(none), r.value.value, r.value.half_width,
              r.value.below.value_or(none), r.value.above.value_or(none),
              r.decided_by_pixels ? static_cast<double>(*r.decided_by_pixels) : none, e.robust_rmse.value,
              r.robust.value, e.relative_rmse.value, e.r8.value, e.r8.half_width, e.r8.below.value_or(none),
              e.block_rmse.value, e.mean_error.value, e.mean_error.half_width, e.z_pixels, e.z_seeds.value_or(none)})
            text += fmt::format(",{}", field(value));
        const auto worst = row.worst_pair();
        text += worst ? fmt::format(",{}-{},{}", 2 * worst->pair, 2 * worst->pair + 1, field(worst->share)) : ",,";
        const auto speed_up = row.timing ? row.timing->speed_up : std::nullopt;
        text += fmt::format(",{},{},{},{}", field(report.gpu), field(row.timing ? row.timing->seconds : none),
                            field(speed_up ? speed_up->mean : none),
                            field(speed_up && speed_up->half_width ? *speed_up->half_width : none));
        const auto& same = row.equal_time;
        text += same ? fmt::format(",{},{},{}", same->spp, field(same->errors.rmse.value), field(same->errors.r8.value))
                     : std::string(",,,");
        text += "," + field(row.equal_error.empty() ? std::string() : row.no_equal_error);
        for (const std::string& name : equal_error_baselines()) {
            cachesim::Estimate gain{none, std::nullopt};
            for (const EqualError& against : row.equal_error)
                if (report.rows[against.baseline].strategy().decorrelation == name && row.no_equal_error.empty())
                    gain = against.gain;
            text += fmt::format(",{},{}", field(gain.mean), field(gain.half_width.value_or(none)));
        }
        text += "\n";
    }
    return text;
}

}  // namespace raycache::tools
