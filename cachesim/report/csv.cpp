#include <fmt/format.h>

#include <cmath>

#include "cachesim/report/csv_field.hpp"
#include "cachesim/report/report.hpp"
#include "cachesim/report/verdict.hpp"

namespace raycache::cachesim {

namespace {

/// One record of comma-separated values; lines end in '\n'. A value that does not exist is an empty field.
class Line {
public:
    void text(const std::string& value) { raw(csv_field(value)); }
    void number(std::uint64_t value) { raw(fmt::format("{}", value)); }
    /// The shortest digits that read back as the same double.
    void number(double value) { raw(std::isfinite(value) ? fmt::format("{}", value) : ""); }
    void estimate(const std::optional<Estimate>& e) {
        const double none = std::nan("");
        number(e ? e->mean : none);
        number(e && e->half_width ? *e->half_width : none);
    }
    std::string end() { return line_ + '\n'; }

private:
    void raw(const std::string& field) {
        if (!first_) line_ += ',';
        first_ = false;
        line_ += field;
    }
    std::string line_;
    bool first_ = true;
};

/// The last columns are there only if some GPU has an L3.
constexpr const char* l3_header =
    ",l3_sectors,l3_hits,l3_hit_rate,l3_hit_rate_ci95,l3_bytes_per_ray,l3_bytes_per_ray_ci95,l3_bytes_ratio,"
    "l3_bytes_ratio_ci95,l3_locality,l3_locality_ci95";
/// Likewise, if some trace is of a wavefront.
constexpr const char* wavefront_header =
    ",written_sectors,sort_sectors,written_bytes_per_ray,written_bytes_per_ray_ci95,sort_bytes_per_ray,"
    "sort_bytes_per_ray_ci95";
constexpr const char* header =
    "scene,strategy,sequence,parameters,thread_map,gpu,group,spp,samples,total_rays,steps,lane_accesses,warp_accesses,"
    "loads,l1_requests,l1_hits,sectors,l1_visit_hits,l2_sectors,l2_hits,dram_sectors,dram_first_sectors,rays,rays_ci95,"
    "steps_per_ray,steps_per_ray_ci95,"
    "active_lanes,"
    "active_lanes_ci95,sectors_per_access,sectors_per_access_ci95,l1_hit_rate,l1_hit_rate_ci95,"
    "l1_visit_hit_rate,l1_visit_hit_rate_ci95,l2_hit_rate,l2_hit_rate_ci95,l2_bytes_per_ray,l2_bytes_per_ray_ci95,"
    "dram_bytes_per_ray,dram_bytes_per_ray_ci95,dram_compulsory_share,dram_compulsory_share_ci95,l2_bytes_ratio,"
    "l2_bytes_ratio_ci95,dram_bytes_ratio,dram_bytes_ratio_ci95,work,work_ci95,simt_efficiency,simt_efficiency_ci95,"
    "coalescing,coalescing_ci95,l1_locality,l1_locality_ci95,l2_locality,l2_locality_ci95,equal_miss_rates,"
    "equal_miss_rates_ci95,cache_locality,cache_locality_ci95,verdict_level,verdict";

}  // namespace

std::string to_csv(const Report& report) {
    std::string csv = header;
    if (report.has_l3()) csv += l3_header;
    if (report.has_wavefront()) csv += wavefront_header;
    csv += '\n';
    for (const Row& row : report.rows) {
        Line line;
        for (const auto* name :
             {&row.scene, &row.strategy, &row.sequence, &row.parameters, &row.thread_map, &row.gpu, &row.group})
            line.text(*name);
        line.number(row.spp);
        std::string samples;  // one field: "0 1 2"
        for (const std::uint32_t sample : row.samples)
            samples += fmt::format("{}{}", samples.empty() ? "" : " ", sample);
        line.text(samples);
        const Counters& c = row.totals;
        for (const std::uint64_t count :
             {c.rays, c.steps, c.lane_accesses, c.warp_accesses, c.loads, c.l1_requests, c.l1_request_hits(), c.sectors,
              c.l1_hits, c.l2_sectors, c.l2_hits, c.dram_sectors, c.dram_first_sectors})
            line.number(count);
        for (const Estimate* e : {&row.rays, &row.steps_per_ray, &row.active_lanes, &row.sectors_per_access,
                                  &row.l1_hit_rate, &row.l1_visit_hit_rate, &row.l2_hit_rate, &row.l2_bytes_per_ray,
                                  &row.dram_bytes_per_ray, &row.dram_compulsory_share})
            line.estimate(*e);
        line.estimate(row.l2_bytes_ratio);
        line.estimate(row.dram_bytes_ratio);
        const auto factor = [&](Estimate Factors::*f) {
            return row.factors ? std::optional((*row.factors).*f) : std::nullopt;
        };
        for (Estimate Factors::*f :
             {&Factors::work, &Factors::simt_efficiency, &Factors::coalescing, &Factors::l1_locality,
              &Factors::l2_locality, &Factors::equal_miss_rates, &Factors::cache_locality})
            line.estimate(factor(f));
        const Verdict found = row.dram_bytes_ratio ? verdict(difference_of(row)) : Verdict{};
        line.text(found.level.value_or(""));
        line.text(found.text);
        if (report.has_l3()) {
            line.number(c.l3_sectors);
            line.number(c.l3_hits);
            line.estimate(row.l3_hit_rate);
            line.estimate(row.l3_bytes_per_ray);
            line.estimate(row.l3_bytes_ratio);
            line.estimate(row.levels == 3 ? factor(&Factors::l3_locality) : std::nullopt);
        }
        if (report.has_wavefront()) {
            line.number(c.written_sectors);
            line.number(c.sort_sectors);
            line.estimate(row.written_bytes_per_ray);
            line.estimate(row.sort_bytes_per_ray);
        }
        csv += line.end();
    }
    return csv;
}

}  // namespace raycache::cachesim
