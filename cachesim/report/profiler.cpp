#include "cachesim/report/profiler.hpp"

#include <fmt/format.h>

#include <cmath>
#include <variant>

#include "cachesim/report/csv_field.hpp"
#include "cachesim/report/json_parts.hpp"
#include "cachesim/report/table.hpp"

namespace raycache::cachesim {

namespace {

/// A count, or a quotient: NaN where nothing was counted.
using Value = std::variant<std::uint64_t, double>;

Value quotient(std::uint64_t part, std::uint64_t whole, double scale = 1) {
    return whole > 0 ? scale * static_cast<double>(part) / static_cast<double>(whole) : std::nan("");
}

/// A metric of Nsight Compute, and what it is here.
struct Metric {
    const char* name;
    Value (*value)(const Row&);
};

constexpr Metric of_loads[] = {
    {"l1tex__t_sectors_pipe_lsu_mem_global_op_ld.sum", [](const Row& r) -> Value { return r.loads.l1_requests; }},
    {"l1tex__t_sector_pipe_lsu_mem_global_op_ld_hit_rate.pct",
     [](const Row& r) { return quotient(r.loads.l1_request_hits(), r.loads.l1_requests, 100); }},
    {"l1tex__average_t_sectors_per_request_pipe_lsu_mem_global_op_ld.ratio",
     [](const Row& r) { return quotient(r.loads.l1_requests, r.loads.loads); }},
    {"l1tex__m_xbar2l1tex_read_sectors_mem_lg_op_ld.sum", [](const Row& r) -> Value { return r.loads.l2_sectors; }},
    {"lts__t_sectors_srcunit_tex_op_read_lookup_hit.sum", [](const Row& r) -> Value { return r.loads.l2_hits; }},
    {"lts__t_sectors_srcunit_tex_op_read_lookup_miss.sum",
     [](const Row& r) -> Value { return r.loads.l2_sectors - r.loads.l2_hits; }},
    {"lts__t_sector_op_read_hit_rate.pct",
     [](const Row& r) { return quotient(r.loads.l2_hits, r.loads.l2_sectors, 100); }},
    {"dram__bytes_read.sum", [](const Row& r) -> Value { return r.loads.dram_sectors * r.sector_bytes; }},
    {"smsp__thread_inst_executed_per_inst_executed.ratio",
     [](const Row& r) {
         return quotient(r.loads.lane_accesses + r.stores.lane_accesses,
                         r.loads.warp_accesses + r.stores.warp_accesses);
     }},
};

/// Shown where some trace is of a wavefront. None is of hits: a written sector is in L2 afterwards, whatever was there.
constexpr Metric of_stores[] = {
    {"l1tex__t_sectors_pipe_lsu_mem_global_op_st.sum", [](const Row& r) -> Value { return r.stores.l1_requests; }},
    {"l1tex__average_t_sectors_per_request_pipe_lsu_mem_global_op_st.ratio",
     [](const Row& r) { return quotient(r.stores.l1_requests, r.stores.loads); }},
    {"l1tex__m_l1tex2xbar_write_sectors_mem_lg_op_st.sum", [](const Row& r) -> Value { return r.stores.l2_sectors; }},
    {"lts__t_sectors_op_write.sum", [](const Row& r) -> Value { return r.stores.l2_sectors; }},
    {"dram__bytes_write.sum", [](const Row& r) -> Value { return r.stores.dram_sectors * r.sector_bytes; }},
    {"dram__bytes.sum", [](const Row& r) -> Value { return r.totals.dram_sectors * r.sector_bytes; }},
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
    std::string csv = "scene,strategy,sequence,parameters,thread_map,gpu,group,spp,samples";
    for (const Metric& metric : metrics) csv += fmt::format(",{}", metric.name);
    csv += '\n';
    for (const Row& row : profile.report.rows) {
        for (const auto* name :
             {&row.scene, &row.strategy, &row.sequence, &row.parameters, &row.thread_map, &row.gpu, &row.group})
            csv += csv_field(*name) + ',';
        csv += fmt::format("{},{}", row.spp, fmt::join(row.samples, " "));
        for (const Metric& metric : metrics) csv += ',' + to_string(metric.value(row), -1, "");
        csv += '\n';
    }
    return csv;
}

}  // namespace raycache::cachesim
