#include "tracer/simt/thread_map.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "traces/did_you_mean.hpp"
#include "traces/error.hpp"

namespace raycache::tracer {
namespace {

constexpr std::uint32_t square_side = 16, tile_columns = 8, tile_rows = 4;
constexpr std::uint32_t tiles_in_row = square_side / tile_columns;
constexpr std::uint32_t pixels_per_square = square_side * square_side;
constexpr std::uint32_t tiles_per_square = pixels_per_square / traces::warp_lanes;

}  // namespace

const std::vector<ThreadMapEntry>& thread_maps() {
    static const std::vector<ThreadMapEntry> all{
        {ThreadMap::tile, "tile", "a warp = 8x4 neighbouring pixels, one sample index"},
        {ThreadMap::samples, "samples", "a warp = one pixel, 32 consecutive sample indices"},
        {ThreadMap::rows, "rows", "a warp = 32 neighbouring pixels of a row (32x1), one sample index"},
        {ThreadMap::classes, "classes",
         "a warp = 8x4 pixels of one class of --interleave M, M pixels apart, one sample index"}};
    return all;
}

ThreadMap thread_map_from(const std::string& name) {
    for (const ThreadMapEntry& entry : thread_maps())
        if (name == entry.name) return entry.map;
    std::vector<std::string> valid;
    for (const ThreadMapEntry& entry : thread_maps()) valid.push_back(entry.name);
    throw UsageError(fmt::format("unknown thread map '{}'; expected one of: {}{}", name, fmt::join(valid, ", "),
                                 did_you_mean(name, valid)));
}

const char* to_string(ThreadMap map) {
    for (const ThreadMapEntry& entry : thread_maps())
        if (map == entry.map) return entry.name.c_str();
    return "";
}

LaunchGrid::LaunchGrid(ThreadMap map, std::uint32_t width, std::uint32_t height, std::uint64_t spp,
                       std::uint32_t interleave)
    : map_(map),
      width_(width),
      height_(height),
      interleave_(map == ThreadMap::classes ? interleave : 1),
      squares_across_(0),
      warps_per_class_(0),
      warps_(0),
      spp_(spp) {
    if (interleave_ == 0 || (interleave_ > 1 && interleave_ > std::min(width, height)))
        throw UsageError(fmt::format(
            "thread map classes with {0}x{0} classes of pixels for a picture of {1}x{2}; expected 1 to {3}, "
            "the shorter side (--interleave)",
            interleave_, width, height, std::min(width, height)));
    const std::uint32_t span = square_side * interleave_;
    squares_across_ = (width + span - 1) / span;
    const std::uint32_t squares = squares_across_ * ((height + span - 1) / span);
    warps_per_class_ = squares * (map == ThreadMap::samples ? pixels_per_square : tiles_per_square);
    warps_ = warps_per_class_ * interleave_ * interleave_;
    if (map == ThreadMap::rows)
        warps_ = warps_per_class_ = (width * height + traces::warp_lanes - 1) / traces::warp_lanes;
}

std::optional<LaunchGrid> LaunchGrid::from_name(const std::string& name, std::uint32_t width, std::uint32_t height,
                                                std::uint64_t spp) {
    for (const ThreadMap map : {ThreadMap::tile, ThreadMap::samples, ThreadMap::rows})
        if (name == to_string(map)) return LaunchGrid(map, width, height, spp);
    const std::string prefix = to_string(ThreadMap::classes) + std::string(":");
    if (!name.starts_with(prefix)) return std::nullopt;
    std::uint32_t interleave = 0;
    const char* const end = name.data() + name.size();
    const auto read = std::from_chars(name.data() + prefix.size(), end, interleave);
    if (read.ec != std::errc{} || read.ptr != end || interleave == 0 || interleave > std::min(width, height))
        return std::nullopt;
    return LaunchGrid(ThreadMap::classes, width, height, spp, interleave);
}

std::string LaunchGrid::name() const {
    return map_ == ThreadMap::classes ? fmt::format("{}:{}", to_string(map_), interleave_) : to_string(map_);
}

WarpJobs LaunchGrid::row_jobs(std::uint32_t warp, std::uint32_t sample) const {
    WarpJobs out;
    for (std::uint32_t lane = 0; lane < traces::warp_lanes; ++lane) {
        const std::uint32_t p = warp * traces::warp_lanes + lane;
        out.lane[lane] = {p % width_, p / width_, sample};
        if (p < width_ * height_ && sample < spp_) out.mask |= 1U << lane;
    }
    return out;
}

WarpJobs LaunchGrid::jobs(std::uint32_t warp, std::uint32_t first_sample) const {
    if (map_ == ThreadMap::rows) return row_jobs(warp, first_sample);
    const std::uint32_t pass = warp / warps_per_class_;  // which class
    warp %= warps_per_class_;
    const bool one_pixel = map_ == ThreadMap::samples;
    const std::uint32_t first = one_pixel ? warp : warp * traces::warp_lanes;  // pixel in dispatch order
    WarpJobs out;
    for (std::uint32_t lane = 0; lane < traces::warp_lanes; ++lane) {
        const std::uint32_t p = one_pixel ? first : first + lane;
        const std::uint32_t in_square = p % pixels_per_square, in_tile = in_square % traces::warp_lanes;
        const std::uint32_t tile = in_square / traces::warp_lanes, corner = p / pixels_per_square;
        LaneJob& job = out.lane[lane];
        job.x = corner % squares_across_ * square_side + tile % tiles_in_row * tile_columns + in_tile % tile_columns;
        job.y = corner / squares_across_ * square_side + tile / tiles_in_row * tile_rows + in_tile / tile_columns;
        job.x = job.x * interleave_ + pass % interleave_;
        job.y = job.y * interleave_ + pass / interleave_;
        job.sample = first_sample + (one_pixel ? lane : 0);
        if (job.x < width_ && job.y < height_ && job.sample < spp_) out.mask |= 1U << lane;
    }
    return out;
}

}  // namespace raycache::tracer
