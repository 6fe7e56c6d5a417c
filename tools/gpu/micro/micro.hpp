// Micro-benchmarks of a GPU's memory system, for the values of a preset: what is measured, as numbers by name.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tools/gpu/device_facts.hpp"

namespace raycache::gpu {

/// One thing measured over another: y of each x.
struct Series {
    std::string name, x, y;  ///< x, y: what they are, with their units
    std::string how;
    std::vector<std::pair<double, double>> points;
};

struct MicroOptions {
    std::uint32_t device = 0;
    bool quick = false;  ///< fewer sizes
};

struct MicroResult {
    DeviceFacts device;
    std::vector<Series> series;
};
/// Throws Error.
MicroResult measure(const MicroOptions&);

}  // namespace raycache::gpu
