#include "tools/jobs/heat_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "tools/jobs/heat_map_picture.hpp"
#include "tracer/image.hpp"
#include "tracer/simt/thread_map.hpp"
#include "traces/error.hpp"
#include "traces/memory_budget.hpp"

namespace raycache::tools {

namespace {

std::optional<tracer::LaunchGrid> grid_of(const traces::Provenance& p) {
    return tracer::LaunchGrid::from_name(p.thread_map, p.width, p.height, p.spp);
}

/// Sample indices of a pixel in all launches of a trace.
std::uint64_t samples_of(const traces::Header& header) {
    const std::uint64_t spp = header.provenance.spp, per_launch = grid_of(header.provenance)->samples_per_launch();
    std::uint64_t samples = 0;
    for (const std::uint64_t first : header.launches) samples += first < spp ? std::min(per_launch, spp - first) : 0;
    return samples;
}

}  // namespace

cachesim::LanePixels lane_pixels(const traces::Header& header, const std::string& name) {
    const traces::Provenance& p = header.provenance;
    constexpr std::uint32_t largest = 16384;  // pixels on a side of what raycache captures
    const bool possible = p.width > 0 && p.height > 0 && p.width <= largest && p.height <= largest;
    const auto grid = possible ? grid_of(p) : std::nullopt;
    if (!grid || grid->warps() != header.warps_per_launch)
        throw Error(
            fmt::format("{}: expected a trace that says which pixel each lane works for, found thread map '{}', {} x "
                        "{} pixels, {} warps; leave out --heatmap",
                        name, p.thread_map, p.width, p.height, header.warps_per_launch));
    cachesim::LanePixels pixels{p.width, p.height, {}};
    const std::uint64_t costs = std::uint64_t{p.width} * p.height * sizeof(cachesim::PixelCost);
    MemoryBudget().check(std::uint64_t{grid->warps()} * traces::warp_lanes * sizeof(std::uint32_t) + 2 * costs, name,
                         "a heat map of its pixels");  // costs: of a launch, and of all
    pixels.of_lane.reserve(std::size_t{grid->warps()} * traces::warp_lanes);
    for (std::uint32_t warp = 0; warp < grid->warps(); ++warp)
        for (const tracer::LaneJob& job : grid->jobs(warp, 0).lane)
            pixels.of_lane.push_back(job.x < p.width && job.y < p.height ? job.y * p.width + job.x
                                                                         : cachesim::LanePixels::no_pixel);
    return pixels;
}

HeatMap make_heat_map(const std::string& name, const traces::Header& header, const cachesim::PixelCosts& costs,
                      const cachesim::Gpu& gpu) {
    HeatMap map{name, gpu.simd_width, header.provenance.width, header.provenance.height, {}, {}, {}};
    const double samples = static_cast<double>(samples_of(header));
    const auto quotient = [](double a, double b) {
        return b == 0 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(a / b);
    };
    for (const cachesim::PixelCost& c : costs.pixels()) {
        const double sectors = static_cast<double>(c.dram_parts) / static_cast<double>(cachesim::PixelCosts::parts);
        map.dram_bytes.push_back(c.accesses ? quotient(sectors * gpu.l1().sector_bytes, samples)
                                            : std::numeric_limits<float>::quiet_NaN());
        map.l1_miss_rate.push_back(quotient(static_cast<double>(c.l2_parts), static_cast<double>(c.l1_parts)));
        map.active_lanes.push_back(quotient(static_cast<double>(c.lanes), static_cast<double>(c.accesses)));
    }
    return map;
}

std::vector<std::string> heat_map_files(const std::string& exr) {
    if (exr.empty()) return {};
    return {exr, exr.substr(0, exr.size() - 4) + ".png"};
}

void check_heat_map_name(const std::string& exr) {
    if (!exr.ends_with(".exr") || exr.size() == 4)
        throw UsageError(fmt::format("--heatmap '{}'; expected a file name that ends in .exr", exr));
}

void write_heat_maps(const std::string& exr, const std::string& title, const HeatMap& base, const HeatMap& other,
                     Deliveries& deliveries) {
    std::vector<tracer::Channel> channels;
    for (const auto& [layer, map] : {std::pair{"base", &base}, std::pair{"other", &other}}) {
        channels.push_back({fmt::format("{}.DRAM bytes", layer), map->dram_bytes});
        channels.push_back({fmt::format("{}.L1 visit miss rate", layer), map->l1_miss_rate});
        channels.push_back({fmt::format("{}.active lanes", layer), map->active_lanes});
    }
    const auto files = heat_map_files(exr);
    deliveries.attempt([&] { tracer::write_channels(files[0], base.width, base.height, channels); });
    deliveries.attempt([&] { tracer::write_screen_image(files[1], draw(title, base, other)); });
}

}  // namespace raycache::tools
