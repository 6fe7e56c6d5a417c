#include <fmt/format.h>

#include "cachesim/report/report.hpp"
#include "cachesim/report/table.hpp"

namespace raycache::cachesim {

namespace {

using Align = TextTable::Align;

std::string count(std::uint64_t value) { return fmt::format("{}", value); }

/// With so many decimals; "-" where nothing was counted.
std::string quotient(double part, double whole, int digits) {
    return whole > 0 ? fmt::format("{:.{}f}", part / whole, digits) : "-";
}
std::string quotient(std::uint64_t part, std::uint64_t whole, int digits, double scale = 1) {
    return quotient(scale * static_cast<double>(part), static_cast<double>(whole), digits);
}

/// A metric of Nsight Compute, and what it is here.
struct Metric {
    const char* name;
    std::string (*value)(const Row&);
};

constexpr Metric metrics[] = {
    {"l1tex__t_sectors_pipe_lsu_mem_global_op_ld.sum", [](const Row& r) { return count(r.totals.l1_requests); }},
    {"l1tex__t_sector_hit_rate.pct",
     [](const Row& r) { return quotient(r.totals.l1_request_hits(), r.totals.l1_requests, 2, 100); }},
    {"l1tex__average_t_sectors_per_request_pipe_lsu_mem_global_op_ld.ratio",
     [](const Row& r) { return quotient(r.totals.l1_requests, r.totals.loads, 2); }},
    {"l1tex__m_xbar2l1tex_read_sectors_mem_lg_op_ld.sum", [](const Row& r) { return count(r.totals.l2_sectors); }},
    {"lts__t_sectors_srcunit_tex_lookup_hit.sum", [](const Row& r) { return count(r.totals.l2_hits); }},
    {"lts__t_sectors_srcunit_tex_lookup_miss.sum",
     [](const Row& r) { return count(r.totals.l2_sectors - r.totals.l2_hits); }},
    {"lts__t_sector_hit_rate.pct",
     [](const Row& r) { return quotient(r.totals.l2_hits, r.totals.l2_sectors, 2, 100); }},
    {"dram__bytes_read.sum", [](const Row& r) { return count(r.totals.dram_sectors * r.sector_bytes); }},
    {"smsp__thread_inst_executed_per_inst_executed.ratio",
     [](const Row& r) { return quotient(r.totals.lane_accesses, r.totals.warp_accesses, 2); }},
};

}  // namespace

std::string to_profiler_text(const Report& report) {
    std::string text;
    for (const Row& row : report.rows) {
        TextTable table;
        table.column(fmt::format("{}, {}, N {}, {}{}", row.scene, row.strategy, row.spp, row.gpu,
                                 report.by == GroupBy::none ? "" : ", " + row.group),
                     Align::left);
        table.column("value", Align::right);
        for (const Metric& metric : metrics) table.row({metric.name, metric.value(row)});
        text += table.text() + '\n';
    }
    return text +
           "Sums over all sample indices, of the simulated loads alone. l1tex counts every load instruction: a visit "
           "to "
           "an object\nis several, and their requests for a sector that an earlier one fetched hit. "
           "thread_inst_executed: "
           "active lanes per access.\n";
}

}  // namespace raycache::cachesim
