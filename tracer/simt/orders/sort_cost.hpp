// Bytes that the sort of a wavefront moves: a radix sort of 32-bit keys with 32-bit payloads (the ray's place), 8 bits
// a pass, that reads its keys once for the histograms of all digits and then reads and writes keys and payloads once a
// pass: A. Adinets, D. Merrill, "Onesweep: A Faster Least Significant Digit Radix Sort for GPUs", 2022. The older sort
// of D. Merrill and A. Grimshaw (2011) reads the keys of each pass twice. Histograms and look-back words, some KiB a
// pass, are left out.
//
//   making keys    reads the queue (4 B) and the ray (32 B), writes the key (4 B)
//   histograms     reads the key (4 B)
//   each pass      reads and writes key and payload (16 B)
//
// With run-length compression (Garanzha & Loop 2010) keys are made as above; then each ray's key is read to mark where
// runs begin (4 B), the prefix sum over these marks is written and read (8 B), and expanding writes and reads the
// payloads back (8 B). A run writes its key, place and length (12 B), is sorted like a ray, and is read again (12 B).
#pragma once

#include <cstdint>

#include "tracer/simt/orders/ray_order.hpp"

namespace raycache::tracer {

struct SortCost {
    std::uint32_t bytes_per_ray = 0;
    std::uint32_t bytes_per_run = 0;  ///< 0 where runs are not compressed
};

inline SortCost sort_cost(const RayOrder& order) {
    constexpr std::uint32_t make_key = 4 + 32 + 4;
    const std::uint32_t sort = 4 + 16 * ((order.key_bits() + 7) / 8);
    if (!order.compresses_runs()) return {make_key + sort, 0};
    return {make_key + 4 + 8 + 8, 12 + sort + 12};
}

}  // namespace raycache::tracer
