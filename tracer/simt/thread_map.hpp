// Which (pixel, sample) a lane gets.
//
// All maps but `rows` walk the picture in squares of 16x16 pixels, row by row, and each square in tiles of 8x4 pixels,
// so that neighbours in dispatch order are neighbours in the picture.
//   tile     a warp = the 32 pixels of one tile, one sample index. A launch is one sample index of every pixel.
//   samples  a warp = one pixel, 32 consecutive sample indices. A launch is 32 sample indices of every pixel.
//   rows     a warp = 32 pixels of a row, one sample index; warps follow one another along the row, and the last warp
//            of a row goes on at the beginning of the next. A launch is one sample index of every pixel. As Blender
//            Cycles has it where the scrambling distance is below 0.9 (work stealing of kernel/integrator), where its
//            work tile is the whole picture.
//   classes  pixels fall into m x m classes (x mod m, y mod m). The pixels of a class, a picture of its own, are
//            walked as `tile` walks the whole; class (0,0) first, then (1,0), … so that each is a coherent pass, one behind the
//            other in the launch. A launch is one sample index of every pixel. m need not divide the picture's size:
//            classes towards the right and the bottom then have a column or row less, and a few lanes or warps idle.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "traces/record.hpp"

namespace raycache::tracer {

enum class ThreadMap { tile, samples, rows, classes };

struct ThreadMapEntry {
    ThreadMap map;
    std::string name, description;
};
const std::vector<ThreadMapEntry>& thread_maps();

/// Throws UsageError that lists the valid names.
ThreadMap thread_map_from(const std::string& name);
const char* to_string(ThreadMap);

struct LaneJob {
    std::uint32_t x = 0, y = 0;
    std::uint32_t sample = 0;  ///< sample index
};

/// The lanes of one warp that have work: those inside the picture, and below N.
struct WarpJobs {
    std::uint32_t mask = 0;
    std::array<LaneJob, traces::warp_lanes> lane{};
};

class LaunchGrid {
public:
    /// `interleave` is the m of `classes`, ignored by the other maps. Throws UsageError for `classes` unless m is at
    /// least 1 and at most the picture's shorter side.
    LaunchGrid(ThreadMap, std::uint32_t width, std::uint32_t height, std::uint64_t spp, std::uint32_t interleave = 1);

    /// The grid that name() of another told; nothing if no grid of that size has such a name.
    static std::optional<LaunchGrid> from_name(const std::string& name, std::uint32_t width, std::uint32_t height,
                                               std::uint64_t spp);

    std::string name() const;                       ///< of the thread map, with its m: "tile", "samples", "classes:8"
    std::uint32_t warps() const { return warps_; }  ///< per launch; some may lie outside the picture and stay empty
    WarpJobs jobs(std::uint32_t warp, std::uint32_t first_sample) const;
    std::uint32_t samples_per_launch() const { return map_ == ThreadMap::samples ? traces::warp_lanes : 1; }

private:
    WarpJobs row_jobs(std::uint32_t warp, std::uint32_t sample) const;

    ThreadMap map_;
    std::uint32_t width_, height_;
    std::uint32_t interleave_;  ///< m of `classes`, else 1: one class
    std::uint32_t squares_across_, warps_per_class_, warps_;
    std::uint64_t spp_;
};

}  // namespace raycache::tracer
