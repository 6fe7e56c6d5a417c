#include "cachesim/report/profile_comparison.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string_view>

#include "cachesim/report/csv_line.hpp"
#include "cachesim/report/json_parts.hpp"
#include "cachesim/report/table.hpp"
#include "traces/error.hpp"

namespace raycache::cachesim {

namespace {

constexpr const char* left_out =
    "Modelled: BVH traversal in software, by load instructions. Traversal in RT cores (OptiX, DXR, Vulkan) does not "
    "go through the counters of loads: l1tex then lacks it, and only kernels that traverse in software can be "
    "compared.";

/// Words of shaders that a ray-tracing pipeline calls: their traversal is the RT unit's.
bool is_pipeline(const std::string& kernel) {
    for (const char* word : {"__raygen__", "raygen", "optix", "Optix", "OptiX", "__closesthit__", "rayQuery"})
        if (kernel.find(word) != std::string::npos) return true;
    return false;
}

bool has_word(std::string_view words, std::string_view word) {
    for (std::size_t at = 0; at < words.size();) {
        const std::size_t end = std::min(words.find(' ', at), words.size());
        if (words.substr(at, end - at) == word) return true;
        at = end + 1;
    }
    return false;
}

/// How well a name fits: 0 not at all, 3 its own.
int fit(const ProfilerMetric& metric, const std::string& name) {
    if (name == metric.name) return 3;
    if (metric.label && name == metric.label) return 2;
    return has_word(metric.same_of_loads, name) ? 1 : 0;
}

/// What says nothing of memory: sizes of launches, attributes of the device.
bool is_no_counter(const std::string& name) {
    for (const char* unit : {"launch__", "device__", "profiler__", "numa__", "nvlink__"})
        if (name.starts_with(unit)) return true;
    return false;
}

/// The metrics of one launch by name, in plain units. What the tool leaves to its reader is divided here.
using Measured = std::map<std::string, double>;

class ProfileReading {
public:
    explicit ProfileReading(const NsightProfile& profile) : profile_(profile) {}

    Measured values_of(const MeasuredLaunch& launch) {
        Measured values;
        std::map<std::string, int> fits;
        for (const MeasuredMetric& measured : launch.metrics) {
            bool known = false;
            for (const ProfilerMetric& metric : profiler_metrics()) {
                const int how = fit(metric, measured.name);
                if (how == 0) continue;
                known = true;
                if (how <= fits[metric.name]) continue;
                const double value = measured_value(measured, metric.is_quotient() ? "%" : metric.unit, profile_.file);
                if (!std::isfinite(value)) continue;
                fits[metric.name] = how;
                values[metric.name] = value;
            }
            if (!known && !is_no_counter(measured.name)) unknown_.insert(measured.name);
        }
        divide(values, "L2 sectors per read request", "lts__t_sectors_srcunit_tex_op_read.sum",
               "lts__t_requests_srcunit_tex_op_read.sum");
        return values;
    }

    const std::set<std::string>& unknown() const { return unknown_; }

private:
    static void divide(Measured& values, const char* name, const char* part, const char* whole) {
        const auto x = values.find(part), y = values.find(whole);
        if (x != values.end() && y != values.end() && y->second > 0) values[name] = x->second / y->second;
    }

    const NsightProfile& profile_;
    std::set<std::string> unknown_;
};

double profile_difference(const ProfilerMetric& metric, double measured, double modelled) {
    if (metric.is_percentage()) return modelled - measured;
    if (measured == modelled) return 0;
    return measured > 0 ? modelled / measured - 1 : std::nan("");
}

void sum_up(ComparedMetric& compared) {
    double sum = 0;
    std::size_t count = 0;
    compared.worst.difference = std::nan("");
    for (const ComparedValue& value : compared.values) {
        if (!std::isfinite(value.difference)) continue;
        sum += std::fabs(value.difference);
        if (count++ == 0 || std::fabs(value.difference) > std::fabs(compared.worst.difference)) compared.worst = value;
    }
    compared.mean = count ? sum / static_cast<double>(count) : std::nan("");
}

/// Whole where it is a count.
std::string value_text(const ProfilerMetric& metric, double value) {
    if (!std::isfinite(value)) return "-";
    return metric.is_quotient() ? fmt::format("{:.2f}", value) : fmt::format("{:.0f}", value);
}

std::string list_text(const char* what, const std::vector<std::string>& names) {
    if (names.empty()) return "";
    constexpr std::size_t shown = 12;
    std::string text = fmt::format(
        "{}: {}", what,
        fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(std::min(shown, names.size())), ", "));
    if (names.size() > shown) text += fmt::format(" and {} more (--json has all)", names.size() - shown);
    return text + ".\n";
}

}  // namespace

std::string ComparedMetric::text_of(double difference, bool with_sign) const {
    if (!std::isfinite(difference)) return "-";
    const double shown = metric->is_percentage() ? difference : 100 * difference;
    const char* unit = metric->is_percentage() ? "points" : "%";
    return with_sign ? fmt::format("{:+.1f} {}", shown, unit) : fmt::format("{:.1f} {}", shown, unit);
}

ProfileComparison compare_with_profile(const ProfiledSeries& series, const NsightProfile& profile,
                                       const std::string& trace) {
    const std::size_t count = profile.launches.size();
    if (count > series.launches.size())
        throw Error(
            fmt::format("{}: {} launches; expected at most {}, as many as {} has; choose those of one kernel "
                        "with --kernel NAME",
                        profile.file, count, series.launches.size(), trace));
    ProfileComparison comparison;
    comparison.origin = series;
    std::vector<Measured> measured;
    ProfileReading reading(profile);
    std::vector<ProfilerReport> modelled;
    bool pipeline = false;
    for (std::size_t i = 0; i < count; ++i) {
        const MeasuredLaunch& launch = profile.launches[i];
        measured.push_back(reading.values_of(launch));
        modelled.push_back(make_profile(series, i));
        comparison.launches.push_back({launch.id, launch.kernel, series.launches[i].sample});
        pipeline = pipeline || is_pipeline(launch.kernel);
    }
    std::vector<std::string> with_time;
    for (const ProfilerMetric& metric : profiler_metrics()) {
        ComparedMetric compared{&metric, {}, 0, {}};
        bool known = false;
        for (std::size_t i = 0; i < count; ++i) {
            const auto value = measured[i].find(metric.name);
            if (value == measured[i].end()) continue;
            known = true;
            const double model = number_of(metric.of(modelled[i].counts.front()));
            if (std::isfinite(model))
                compared.values.push_back({i, value->second, model, profile_difference(metric, value->second, model)});
        }
        const bool needs_time = metric.need == MetricNeed::time || metric.need == MetricNeed::read_time;
        if (metric.need == MetricNeed::stores) {
            if (known) comparison.not_modelled.push_back(metric.name);
        } else if (needs_time && series.times.empty()) {
            if (known) with_time.push_back(metric.name);
        } else if (!known) {
            comparison.not_measured.push_back(metric.name);
        } else {
            sum_up(compared);
            comparison.metrics.push_back(std::move(compared));
        }
    }
    comparison.not_modelled.insert(comparison.not_modelled.end(), reading.unknown().begin(), reading.unknown().end());
    if (comparison.metrics.empty() && with_time.empty())
        throw Error(
            fmt::format("{}: none of its metrics is modelled; expected some of the metrics of docs/counters.md, "
                        "such as l1tex__t_sector_hit_rate.pct: collect them with 'ncu --metrics'",
                        profile.file));
    if (!with_time.empty())
        comparison.notes.push_back(fmt::format("Modelled with --timed only: {}.", fmt::join(with_time, ", ")));
    if (count < series.launches.size())
        comparison.notes.push_back(
            fmt::format("The profile has {} of the {} launches of the trace.", count, series.launches.size()));
    if (pipeline)
        comparison.notes.emplace_back(
            "A kernel's name is that of a ray-tracing pipeline, whose traversal is in RT cores: its l1tex counters "
            "lack the nodes and triangles that are modelled.");
    return comparison;
}

std::string to_text(const ProfileComparison& comparison) {
    const Origin& o = comparison.origin;
    std::string text = break_lines(
        fmt::format("{}, {}, N {}, {}: measured beside modelled\n", o.scene, o.strategy, o.spp, o.gpu), text_width, 2);
    for (const ComparedMetric& compared : comparison.metrics) {
        text += fmt::format("\n{}\n", compared.metric->name);
        TextTable table;
        table.column("launch", TextTable::Align::right);
        table.column("sample", TextTable::Align::right);
        table.column("measured", TextTable::Align::right);
        table.column("modelled", TextTable::Align::right);
        table.column("difference", TextTable::Align::right);
        for (const ComparedValue& v : compared.values)
            table.row({fmt::format("{}", v.launch), fmt::format("{}", comparison.launches[v.launch].sample),
                       value_text(*compared.metric, v.measured), value_text(*compared.metric, v.modelled),
                       compared.text_of(v.difference, true)});
        text += table.text();
        if (compared.values.size() > 1)
            text += fmt::format("mean difference {}, worst {} in launch {}\n", compared.text_of(compared.mean, false),
                                compared.text_of(compared.worst.difference, true), compared.worst.launch);
    }
    std::string words = "difference: modelled over measured less 1; of percentages modelled less measured.\n";
    words += list_text("Not measured", comparison.not_measured);
    words += list_text("Not modelled", comparison.not_modelled);
    for (const std::string& note : comparison.notes) words += note + '\n';
    words += std::string(left_out) + '\n';
    return text + '\n' + break_lines(words);
}

std::string to_json(const ProfileComparison& comparison) {
    Json json = names_of(comparison.origin);
    json["spp"] = comparison.origin.spp;
    json["launches"] = Json::array();
    for (const ComparedLaunch& launch : comparison.launches)
        json["launches"].push_back({{"id", launch.id}, {"kernel", launch.kernel}, {"sample", launch.sample}});
    json["metrics"] = Json::array();
    for (const ComparedMetric& compared : comparison.metrics) {
        Json values = Json::array();
        for (const ComparedValue& v : compared.values)
            values.push_back({{"launch", v.launch},
                              {"measured", json_of(v.measured)},
                              {"modelled", json_of(v.modelled)},
                              {"difference", json_of(v.difference)}});
        const bool any = std::isfinite(compared.mean);
        json["metrics"].push_back({{"name", compared.metric->name},
                                   {"unit", compared.metric->unit},
                                   {"difference_in", compared.metric->is_percentage() ? "points" : "share"},
                                   {"mean_difference", json_of(compared.mean)},
                                   {"worst_difference", json_of(compared.worst.difference)},
                                   {"worst_launch", any ? Json(compared.worst.launch) : Json(nullptr)},
                                   {"values", values}});
    }
    json["not_measured"] = comparison.not_measured;
    json["not_modelled"] = comparison.not_modelled;
    json["notes"] = comparison.notes;
    json["notes"].push_back(left_out);
    return dump(json);
}

std::string to_csv(const ProfileComparison& comparison) {
    CsvLine titles;
    for (const char* title :
         {"metric", "unit", "launch", "id", "kernel", "sample", "measured", "modelled", "difference"})
        titles.text(title);
    std::string csv = titles.end();
    for (const ComparedMetric& compared : comparison.metrics)
        for (const ComparedValue& v : compared.values) {
            const ComparedLaunch& launch = comparison.launches[v.launch];
            CsvLine line;
            line.text(compared.metric->name);
            line.text(compared.metric->unit);
            line.number(std::uint64_t{v.launch});
            line.text(launch.id);
            line.text(launch.kernel);
            line.number(std::uint64_t{launch.sample});
            line.number(v.measured);
            line.number(v.modelled);
            line.number(v.difference);
            csv += line.end();
        }
    return csv;
}

}  // namespace raycache::cachesim
