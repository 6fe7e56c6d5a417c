#include "tools/jobs/quality_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cachesim/report/format.hpp"
#include "cachesim/report/table.hpp"

namespace raycache::tools {
namespace {

using cachesim::decimals;

std::string digits(double value) { return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-"; }

tracer::Measured times(tracer::Measured m, double factor) {
    m.value *= factor;
    m.half_width *= factor;
    return m;
}

/// The ratio as short as a cell is; the notes say more.
std::string ratio_cell(const QualityRow& row) {
    if (!row.ratio) return "-";
    if (row.ratio->decided_by_pixels) return fmt::format("by {} px", *row.ratio->decided_by_pixels);
    if (row.ratio->value.half_width == 0) return decimals(row.ratio->value.value, 3);
    return tracer::measured_text(row.ratio->value, 3);
}

std::string robust_cell(const QualityRow& row, bool ratios) {
    if (!ratios) return tracer::measured_text(row.errors.robust_rmse, 4, true);
    return row.ratio ? tracer::measured_text(row.ratio->robust, 3) : "-";
}

std::string speed_up_cell(const QualityRow& row) {
    const auto& up = row.timing->speed_up;
    if (!up) return row.baseline && std::isfinite(row.timing->seconds) ? "1" : "-";
    return tracer::measured_text({up->mean, up->half_width.value_or(std::nan("")), {}, {}, 0}, 3);
}

/// Of the rows, the names of those that some row is held against at equal error, in the order of the registry.
std::vector<std::string> equal_error_columns(const std::vector<QualityRow>& rows) {
    std::vector<std::string> names;
    for (const QualityRow& row : rows)
        for (const EqualError& against : row.equal_error) {
            const std::string& name = rows[against.baseline].strategy().decorrelation;
            if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
        }
    return names;
}

std::string equal_error_cell(const QualityRow& row, const std::vector<QualityRow>& rows, const std::string& name) {
    for (const EqualError& against : row.equal_error) {
        if (rows[against.baseline].strategy().decorrelation != name) continue;
        if (!row.no_equal_error.empty()) return "none";
        if (!std::isfinite(against.gain.mean)) return "-";
        return tracer::measured_text({against.gain.mean, against.gain.half_width.value_or(std::nan("")), {}, {}, 0}, 3);
    }
    return row.strategy().decorrelation == name ? "1" : "-";
}

/// "1.27 x cranley-patterson's": what its RMSE alone would say.
std::string gains_by_rmse(const QualityRow& row, const std::vector<QualityRow>& rows) {
    std::string text;
    for (const EqualError& against : row.equal_error)
        if (std::isfinite(against.gain.mean))
            text += fmt::format("{}{:.3f} x {}", text.empty() ? "" : ", ", against.gain.mean,
                                rows[against.baseline].strategy().decorrelation);
    return text.empty() ? text : "; by its RMSE alone " + text;
}

template <class Value>
bool differ(const std::vector<QualityRow>& rows, const Value& value) {
    return std::any_of(rows.begin(), rows.end(), [&](const QualityRow& r) { return value(r) != value(rows.front()); });
}

/// Strategies without bias whatever a test says.
std::string independent_labels(const std::vector<QualityRow>& rows) {
    std::string names;
    for (const QualityRow& row : rows) {
        const std::string& name = row.strategy().decorrelation;
        if (!tracer::find_decorrelation(name).independent_pixels || names.find(name) != std::string::npos) continue;
        names += (names.empty() ? "" : ", ") + name;
    }
    return names;
}

}  // namespace

std::string label(const QualityRow& row, const std::vector<QualityRow>& all) {
    std::string text = row.strategy().decorrelation;
    if (differ(all, [](const QualityRow& r) { return r.strategy().sequence; })) text += " " + row.strategy().sequence;
    if (differ(all, [](const QualityRow& r) { return r.spp(); })) text += fmt::format(" N={}", row.spp());
    if (row.strategy().parameters.has("mu") &&
        differ(all, [](const QualityRow& r) { return r.strategy().parameters.number("mu"); }))
        text += fmt::format(" mu={:.4g}", *row.strategy().parameters.number("mu"));
    const tracer::DecorrelationEntry& entry = tracer::find_decorrelation(row.strategy().decorrelation);
    for (const tracer::ParameterEntry& parameter : entry.parameters) {
        const std::string name = parameter.name;
        if (name == "mu" || !entry.reads_parameter(name, row.strategy().parameters)) continue;
        const auto other = [&](const QualityRow& r) {
            return r.strategy().decorrelation == entry.name &&
                   r.strategy().parameters.text(name) != row.strategy().parameters.text(name);
        };
        if (std::any_of(all.begin(), all.end(), other))
            text += fmt::format(" {}={}", name, row.strategy().parameters.text(name));
    }
    if (differ(all, [](const QualityRow& r) { return r.settings.thread_map; }))
        text += std::string("@") + to_string(row.settings.thread_map);
    return text;
}

void add_notes(QualityReport& report) {
    const auto note = [&](const std::string& text) {
        if (std::find(report.notes.begin(), report.notes.end(), text) == report.notes.end())
            report.notes.push_back(text);
    };
    const auto raise = [&] { return fmt::format("raise --reference-spp above {}", report.reference_spp); };
    for (const QualityRow& row : report.rows) {
        const tracer::ErrorMeasures& e = row.errors;
        const std::string name = label(row, report.rows);
        if (e.rmse.below)
            note(
                fmt::format("{}: its RMSE is below the reference's noise, less than {:.2g}; {} (four times as many "
                            "samples halve the bound)",
                            name, *e.rmse.below, raise()));
        else if (e.rmse.resolved() && e.rmse.reference_share > 0.5)
            note(fmt::format("{}: most of the ± of its RMSE is the reference's own noise (RMSE {:.3g}); {}", name,
                             e.reference_rmse, raise()));
        if (e.r8.below)
            note(fmt::format("{}: what 8 x 8 pixels share is below the reference's noise; {}", name, raise()));
        if (e.few_pixels)
            note(fmt::format("{}: {} pixel{} hold{} {:.0f} % of its squared error, most at {},{}", name,
                             e.few_pixels->count, e.few_pixels->count == 1 ? "" : "s",
                             e.few_pixels->count == 1 ? "s" : "", 100 * e.few_pixels->share,
                             e.few_pixels->largest % report.width, e.few_pixels->largest / report.width));
        if (row.ratio && row.ratio->decided_by_pixels)
            note(fmt::format("{}: its RMSE against {}'s is {}: no ranking; use --clamp, or the robust error", name,
                             report.baseline, tracer::ratio_text(*row.ratio)));
        if (!row.no_equal_error.empty() && !row.equal_error.empty())
            note(fmt::format("{}: no time to an equal error: {}{}", name, row.no_equal_error,
                             gains_by_rmse(row, report.rows)));
        if (row.ratio && row.ratio->baseline_is_zero) note(fmt::format("ratio {}", tracer::ratio_text(*row.ratio)));
        if (row.strategy().decorrelation == "scrambling-distance" && !row.strategy().parameters.has("mu"))
            note(
                "scrambling-distance is Blender's automatic distance with the pattern Tabulated Sobol; a default "
                "Blender has blue noise, where it is off");
    }
}

std::string to_text(const QualityReport& report, std::size_t width) {
    using Align = cachesim::TextTable::Align;
    const auto any = [&](const auto& has) { return std::any_of(report.rows.begin(), report.rows.end(), has); };
    const bool pairs = any([](const QualityRow& r) { return !r.pairs.empty(); });
    const bool equal_time = any([](const QualityRow& r) { return r.equal_time.has_value(); });
    const bool seeds = report.repeats > 1, timed = !report.gpu.empty(), ratios = !report.baseline.empty();
    cachesim::TextTable table;
    table.column("strategy", Align::left);
    const auto column = [&](const char* title, unsigned rank = 0) { table.column(title, Align::right, rank); };
    column("RMSE");
    if (ratios) column("ratio");
    column("robust", 2);
    column("R8");
    column("z", 4);
    if (seeds) column("z seeds", 3);
    column("mean error %", 5);
    column("worst 8x8 %", 6);
    if (pairs) column("worst pair", 1);
    if (timed) column("speed-up");
    const std::vector<std::string> equal_error = equal_error_columns(report.rows);
    for (const std::string& name : equal_error) column(("equal error " + name).c_str(), 1);
    if (equal_time) {
        column("N equal time", 1);
        column("RMSE there", 1);
    }
    for (const QualityRow& row : report.rows) {
        const tracer::ErrorMeasures& e = row.errors;
        const double percent = 100 / e.reference_luminance;
        std::vector<std::string> cells{label(row, report.rows), tracer::measured_text(e.rmse, 4, true)};
        if (ratios) cells.push_back(ratio_cell(row));
        cells.insert(cells.end(), {robust_cell(row, ratios), tracer::measured_text(e.r8, 2), decimals(e.z_pixels, 1)});
        if (seeds) cells.push_back(e.z_seeds ? decimals(*e.z_seeds, 1) : "-");
        cells.push_back(std::isfinite(percent) ? tracer::measured_text(times(e.mean_error, percent), 2) : "-");
        const auto worst_block = tracer::worst_block(e);
        cells.push_back(worst_block ? decimals(percent * worst_block->mean_error, 0) : "-");
        if (pairs) {
            const auto worst = row.worst_pair();
            cells.push_back(
                worst ? fmt::format("{},{}: {:.0f} %", 2 * worst->pair, 2 * worst->pair + 1, 100 * worst->share) : "-");
        }
        if (timed) cells.push_back(speed_up_cell(row));
        for (const std::string& name : equal_error) cells.push_back(equal_error_cell(row, report.rows, name));
        if (equal_time)
            cells.insert(cells.end(), {fmt::format("{}", row.equal_time->spp),
                                       tracer::measured_text(row.equal_time->errors.rmse, 4, true)});
        table.row(std::move(cells));
    }
    std::string text = fmt::format("{}, {} x {} pixels, N {}, reference of {} samples per pixel (its RMSE {})",
                                   report.scene, report.width, report.height,
                                   differ(report.rows, [](const QualityRow& r) { return r.spp(); })
                                       ? std::string("as shown")
                                       : fmt::format("{}", report.rows.front().spp()),
                                   report.reference_spp, digits(report.rows.front().errors.reference_rmse));
    if (seeds) text += fmt::format(", {} seeds", report.repeats);
    if (report.clamp) text += fmt::format(", samples clamped to {}", *report.clamp);
    text += "\n±: 95 % confidence, <: below the reference's noise";
    if (ratios) text += "; ratio: RMSE over that of " + report.baseline;
    text += fmt::format(
        "\nrobust: {}, which no dozen of pixels decides",
        ratios ? "the same ratio of roots of the median of means" : "root of the median of 25 means of squared error");
    text += "\nR8: error shared by 8 x 8 pixels, 1 white noise, 64 structured";
    text +=
        "\nz: mean error over its standard error, pixels taken as independent; without bias and shared error about "
        "1, at most 1.4";
    if (const std::string unbiased = independent_labels(report.rows); !unbiased.empty())
        text += fmt::format("\n   ({}: no bias by construction; above 1.4 is the test's own noise)", unbiased);
    if (seeds) text += "\nz seeds: the same with the spread between seeds; without bias at most 1.4";
    text += "\nmean error, worst 8x8 (block): in % of the reference's mean luminance";
    if (pairs)
        text +=
            "\nworst pair: the dimensions without which most of the shared error goes, and how much of it (negative: "
            "none "
            "lowers it)";
    if (timed && any([](const QualityRow& r) { return r.timing && std::isfinite(r.timing->seconds); }))
        text += fmt::format("\nspeed-up: predicted for {}{}", report.gpu,
                            report.time_resolution.empty() ? "" : " at " + report.time_resolution);
    if (!equal_error.empty())
        text += fmt::format(
            "\nequal error NAME: predicted time of NAME to the same RMSE over the row's: speed-up over it / RMSE ratio "
            "to it^2; none: R8 above {} or bias (z above {}), so the error does not fall with N",
            most_shared_error, most_bias);
    if (equal_time) text += "; N equal time: what fits into the baseline's time";
    text += "\n";
    for (const std::string& note : report.notes) text += "note: " + note + "\n";
    return table.text(width) + "\n" + cachesim::break_lines(text, cachesim::text_width, 2);
}

}  // namespace raycache::tools
