#include "cachesim/report/profiler.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cachesim/report/csv_line.hpp"
#include "cachesim/report/groups.hpp"
#include "cachesim/report/json_parts.hpp"
#include "cachesim/report/table.hpp"

namespace raycache::cachesim {

namespace {

bool has_time(const ProfilerReport& profile) {
    return std::any_of(profile.counts.begin(), profile.counts.end(), [](const ProfileCounts& c) { return c.time; });
}

/// The shortest digits that read back as the same number; an empty field where there is no value.
std::string field_of(const MetricValue& value) {
    const double number = number_of(value);
    if (!std::isfinite(number)) return "";
    return std::visit([](auto v) { return fmt::format("{}", v); }, value);
}

Json json_of_metric(const MetricValue& value) {
    if (const auto* count = std::get_if<std::uint64_t>(&value)) return *count;
    return json_of(std::get<double>(value));
}

}  // namespace

std::vector<ProfilerMetric> ProfilerReport::metrics() const {
    const bool stores = report.has_wavefront(), time = has_time(*this);
    std::vector<ProfilerMetric> shown;
    for (const ProfilerMetric& metric : profiler_metrics()) {
        const MetricNeed need = metric.need;
        if (need == MetricNeed::stores && !stores) continue;
        if ((need == MetricNeed::no_stores || need == MetricNeed::read_time) && stores) continue;
        if ((need == MetricNeed::time || need == MetricNeed::read_time) && !time) continue;
        shown.push_back(metric);
    }
    return shown;
}

ProfilerReport make_profile(const std::vector<ProfiledSeries>& all, const Baseline& baseline, GroupBy by) {
    ProfilerReport profile{make_report(std::vector<Series>(all.begin(), all.end()), baseline, by), {}};
    // The rows of a report are the groups of each series, one series after the other.
    for (const ProfiledSeries& series : all) {
        for (const LaunchGroup& group : split(series.instructions, by)) {
            const Row& row = profile.report.rows[profile.counts.size()];
            ProfileCounts& counts = profile.counts.emplace_back();
            counts.loads = row.loads;
            counts.stores = row.stores;
            counts.totals = row.totals;
            counts.load_instructions = group.loads;
            counts.store_instructions = group.stores;
            counts.caches = row.caches;
            for (const TimedStatistics& launch : series.times) {
                if (!counts.time) {
                    counts.time = launch;
                } else {
                    *counts.time += launch;
                }
            }
        }
    }
    return profile;
}

ProfilerReport make_profile(const ProfiledSeries& series, std::size_t launch) {
    ProfiledSeries one;
    static_cast<Origin&>(one) = series;
    one.launches = {series.launches[launch]};
    one.instructions = {series.instructions[launch]};
    if (!series.times.empty()) one.times = {series.times[launch]};
    return make_profile(std::vector{one}, "", GroupBy::none);
}

std::string to_string(const MetricValue& value, const char* none) {
    if (const auto* count = std::get_if<std::uint64_t>(&value)) return fmt::format("{}", *count);
    const double number = std::get<double>(value);
    return std::isfinite(number) ? fmt::format("{:.2f}", number) : none;
}

std::string to_text(const ProfilerReport& profile) {
    const Report& report = profile.report;
    std::string text;
    for (std::size_t r = 0; r < report.rows.size(); ++r) {
        const Row& row = report.rows[r];
        text += break_lines(fmt::format("{}, {}, N {}, {}{}\n", row.scene, row.strategy, row.spp, row.gpu,
                                        report.by == GroupBy::none ? "" : ", " + row.group),
                            text_width, 2);
        TextTable table;
        table.column("metric", TextTable::Align::left);
        table.column("value", TextTable::Align::right);
        for (const ProfilerMetric& metric : profile.metrics())
            table.row({metric.name, to_string(metric.of(profile.counts[r]), "-")});
        text += table.text() + '\n';
    }
    std::string legend =
        "Sums over all sample indices, of the simulated accesses alone: BVH traversal in software. l1tex counts every "
        "load instruction: a visit to an object is several, and their requests for a sector that an earlier one "
        "fetched hit. thread_inst_executed: of load and store instructions, the only ones there are. docs/counters.md "
        "has units and formulas.\n";
    if (report.has_wavefront())
        legend +=
            "Stores: L2 gets each distinct sector of an access once, not of each store instruction. dram__bytes also "
            "holds what sorting rays moves, which the trace does not split into reads and writes; no other name counts "
            "it.\n";
    if (has_time(profile)) legend += "Times are predicted, peaks those of the GPU file.\n";
    return text + break_lines(legend);
}

std::string to_json(const ProfilerReport& profile) {
    Json json{{"by", name_of(profile.report.by)}, {"rows", Json::array()}};
    for (std::size_t r = 0; r < profile.report.rows.size(); ++r) {
        Json& out = json["rows"].emplace_back(row_names(profile.report.rows[r]));
        for (const ProfilerMetric& metric : profile.metrics())
            out["metrics"].push_back({{"name", metric.name},
                                      {"value", json_of_metric(metric.of(profile.counts[r]))},
                                      {"unit", metric.unit}});
    }
    return dump(json);
}

std::string to_csv(const ProfilerReport& profile) {
    const std::vector<ProfilerMetric> metrics = profile.metrics();
    CsvLine titles;
    add_titles_of_names(titles);
    for (const ProfilerMetric& metric : metrics) titles.text(metric.name);
    std::string csv = titles.end();
    for (std::size_t r = 0; r < profile.report.rows.size(); ++r) {
        CsvLine line;
        add_names(line, profile.report.rows[r]);
        for (const ProfilerMetric& metric : metrics) line.text(field_of(metric.of(profile.counts[r])));
        csv += line.end();
    }
    return csv;
}

}  // namespace raycache::cachesim
