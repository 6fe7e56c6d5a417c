#include "cachesim/report/profiler.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <variant>

#include "cachesim/report/csv_line.hpp"
#include "cachesim/report/json_parts.hpp"
#include "cachesim/report/table.hpp"

namespace raycache::cachesim {

namespace {

/// A count, or a quotient: NaN where nothing was counted.
using Value = std::variant<std::uint64_t, double>;

/// Whose accesses a metric counts. Sorts are neither loads nor stores.
Counters loads(const Row& row) { return row.loads; }
Counters stores(const Row& row) { return row.stores; }
Counters loads_and_stores(const Row& row) {
    Counters both = row.loads;
    return both += row.stores;
}
Counters totals(const Row& row) { return row.totals; }

/// A metric of Nsight Compute, and what it is here.
struct Metric {
    const char* name;
    Counters (*of)(const Row&);
    Count numerator;
    std::optional<Count> denominator{};
    double scale = 1;  ///< of a quotient

    Value value(const Row& row) const {
        const Counters counted = of(row);
        const std::uint64_t part = numerator(counted, row.caches);
        if (!denominator) return part;
        const std::uint64_t whole = (*denominator)(counted, row.caches);
        return whole > 0 ? scale * static_cast<double>(part) / static_cast<double>(whole) : std::nan("");
    }
};

constexpr Count l2_misses{"l2_misses",
                          [](const Counters& c, const CacheUnits&) { return c.levels[1].sectors - c.levels[1].hits; }};

constexpr Metric of_loads[] = {
    {"l1tex__t_sectors_pipe_lsu_mem_global_op_ld.sum", loads, counts::requests},
    {"l1tex__t_sector_pipe_lsu_mem_global_op_ld_hit_rate.pct", loads, counts::request_hits, counts::requests, 100},
    {"l1tex__average_t_sectors_per_request_pipe_lsu_mem_global_op_ld.ratio", loads, counts::requests, counts::loads},
    {"l1tex__m_xbar2l1tex_read_sectors_mem_lg_op_ld.sum", loads, counts::asked<1>},
    {"lts__t_sectors_srcunit_tex_op_read_lookup_hit.sum", loads, counts::hits<1>},
    {"lts__t_sectors_srcunit_tex_op_read_lookup_miss.sum", loads, l2_misses},
    {"lts__t_sector_op_read_hit_rate.pct", loads, counts::hits<1>, counts::asked<1>, 100},
    {"dram__bytes_read.sum", loads, counts::dram_bytes},
    {"smsp__thread_inst_executed_per_inst_executed.ratio", loads_and_stores, counts::lane_accesses,
     counts::warp_accesses},
};

/// Shown where some trace is of a wavefront. None is of hits: a written sector is in L2 afterwards, whatever was there.
constexpr Metric of_stores[] = {
    {"l1tex__t_sectors_pipe_lsu_mem_global_op_st.sum", stores, counts::requests},
    {"l1tex__average_t_sectors_per_request_pipe_lsu_mem_global_op_st.ratio", stores, counts::requests, counts::loads},
    {"l1tex__m_l1tex2xbar_write_sectors_mem_lg_op_st.sum", stores, counts::asked<1>},
    {"lts__t_sectors_op_write.sum", stores, counts::asked<1>},
    {"dram__bytes_write.sum", stores, counts::dram_bytes},
    {"dram__bytes.sum", totals, counts::dram_bytes},
};

std::vector<Metric> metrics_of(const Report& report) {
    std::vector<Metric> metrics(std::begin(of_loads), std::end(of_loads));
    if (report.has_wavefront()) metrics.insert(metrics.end(), std::begin(of_stores), std::end(of_stores));
    return metrics;
}

/// `none` where there is no value; -1 digits: the shortest that read back as the same number.
std::string to_string(const Value& value, int digits, const char* none) {
    if (const auto* count = std::get_if<std::uint64_t>(&value)) return fmt::format("{}", *count);
    const double number = std::get<double>(value);
    if (!std::isfinite(number)) return none;
    return digits < 0 ? fmt::format("{}", number) : fmt::format("{:.{}f}", number, digits);
}

Json to_json(const Value& value) {
    if (const auto* count = std::get_if<std::uint64_t>(&value)) return *count;
    return json_of(std::get<double>(value));
}

}  // namespace

std::string to_text(const ProfilerReport& profile) {
    const Report& report = profile.report;
    std::string text;
    for (const Row& row : report.rows) {
        text += break_lines(fmt::format("{}, {}, N {}, {}{}\n", row.scene, row.strategy, row.spp, row.gpu,
                                        report.by == GroupBy::none ? "" : ", " + row.group),
                            text_width, 2);
        TextTable table;
        table.column("metric", TextTable::Align::left);
        table.column("value", TextTable::Align::right);
        for (const Metric& metric : metrics_of(report)) table.row({metric.name, to_string(metric.value(row), 2, "-")});
        text += table.text() + '\n';
    }
    std::string legend =
        "Sums over all sample indices, of the simulated accesses alone. l1tex counts every load instruction: a visit "
        "to an object is several, and their requests for a sector that an earlier one fetched hit. "
        "thread_inst_executed: active lanes per access.\n";
    if (report.has_wavefront())
        legend +=
            "Stores: L2 gets each distinct sector of an access once, not of each store instruction. dram__bytes also "
            "holds what sorting rays moves, which the trace does not split into reads and writes; no other name counts "
            "it.\n";
    return text + break_lines(legend);
}

std::string to_json(const ProfilerReport& profile) {
    Json json{{"by", name_of(profile.report.by)}, {"rows", Json::array()}};
    for (const Row& row : profile.report.rows) {
        Json& out = json["rows"].emplace_back(row_names(row));
        for (const Metric& metric : metrics_of(profile.report))
            out["metrics"].push_back({{"name", metric.name}, {"value", to_json(metric.value(row))}});
    }
    return dump(json);
}

std::string to_csv(const ProfilerReport& profile) {
    const std::vector<Metric> metrics = metrics_of(profile.report);
    CsvLine titles;
    add_titles_of_names(titles);
    for (const Metric& metric : metrics) titles.text(metric.name);
    std::string csv = titles.end();
    for (const Row& row : profile.report.rows) {
        CsvLine line;
        add_names(line, row);
        for (const Metric& metric : metrics) line.text(to_string(metric.value(row), -1, ""));
        csv += line.end();
    }
    return csv;
}

}  // namespace raycache::cachesim
