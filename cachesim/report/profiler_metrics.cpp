#include "cachesim/report/profiler_metrics.hpp"

#include <cmath>
#include <string_view>

namespace raycache::cachesim {

namespace {

using Counts = const ProfileCounts&;
using Need = MetricNeed;

MetricValue counts_ratio(std::uint64_t part, std::uint64_t whole, double scale = 1) {
    return whole > 0 ? scale * static_cast<double>(part) / static_cast<double>(whole) : std::nan("");
}

std::uint64_t bytes_moved(Counts c, std::uint64_t sectors) { return sectors * c.caches.sector_bytes; }

std::uint64_t l2_misses(Counts c) { return c.loads.levels[1].sectors - c.loads.levels[1].hits; }

/// Bytes a second of the predicted time.
MetricValue moved_per_second(Counts c, std::uint64_t sectors) {
    if (!c.time || !(c.time->seconds > 0)) return std::nan("");
    return static_cast<double>(bytes_moved(c, sectors)) / c.time->seconds;
}

MetricValue use_of(Counts c, TimedStatistics::Resource TimedStatistics::*member) {
    if (!c.time || c.time->cycles == 0) return std::nan("");
    const TimedStatistics::Resource& resource = (*c.time).*member;
    return 100 * resource.busy / (static_cast<double>(resource.copies) * static_cast<double>(c.time->cycles));
}

constexpr ProfilerMetric all_metrics[] = {
    {"l1tex__t_requests_pipe_lsu_mem_global_op_ld.sum", "request", "`loads`", Need::nothing,
     [](Counts c) -> MetricValue { return c.loads.loads; }},
    {"l1tex__t_sectors_pipe_lsu_mem_global_op_ld.sum", "sector", "`l1_requests`", Need::nothing,
     [](Counts c) -> MetricValue { return c.loads.requests; }},
    {"l1tex__average_t_sectors_per_request_pipe_lsu_mem_global_op_ld.ratio", "sector/request",
     "`l1_requests` / `loads`", Need::nothing, [](Counts c) { return counts_ratio(c.loads.requests, c.loads.loads); }},
    {"l1tex__t_sectors_pipe_lsu_mem_global_op_ld_lookup_hit.sum", "sector", "`l1_hits`", Need::nothing,
     [](Counts c) -> MetricValue { return c.loads.request_hits(); }},
    {"l1tex__t_sectors_pipe_lsu_mem_global_op_ld_lookup_miss.sum", "sector", "`l1_requests` - `l1_hits`", Need::nothing,
     [](Counts c) -> MetricValue { return c.loads.requests - c.loads.request_hits(); }},
    {"l1tex__t_sector_pipe_lsu_mem_global_op_ld_hit_rate.pct", "%", "100 `l1_hits` / `l1_requests`", Need::nothing,
     [](Counts c) { return counts_ratio(c.loads.request_hits(), c.loads.requests, 100); }},
    {"l1tex__t_sector_hit_rate.pct", "%", "100 `l1_hits` / `l1_requests`, those of stores, which miss, included",
     Need::nothing,
     [](Counts c) { return counts_ratio(c.loads.request_hits(), c.loads.requests + c.stores.requests, 100); },
     "L1/TEX Hit Rate"},
    {"l1tex__m_xbar2l1tex_read_sectors_mem_lg_op_ld.sum", "sector", "`l2_sectors`", Need::nothing,
     [](Counts c) -> MetricValue { return c.loads.levels[1].sectors; }},
    {"lts__t_requests_srcunit_tex_op_read.sum", "request",
     "lines of which a load is the first of its visit to miss some sector", Need::nothing,
     [](Counts c) -> MetricValue { return c.load_instructions.requests; }, nullptr, "lts__t_requests_srcunit_tex.sum"},
    {"lts__t_sectors_srcunit_tex_op_read.sum", "sector", "`l2_sectors`", Need::nothing,
     [](Counts c) -> MetricValue { return c.loads.levels[1].sectors; }, nullptr, "lts__t_sectors_srcunit_tex.sum"},
    {"L2 sectors per read request", "sector/request",
     "lts__t_sectors_srcunit_tex_op_read.sum / lts__t_requests_srcunit_tex_op_read.sum", Need::nothing,
     [](Counts c) { return counts_ratio(c.loads.levels[1].sectors, c.load_instructions.requests); }},
    {"lts__t_sectors_srcunit_tex_op_read_lookup_hit.sum", "sector", "`l2_hits`", Need::nothing,
     [](Counts c) -> MetricValue { return c.loads.levels[1].hits; }, nullptr,
     "lts__t_sectors_srcunit_tex_lookup_hit.sum"},
    {"lts__t_sectors_srcunit_tex_op_read_lookup_miss.sum", "sector", "`l2_sectors` - `l2_hits`", Need::nothing,
     [](Counts c) -> MetricValue { return l2_misses(c); }, nullptr, "lts__t_sectors_srcunit_tex_lookup_miss.sum"},
    {"lts__t_sector_op_read_hit_rate.pct", "%", "100 `l2_hits` / `l2_sectors`", Need::nothing,
     [](Counts c) { return counts_ratio(c.loads.levels[1].hits, c.loads.levels[1].sectors, 100); }},
    {"lts__t_sector_hit_rate.pct", "%", "100 `l2_hits` / `l2_sectors`", Need::no_stores,
     [](Counts c) { return counts_ratio(c.loads.levels[1].hits, c.loads.levels[1].sectors, 100); }, "L2 Hit Rate"},
    {"dram__sectors_read.sum", "sector", "`dram_sectors` of loads", Need::nothing,
     [](Counts c) -> MetricValue { return c.loads.dram_sectors; }},
    {"dram__bytes_read.sum", "byte", "32 `dram_sectors` of loads", Need::nothing,
     [](Counts c) -> MetricValue { return bytes_moved(c, c.loads.dram_sectors); }},
    {"smsp__thread_inst_executed_per_inst_executed.ratio", "thread",
     "active lanes of load and store instructions / these instructions", Need::nothing,
     [](Counts c) {
         return counts_ratio(c.load_instructions.lane_accesses + c.store_instructions.lane_accesses,
                             c.load_instructions.warp_accesses + c.store_instructions.warp_accesses);
     },
     "Avg. Active Threads Per Warp"},

    // No rate of hits: a written sector is in L2 afterwards, whatever was there.
    {"l1tex__t_requests_pipe_lsu_mem_global_op_st.sum", "request", "store instructions", Need::stores,
     [](Counts c) -> MetricValue { return c.stores.loads; }},
    {"l1tex__t_sectors_pipe_lsu_mem_global_op_st.sum", "sector", "`l1_requests` of stores", Need::stores,
     [](Counts c) -> MetricValue { return c.stores.requests; }},
    {"l1tex__average_t_sectors_per_request_pipe_lsu_mem_global_op_st.ratio", "sector/request",
     "`l1_requests` of stores / store instructions", Need::stores,
     [](Counts c) { return counts_ratio(c.stores.requests, c.stores.loads); }},
    {"l1tex__m_l1tex2xbar_write_sectors_mem_lg_op_st.sum", "sector", "`l2_sectors` of stores", Need::stores,
     [](Counts c) -> MetricValue { return c.stores.levels[1].sectors; }},
    {"lts__t_requests_srcunit_tex_op_write.sum", "request",
     "lines of which a store is the first of its visit to write some sector", Need::stores,
     [](Counts c) -> MetricValue { return c.store_instructions.requests; }},
    {"lts__t_sectors_srcunit_tex_op_write.sum", "sector", "`l2_sectors` of stores", Need::stores,
     [](Counts c) -> MetricValue { return c.stores.levels[1].sectors; }},
    {"L2 sectors per write request", "sector/request",
     "lts__t_sectors_srcunit_tex_op_write.sum / lts__t_requests_srcunit_tex_op_write.sum", Need::stores,
     [](Counts c) { return counts_ratio(c.stores.levels[1].sectors, c.store_instructions.requests); }},
    {"lts__t_sectors_op_write.sum", "sector", "`l2_sectors` of stores", Need::stores,
     [](Counts c) -> MetricValue { return c.stores.levels[1].sectors; }},
    {"dram__sectors_write.sum", "sector", "`written_sectors`", Need::stores,
     [](Counts c) -> MetricValue { return c.stores.dram_sectors; }},
    {"dram__bytes_write.sum", "byte", "32 `written_sectors`", Need::stores,
     [](Counts c) -> MetricValue { return bytes_moved(c, c.stores.dram_sectors); }},
    {"dram__bytes.sum", "byte", "32 `dram_sectors`", Need::stores,
     [](Counts c) -> MetricValue { return bytes_moved(c, c.totals.dram_sectors); }},

    {"gpu__time_duration.sum", "nsecond", "1e9 `seconds`", Need::time,
     [](Counts c) -> MetricValue { return c.time ? c.time->seconds * 1e9 : std::nan(""); }, "Duration"},
    {"gpc__cycles_elapsed.max", "cycle", "`cycles`", Need::time,
     [](Counts c) -> MetricValue { return c.time ? MetricValue(c.time->cycles) : std::nan(""); }, "Elapsed Cycles"},
    {"l1tex__throughput.avg.pct_of_peak_sustained_elapsed", "%", "100 `utilisation.l1_port`", Need::time,
     [](Counts c) { return use_of(c, &TimedStatistics::l1_port); }},
    {"lts__throughput.avg.pct_of_peak_sustained_elapsed", "%", "100 `utilisation.l2_slices`", Need::time,
     [](Counts c) { return use_of(c, &TimedStatistics::l2_slices); }, "L2 Cache Throughput"},
    {"gpu__dram_throughput.avg.pct_of_peak_sustained_elapsed", "%", "100 `utilisation.dram`", Need::time,
     [](Counts c) { return use_of(c, &TimedStatistics::dram); }, "DRAM Throughput",
     "dram__throughput.avg.pct_of_peak_sustained_elapsed"},
    {"l1tex__t_bytes_pipe_lsu_mem_global_op_ld.sum.per_second", "byte/second", "32 `l1_requests` / `seconds`",
     Need::time, [](Counts c) { return moved_per_second(c, c.loads.requests); }},
    {"l1tex__m_xbar2l1tex_read_bytes.sum.per_second", "byte/second", "32 `l2.requests` of the timed replay / `seconds`",
     Need::time, [](Counts c) { return moved_per_second(c, c.time ? c.time->levels[1].requests() : 0); }},
    {"dram__bytes_read.sum.per_second", "byte/second", "32 `dram_sectors` of the timed replay / `seconds`",
     Need::read_time, [](Counts c) { return moved_per_second(c, c.time ? c.time->dram_sectors : 0); }},
    {"dram__bytes.sum.per_second", "byte/second", "32 `dram_sectors` of the timed replay / `seconds`", Need::time,
     [](Counts c) { return moved_per_second(c, c.time ? c.time->dram_sectors : 0); }},
};

}  // namespace

double number_of(const MetricValue& value) {
    const auto* count = std::get_if<std::uint64_t>(&value);
    return count ? static_cast<double>(*count) : std::get<double>(value);
}

bool ProfilerMetric::is_percentage() const { return std::string_view(unit) == "%"; }

bool ProfilerMetric::is_quotient() const {
    const std::string_view text = unit;
    return is_percentage() || text == "sector/request" || text == "thread";
}

std::span<const ProfilerMetric> profiler_metrics() { return all_metrics; }

}  // namespace raycache::cachesim
