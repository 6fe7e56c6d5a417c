// raycache sweep: what a scrambling distance mu buys in predicted time and costs in picture quality.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cachesim/report/table.hpp"
#include "tools/program/commands.hpp"
#include "tools/program/console.hpp"
#include "tools/program/estimate_options.hpp"
#include "tools/program/program.hpp"
#include "tools/program/quality_options.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

constexpr const char* baseline = "cranley-patterson";

struct SweepArguments {
    QualityOptions common;
    std::vector<double> mus{0, 1. / 64, 1. / 32, 1. / 16, 0.09, 0.125, 0.18, 0.25, 0.35, 0.5, 0.71, 1};
    std::string swept = "micro-jitter", sequence = "sobol";
    std::vector<std::string> others{"coherent", "cranley-patterson", "random"};
    std::uint64_t spp = 64;
    EstimateOptions estimate;
    double max_r8 = 2, max_rmse = 1.1;
};

std::string speed_text(const QualityRow& row) {
    const auto& up = row.timing->speed_up;
    if (!up) return "not predicted";
    return fmt::format("predicted {} x",
                       tracer::measured_text({up->mean, up->half_width.value_or(std::nan("")), {}, {}, 0}, 3));
}

std::string describe(const QualityRow& row) {
    const double mu = *row.strategy().parameters.number("mu");
    const bool number = row.ratio->value.resolved() || row.ratio->value.below || row.ratio->value.above;
    return fmt::format("mu {:.4g} (K {:.3g}): speed {}, R8 {}, RMSE {}{}", mu,
                       mu * std::sqrt(static_cast<double>(row.spp())), speed_text(row),
                       tracer::measured_text(row.errors.r8, 2), tracer::ratio_text(*row.ratio), number ? " x" : "");
}

const QualityRow& row_of(double mu, const QualityReport& report) {
    return *std::find_if(report.rows.begin(), report.rows.end(),
                         [&](const QualityRow& r) { return r.strategy().parameters.number("mu") == mu; });
}

/// Whether that row is certainly faster than the baseline, or what would tell.
std::string gain_text(const SweepArguments& o, const QualityRow& row) {
    const auto& up = row.timing->speed_up;
    if (!up || (up->half_width && up->mean - *up->half_width > 1)) return {};
    if (up->half_width && up->mean + *up->half_width < 1) return fmt::format("; slower than {}", baseline);
    std::string text = fmt::format("; no certain gain over {}", baseline);
    constexpr double least = 0.005;  // a gain of half a percent is none to speak of
    const double wanted = std::max(std::fabs(up->mean - 1), least);
    if (row.timing->windows) {
        if (up->half_width && *up->half_width > wanted)
            text += fmt::format(", too noisy to say: lower --target-error to {:.2g}%", 100 * wanted / up->mean);
        return text;
    }
    const std::uint64_t traced = std::min(o.common.sampling.trace_samples, o.spp);
    const std::uint64_t to = up->half_width ? std::min(o.spp, tracer::raised(traced, *up->half_width, wanted))
                                            : std::min<std::uint64_t>(o.spp, 8);
    if (to > traced) text += ", too noisy to say: " + tracer::Raise{"--trace-samples", traced, to}.text();
    return text;
}

std::string advice_text(const SweepArguments& o, const QualityReport& report, const tracer::SweepAdvice& advice) {
    const std::string bounds =
        fmt::format("R8 at most {} and an RMSE of at most {} x {}'s", o.max_r8, o.max_rmse, baseline);
    std::string text;
    if (advice.mu) {
        const QualityRow& best = row_of(*advice.mu, report);
        text = fmt::format("{} with {}, the least with {}{}", o.swept, describe(best), bounds, gain_text(o, best));
    } else if (advice.why.verdict == tracer::Verdict::rejected) {
        text = fmt::format("no mu of this list has {}; the largest: {}", bounds,
                           describe(row_of(*advice.blocked_by, report)));
    }
    if (!advice.blocked_by) return text;
    const QualityRow& next = row_of(*advice.blocked_by, report);
    if (advice.why.verdict == tracer::Verdict::unclear) {
        const tracer::Judgement& why = advice.why;
        text += text.empty() ? "" : "; below it, ";
        text += fmt::format("{} {}", o.swept, describe(next));
        const bool noisy = why.raise.has_value();
        text += fmt::format(", {} ({}){}", noisy ? "too noisy to say" : "not to be judged", why.reason,
                            noisy ? ": " + why.raise->text() : "");
    } else if (advice.mu) {
        text += fmt::format("; below it, {}", describe(next));
    }
    return text;
}

Recommendation recommend(const SweepArguments& o, const QualityReport& report) {
    const tracer::SweepLimits limits{o.max_r8, o.max_rmse};
    std::vector<tracer::SweepPoint> points;
    for (const QualityRow& row : report.rows)
        if (row.strategy().parameters.has("mu"))
            points.push_back({*row.strategy().parameters.number("mu"), row.errors.r8, *row.ratio});
    const auto advice = tracer::advise(points, limits, {o.common.repeats, o.common.reference_spp});
    return {advice_text(o, report, advice), advice, limits};
}

Action plan(const std::shared_ptr<const SweepArguments>& o, const Command* command) {
    if (!tracer::find_decorrelation(o->swept).has_parameter("mu"))
        throw UsageError(
            fmt::format("--swept {}; expected a strategy that has a mu: micro-jitter, scrambling-distance", o->swept));
    for (const auto& [option, value] : {std::pair("--max-r8", o->max_r8), std::pair("--max-rmse", o->max_rmse)})
        if (value <= 0) throw UsageError(fmt::format("{} {}; expected a number above 0", option, value));
    QualityJob job = o->common.job();
    const auto add = [&](const std::string& strategy, const std::string& mu) {
        job.cases.push_back({{strategy}, o->sequence, o->spp, {}, mu});
    };
    for (const double mu : o->mus) add(o->swept, fmt::format("{}", mu));
    std::vector<std::string> others = o->others;
    if (std::find(others.begin(), others.end(), baseline) == others.end()) others.emplace_back(baseline);
    for (const std::string& strategy : others) add(strategy, {});
    job.baseline = baseline;
    LaunchSettings launches{{}, job.scene, job.sampling, job.cases};
    std::string why_exact;  // never: a sweep has megakernels alone
    job.estimate = o->estimate.settings(*command, launches, why_exact);
    if (!o->common.baseline.empty() && o->common.baseline != baseline)
        throw UsageError(
            fmt::format("--baseline {}; expected {}, which a sweep is held against", o->common.baseline, baseline));
    job.request();  // checked
    return [o, command, job] {
        Deliveries deliveries;
        Progress progress("sweep");
        const QualityReport report = o->common.measure(*command, job, {}, deliveries, progress).report;
        const Recommendation advice = recommend(*o, report);
        deliveries.attempt([&] {
            print(o->common.json ? o->common.json.document(to_json(report, &advice), report.subject)
                  : o->common.csv
                      ? to_csv(report)
                      : to_text(report, o->common.width.columns()) + "\n" +
                            cachesim::break_lines("recommendation: " + advice.text + "\n", cachesim::text_width, 2));
        });
        deliveries.finish(say_failure);
    };
}

}  // namespace

void add_sweep(Program& program) {
    auto o = std::make_shared<SweepArguments>();
    Command* command = program.add_subcommand(
        "sweep",
        "Which scrambling distance to set: predicted speed and picture quality against mu, with a recommendation");
    o->common.add(*command, true);
    o->estimate.add(*command, "of every predicted speed-up");
    command->remove_option("--mu");  // of one strategy; here it is a list
    const std::size_t own = command->options().size();
    command->add_option("--mu", o->mus, "scrambling distances, separated by commas")->range(0.0, 1.0);
    command->add_option("--swept", o->swept, "the strategy whose mu is swept")->choices("strategy", strategy_names());
    command->add_option("--strategy", o->others, "other strategies to compare with, separated by commas")
        ->choices("strategy", strategy_names());
    command->add_option("--sequence", o->sequence, "the sequence of all")->choices("sequence", sequence_names());
    add_spp(*command, o->spp, "samples per pixel N");
    command->add_option("--max-r8", o->max_r8, "structured-noise index that the recommendation accepts")
        ->range(0.0, 1e6);
    command->add_option("--max-rmse", o->max_rmse, "RMSE over cranley-patterson's that it accepts")->range(0.0, 1e6);
    command->move_to_front(own);
    command->examples(
        {"raycache sweep courtyard --gpu gtx-980-ti --spp 64",
         "raycache sweep sponza.glb --gpu h100 --spp 256 --resolution 256x256 --mu 0,0.1,0.2,0.5,1 --csv",
         "raycache sweep courtyard --gpu rtx-3070 --spp 256 --target-error 2%",
         "raycache sweep cornell_box.glb --gpu gtx-980-ti --json > sweep.json && tools/plot_sweep sweep.json -o "
         "sweep.png"});
    command->plan([o, command] { return plan(o, command); });
}

}  // namespace raycache::tools
