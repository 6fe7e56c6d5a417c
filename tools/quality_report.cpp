#include "tools/quality_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cachesim/report/table.hpp"

namespace raycache::tools {
namespace {

std::string decimals(double value, int digits) {
    return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-";
}
std::string digits(double value) { return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-"; }
std::string with_error(double value, double error, int places) {
    return std::isfinite(error) ? fmt::format("{} ±{}", decimals(value, places), decimals(error, places))
                                : decimals(value, places);
}

template <class Value>
bool differ(const std::vector<QualityRow>& rows, const Value& value) {
    return std::any_of(rows.begin(), rows.end(), [&](const QualityRow& r) { return value(r) != value(rows.front()); });
}

}  // namespace

std::string label(const QualityRow& row, const std::vector<QualityRow>& all) {
    std::string text = row.strategy().decorrelation;
    if (differ(all, [](const QualityRow& r) { return r.strategy().sequence; })) text += " " + row.strategy().sequence;
    if (differ(all, [](const QualityRow& r) { return r.spp(); })) text += fmt::format(" N={}", row.spp());
    if (row.strategy().parameters.mu && differ(all, [](const QualityRow& r) { return r.strategy().parameters.mu; }))
        text += fmt::format(" mu={:.4g}", *row.strategy().parameters.mu);
    return text;
}

void add_notes(QualityReport& report) {
    for (const QualityRow& row : report.rows)
        if (row.errors.reference_rmse > 0.5 * row.errors.rmse.value)
            report.notes.push_back(
                fmt::format("{}: its error {:.3g} is hardly above the reference's own {:.3g}; raise --reference-spp",
                            label(row, report.rows), row.errors.rmse.value, row.errors.reference_rmse));
}

std::string to_text(const QualityReport& report) {
    using Align = cachesim::TextTable::Align;
    const auto any = [&](const auto& has) { return std::any_of(report.rows.begin(), report.rows.end(), has); };
    const bool pairs = any([](const QualityRow& r) { return !r.pairs.empty(); });
    const bool equal_time = any([](const QualityRow& r) { return r.equal_time.has_value(); });
    const bool seeds = report.repeats > 1, timed = !report.gpu.empty(), ratios = !report.baseline.empty();
    cachesim::TextTable table;
    table.column("strategy", Align::left);
    const auto columns = [&](std::initializer_list<const char*> titles) {
        for (const char* title : titles) table.column(title, Align::right);
    };
    columns({"RMSE"});
    if (ratios) columns({"ratio"});
    columns({"rel. RMSE", "R8", "z"});
    if (seeds) columns({"z seeds"});
    columns({"mean error %", "worst block %"});
    if (pairs) columns({"worst pair"});
    if (timed) columns({"speed-up"});
    if (equal_time) columns({"N equal time", "RMSE there"});
    for (const QualityRow& row : report.rows) {
        const tracer::ErrorMeasures& e = row.errors;
        const double percent = 100 / e.reference_luminance;
        std::vector<std::string> cells{label(row, report.rows), digits(e.rmse.value)};
        if (ratios)
            cells.push_back(row.baseline ? decimals(e.rmse.value / report.rows[*row.baseline].errors.rmse.value, 3)
                                         : "-");
        cells.insert(cells.end(),
                     {digits(e.relative_rmse.value), with_error(e.r8.value, e.r8.error, 2), decimals(e.z_pixels, 1)});
        if (seeds) cells.push_back(e.z_seeds ? decimals(*e.z_seeds, 1) : "-");
        cells.push_back(with_error(percent * e.mean_error, percent * e.mean_error_deviation, 2));
        const auto worst_block = tracer::worst_block(e);
        cells.push_back(worst_block ? decimals(percent * worst_block->mean_error, 0) : "-");
        if (pairs) {
            const auto worst = row.worst_pair();
            cells.push_back(
                worst ? fmt::format("{},{}: {:.0f} %", 2 * worst->pair, 2 * worst->pair + 1, 100 * worst->share) : "-");
        }
        if (timed)
            cells.push_back(
                row.timing->speed_up
                    ? with_error(row.timing->speed_up->mean, row.timing->speed_up->half_width.value_or(std::nan("")), 3)
                    : (row.baseline && std::isfinite(row.timing->seconds) ? "1" : "-"));
        if (equal_time)
            cells.insert(cells.end(),
                         {fmt::format("{}", row.equal_time->spp), digits(row.equal_time->errors.rmse.value)});
        table.row(std::move(cells));
    }
    std::string text = table.text() + "\n";
    text += fmt::format("{}, {} x {} pixels, N {}, reference of {} samples per pixel (its RMSE {})", report.scene,
                        report.width, report.height,
                        differ(report.rows, [](const QualityRow& r) { return r.spp(); })
                            ? std::string("as shown")
                            : fmt::format("{}", report.rows.front().spp()),
                        report.reference_spp, digits(report.rows.front().errors.reference_rmse));
    if (seeds) text += fmt::format(", {} seeds", report.repeats);
    text += "\nR8: error shared by 8 x 8 pixels, 1 white noise, 64 structured; ±: standard error";
    if (ratios) text += "; ratio: RMSE over that of " + report.baseline;
    text +=
        "\nz: mean error over its standard error, pixels taken as independent; without bias and shared error about 1, "
        "at "
        "most 1.4";
    if (seeds) text += "\nz seeds: the same with the spread between seeds; without bias at most 1.4";
    text += "\nmean error, worst block: in % of the reference's mean luminance";
    if (pairs)
        text +=
            "\nworst pair: the dimensions without which most of the shared error goes, and how much of it (negative: "
            "none "
            "lowers it)";
    if (timed && any([](const QualityRow& r) { return r.timing && std::isfinite(r.timing->seconds); }))
        text += fmt::format("\nspeed-up: predicted for {}, ±: 95 % confidence", report.gpu);
    if (equal_time) text += "; N equal time: what fits into the baseline's time";
    text += "\n";
    for (const std::string& note : report.notes) text += "note: " + note + "\n";
    return text;
}

}  // namespace raycache::tools
