// Where in the image cache traffic comes from: numbers for each pixel, and a picture of them.
#pragma once

#include <string>
#include <vector>

#include "cachesim/analysis/pixel_costs.hpp"
#include "cachesim/gpus/gpu.hpp"
#include "tools/jobs/outputs.hpp"
#include "traces/header.hpp"

namespace raycache::tools {

/// Of one trace, by pixel, rows top to bottom. NaN where a pixel read nothing.
struct HeatMap {
    std::string name;     ///< of the trace, such as its strategy
    unsigned lanes = 32;  ///< of a warp access at most: the GPU's SIMD width
    std::uint32_t width = 0, height = 0;
    std::vector<float> dram_bytes;    ///< per sample of the pixel
    std::vector<float> l1_miss_rate;  ///< 0 … 1, of the sectors that the pixel's lanes asked for
    std::vector<float> active_lanes;  ///< mean over the warp accesses that the pixel's lanes took part in
};

/// The pixel of every lane of a trace's launches. Throws Error if the trace does not say how lanes belong to pixels, as
/// imported ones do not; `name` is the trace's, for the message.
cachesim::LanePixels lane_pixels(const traces::Header&, const std::string& name);

/// `costs`: of all launches of the trace.
HeatMap make_heat_map(const std::string& name, const traces::Header&, const cachesim::PixelCosts& costs,
                      const cachesim::Gpu&);

/// The files that write_heat_maps() writes; none for an empty name.
std::vector<std::string> heat_map_files(const std::string& exr);

/// Throws UsageError unless write_heat_maps() can write to a file of this name.
void check_heat_map_name(const std::string& exr);

/// Writes FILE.exr with the layers "base" and "other", each with the channels "DRAM bytes", "L1 visit miss rate" and
/// "active lanes", and FILE.png: a row of three panels for each trace and a row of their differences, with common
/// scales, under a title.
void write_heat_maps(const std::string& exr, const std::string& title, const HeatMap& base, const HeatMap& other,
                     Deliveries&);

}  // namespace raycache::tools
