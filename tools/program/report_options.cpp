#include "tools/program/report_options.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cachesim/report/profiler.hpp"
#include "tools/jobs/baseline.hpp"
#include "tools/program/console.hpp"
#include "tools/program/options.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

cachesim::GroupBy parse_by(const std::string& text) {
    if (text == "none") return cachesim::GroupBy::none;
    if (text == "bounce") return cachesim::GroupBy::bounce;
    if (text == "ray") return cachesim::GroupBy::ray;
    if (text == "object") return cachesim::GroupBy::object;
    throw UsageError(fmt::format("--by '{}'; expected one of: none, bounce, ray, object", text));
}

template <class Report>
void print_and_save(const Report& report, const Subject& subject, const ReportOptions& o) {
    using cachesim::to_csv, cachesim::to_json, cachesim::to_text;
    const auto text = [&] {
        if constexpr (requires { to_text(report, std::size_t{}); })
            return to_text(report, o.width.columns());
        else
            return to_text(report);
    };
    const auto json = [&] { return o.json.document(to_json(report), subject); };
    Deliveries deliveries;
    deliveries.attempt([&] { print(o.json ? json() : o.csv ? to_csv(report) : text()); });
    if (!o.save.empty()) {
        deliveries.attempt([&] { write_text(o.save + ".txt", text()); });
        deliveries.attempt([&] { write_text(o.save + ".json", json()); });
        deliveries.attempt([&] { write_text(o.save + ".csv", to_csv(report)); });
    }
    deliveries.finish(say_failure);
}

}  // namespace

void ReportOptions::add(Command& command, bool with_baseline) {
    gpus.add_names(command, "GPU preset or FILE.toml, or several (see 'raycache list gpus')")->required();
    gpus.add_changes(command);
    command.group("Report");
    command.add_flag("--timed", timed, "predict cycles, too: latencies, queues and bandwidths beside order")
        ->excludes({"--by"});
    command
        .add_option("--by", by,
                    "one row per: none, bounce (path vertex), ray (camera, bounce, shadow), object (node, triangle, "
                    "texel)")
        ->choices("grouping", {"none", "bounce", "ray", "object"})
        ->type_name("WHAT");
    if (with_baseline)
        command
            .add_option("--baseline", baseline,
                        "strategy that ratios refer to; default: cranley-patterson where it is compared")
            ->check(strategy_name_check());
    if (with_baseline)
        command.add_flag("--across-gpus", across_gpus,
                         "ratios of all variants of the GPU (--set, --l1-kib, --l2-kib) to the baseline on the first "
                         "of them, instead of on their own");
    json.add(command);
    width.add(command);
    command.add_flag("--csv", csv, "print CSV")->excludes({"--json"});
    command
        .add_option("--counters", counters,
                    "ncu: instead of the table, totals under the names of Nsight Compute's metrics, in any format "
                    "(docs/counters.md); with --timed also rates and shares of peaks")
        ->choices("set of counters", {"ncu"});
    command.add_option("--save", save, "also write PREFIX.txt, PREFIX.json and PREFIX.csv")->type_name("PREFIX");
    command.group("");
}

std::vector<cachesim::Gpu> ReportOptions::load_gpus(const FileNames& inputs) const {
    check();
    refuse_overwriting(inputs, outputs());
    std::vector<cachesim::Gpu> loaded = gpus.load(outputs());
    if (timed) gpus.check_timed(loaded);
    if (across_gpus) gpus.check_variants(loaded, timed);
    if (!counters.empty()) gpus.check_profiled(loaded, timed);
    return loaded;
}

void ReportOptions::check() const {
    if (json && csv) throw UsageError("--json and --csv together; expected one of them (--save PREFIX writes both)");
    if (timed && by != "none")
        throw UsageError("--timed with --by; expected --timed alone: a launch's cycles have no parts");
    refuse_stdout("--save", save);
    parse_by(by);
}

FileNames ReportOptions::outputs() const {
    if (save.empty()) return {};
    return {save + ".txt", save + ".json", save + ".csv"};
}

ReplayJob ReportOptions::job() const {
    ReplayJob job;
    job.gpu = gpus;
    job.timed = timed;
    return job;
}

void ReportOptions::publish(const ReplayResult& result, const std::vector<std::string>& remarks) const {
    if (timed) {
        auto report = cachesim::make_timed_report(result.times, baseline_of(result.times, baseline, across_gpus),
                                                  result.series, result.cold);
        report.fidelity = result.fidelity;
        report.notes.insert(report.notes.end(), remarks.begin(), remarks.end());
        return print_and_save(report, result.subject, *this);
    }
    cachesim::Report report = cachesim::make_report(result.series, baseline_of(result.series, baseline, across_gpus),
                                                    parse_by(by), result.cold);
    report.notes.insert(report.notes.end(), remarks.begin(), remarks.end());
    print_and_save(report, result.subject, *this);
}

void ReportOptions::run_and_publish(const ReplayJob& job, const std::vector<cachesim::Gpu>& loaded, Observer& observer,
                                    const std::vector<std::string>& remarks) const {
    if (counters.empty()) return publish(run(job, loaded, observer, outputs()), remarks);
    const ProfileResult result = profile(job, loaded, observer, outputs());
    print_and_save(
        cachesim::make_profile(result.series, baseline_of(result.series, baseline, across_gpus), parse_by(by)),
        result.subject, *this);
}

}  // namespace raycache::tools
