// The RT unit of an SM: rates and sizes of hardware that walks the BVH in place of the SM's instructions. One unit an
// SM, as Vulkan-Sim has it (Saed et al., MICRO 2022): it takes warps into a buffer, fetches nodes and triangles through
// a queue of its own to L1, and tests them in pipelines.
//
// No vendor publishes these numbers for an NVIDIA GPU. What presets say is assumed between what is public of others:
// 4 boxes or 1 triangle a cycle (AMD, RDNA 2), 12 boxes and 1 triangle (Intel, Xe-HPG).
#pragma once

#include <cstdint>

namespace raycache::cachesim {

/// Who walks the BVH in a timed replay.
enum class Traversal {
    software,  ///< instructions of the SM: Timing::node_instructions and so on
    rt_unit,   ///< RtUnitTiming; of the SM's instructions those of shading and of texels are left
};

struct RtUnitTiming {
    std::uint32_t warps = 4;              ///< of the SM, whose rays the unit holds at once
    double box_tests_per_cycle = 8;       ///< a ray against a box of a node each, of all warps together
    double triangle_tests_per_cycle = 1;  ///< a ray against a triangle each
    std::uint32_t box_latency = 4;        ///< cycles from the last in which tests of a visit enter to their results
    std::uint32_t triangle_latency = 8;
    std::uint32_t load_bytes = 32;      ///< nodes and triangles are fetched in pieces of this size
    std::uint32_t loads_per_cycle = 1;  ///< pieces, of all lanes of a warp each, that enter the queue to L1
    std::uint32_t load_queue = 4;       ///< loads of the unit that may wait for the port of an L1

    bool operator==(const RtUnitTiming&) const = default;
};

}  // namespace raycache::cachesim
