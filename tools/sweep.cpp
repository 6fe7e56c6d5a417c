// raycache sweep: what a scrambling distance mu buys in predicted time and costs in picture quality.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/commands.hpp"
#include "tools/console.hpp"
#include "tools/quality_options.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

constexpr const char* baseline = "cranley-patterson";

struct Options {
    QualityOptions common;
    std::vector<double> mus{0, 1. / 64, 1. / 32, 1. / 16, 0.09, 0.125, 0.18, 0.25, 0.35, 0.5, 0.71, 1};
    std::string swept = "micro-jitter", sequence = "sobol";
    std::vector<std::string> others{"coherent", "cranley-patterson", "random"};
    std::uint64_t spp = 64;
    double max_r8 = 2, max_rmse = 1.1;
};

double ratio_of(const QualityRow& row, const std::vector<QualityRow>& rows) {
    return row.errors.rmse.value / rows[*row.baseline].errors.rmse.value;
}

std::string speed_text(const QualityRow& row) {
    const auto& up = row.timing->speed_up;
    if (!up) return "not predicted";
    return fmt::format("predicted {:.3f}{} x", up->mean,
                       up->half_width ? fmt::format(" ±{:.3f}", *up->half_width) : "");
}

std::string describe(const QualityRow& row, const std::vector<QualityRow>& rows) {
    const double mu = *row.strategy().parameters.mu;
    return fmt::format("mu {:.4g} (K {:.3g}): speed {}, R8 {:.2f}, RMSE {:.3f} x", mu,
                       mu * std::sqrt(static_cast<double>(row.spp())), speed_text(row), row.errors.r8.value,
                       ratio_of(row, rows));
}

/// The least mu that is acceptable together with every larger one: a lucky figure amid bad ones does not count.
Recommendation recommend(const Options& o, const QualityReport& report) {
    Recommendation advice{{}, std::nullopt, o.max_r8, o.max_rmse};
    std::vector<const QualityRow*> swept;
    for (const QualityRow& row : report.rows)
        if (row.strategy().parameters.mu) swept.push_back(&row);
    std::sort(swept.begin(), swept.end(), [](const QualityRow* a, const QualityRow* b) {
        return *a->strategy().parameters.mu > *b->strategy().parameters.mu;
    });
    const QualityRow *best = nullptr, *refused = nullptr;
    for (const QualityRow* row : swept) {
        const bool good = row->errors.r8.value <= o.max_r8 && ratio_of(*row, report.rows) <= o.max_rmse;
        if (!good) {
            refused = row;
            break;
        }
        best = row;
    }
    const std::string bounds =
        fmt::format("R8 at most {} and an RMSE of at most {} x {}'s", o.max_r8, o.max_rmse, baseline);
    if (!best) {
        advice.text = fmt::format("no mu of this list has {}; the largest: {}", bounds,
                                  swept.empty() ? "none" : describe(*swept.front(), report.rows));
        return advice;
    }
    advice.mu = best->strategy().parameters.mu;
    advice.text = fmt::format("{} with {}, the least with {}", o.swept, describe(*best, report.rows), bounds);
    if (refused) advice.text += fmt::format("; below it, {}", describe(*refused, report.rows));
    const auto& up = best->timing->speed_up;
    if (up && up->mean - up->half_width.value_or(0) <= 1)
        advice.text += fmt::format("; no certain gain over {}", baseline);
    return advice;
}

void run(const Options& o) {
    QualityRequest request;
    const auto add = [&](const std::string& strategy, std::optional<double> mu) {
        auto& settings =
            request.cases.emplace_back(o.common.sampling.capture(o.common.scene, o.sequence, strategy, o.spp));
        settings.strategy.parameters.mu = mu;
    };
    if (o.mus.empty()) throw UsageError("no mu to sweep; expected at least one");
    for (const double mu : o.mus) {
        if (!(mu >= 0 && mu <= 1)) throw UsageError(fmt::format("--mu {}; expected numbers from 0 to 1", mu));
        add(o.swept, mu);
    }
    std::vector<std::string> others = o.others;
    if (std::find(others.begin(), others.end(), baseline) == others.end()) others.emplace_back(baseline);
    for (const std::string& strategy : others) add(strategy, std::nullopt);
    request.baseline = baseline;
    if (!o.common.baseline.empty() && o.common.baseline != baseline)
        throw UsageError(
            fmt::format("--baseline {}; expected {}, which a sweep is held against", o.common.baseline, baseline));
    Deliveries deliveries;
    Progress progress("sweep");
    const QualityReport report = o.common.measure(std::move(request), {}, deliveries, progress);
    const Recommendation advice = recommend(o, report);
    deliveries.attempt([&] {
        print(o.common.json  ? o.common.json.document(to_json(report, &advice), report.subject)
              : o.common.csv ? to_csv(report)
                             : to_text(report) + "\nrecommendation: " + advice.text + "\n");
    });
    deliveries.finish();
}

}  // namespace

void add_sweep(CLI::App& app) {
    auto o = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "sweep",
        "Which scrambling distance to set: predicted speed and picture quality against mu, with a recommendation");
    o->common.add(*command, true);
    command->remove_option(command->get_option("--mu"));
    const auto list = [&](const char* name, auto& values, const char* help) {
        command->add_option(name, values, help)->delimiter(',')->allow_extra_args(false)->capture_default_str();
    };
    list("--mu", o->mus, "scrambling distances, 0 to 1, separated by commas");
    list("--strategy", o->others, "other strategies to compare with, separated by commas");
    command->add_option("--swept", o->swept, "the strategy whose mu is swept")->capture_default_str();
    command->add_option("--sequence", o->sequence, "the sequence of all")->capture_default_str();
    command->add_option("--spp", o->spp, "samples per pixel N")->capture_default_str();
    command->add_option("--max-r8", o->max_r8, "structured-noise index that the recommendation accepts")
        ->capture_default_str();
    command->add_option("--max-rmse", o->max_rmse, "RMSE over cranley-patterson's that it accepts")
        ->capture_default_str();
    command->footer(
        "Examples:\n"
        "  raycache sweep courtyard --gpu gtx-980-ti --spp 64\n"
        "  raycache sweep sponza.glb --gpu h100 --spp 256 --resolution 256x256 --mu 0,0.1,0.2,0.5,1 --csv\n"
        "  raycache sweep cornell_box.glb --gpu gtx-980-ti --json > sweep.json && tools/plot_sweep sweep.json -o "
        "sweep.png");
    command->callback([o] { run(*o); });
}

}  // namespace raycache::tools
