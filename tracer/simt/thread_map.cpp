#include "tracer/simt/thread_map.hpp"

#include <fmt/format.h>

#include "traces/error.hpp"

namespace raycache::tracer {
namespace {

constexpr std::uint32_t square = 16, tile_width = 8, tile_height = 4;
constexpr std::uint32_t tiles_across = square / tile_width;
constexpr std::uint32_t pixels_per_square = square * square;
constexpr std::uint32_t tiles_per_square = pixels_per_square / traces::warp_lanes;

}  // namespace

ThreadMap thread_map_from(const std::string& name) {
    if (name == "tile") return ThreadMap::tile;
    if (name == "samples") return ThreadMap::samples;
    throw UsageError(fmt::format("unknown thread map '{}'; expected one of: tile, samples", name));
}

const char* to_string(ThreadMap map) { return map == ThreadMap::tile ? "tile" : "samples"; }

LaunchGrid::LaunchGrid(ThreadMap map, std::uint32_t width, std::uint32_t height, std::uint64_t spp)
    : map_(map), width_(width), height_(height), squares_across_((width + square - 1) / square), spp_(spp) {
    const std::uint32_t squares = squares_across_ * ((height + square - 1) / square);
    warps_ = squares * (map == ThreadMap::tile ? tiles_per_square : pixels_per_square);
}

WarpJobs LaunchGrid::jobs(std::uint32_t warp, std::uint32_t first_sample) const {
    const std::uint32_t first = map_ == ThreadMap::tile ? warp * traces::warp_lanes : warp;  // pixel in dispatch order
    WarpJobs out;
    for (std::uint32_t lane = 0; lane < traces::warp_lanes; ++lane) {
        const std::uint32_t p = map_ == ThreadMap::tile ? first + lane : first;
        const std::uint32_t in_square = p % pixels_per_square, in_tile = in_square % traces::warp_lanes;
        const std::uint32_t tile = in_square / traces::warp_lanes, corner = p / pixels_per_square;
        LaneJob& job = out.lane[lane];
        job.x = corner % squares_across_ * square + tile % tiles_across * tile_width + in_tile % tile_width;
        job.y = corner / squares_across_ * square + tile / tiles_across * tile_height + in_tile / tile_width;
        job.sample = first_sample + (map_ == ThreadMap::tile ? 0 : lane);
        if (job.x < width_ && job.y < height_ && job.sample < spp_) out.mask |= 1U << lane;
    }
    return out;
}

}  // namespace raycache::tracer
