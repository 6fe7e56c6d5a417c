// Coalescing in AVX-512, all lanes at once: the same lines and sectors in the same order as Coalescer without it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "cachesim/cache/request.hpp"
#include "cachesim/frontend/region_layout.hpp"

namespace raycache::cachesim {

/// What a warp access became.
struct Coalesced {
    std::size_t requests = 0;
    unsigned sectors = 0;  ///< of all requests together
};

/// Whether coalesce_avx512() can do it. The machine must have InstructionSet::avx512.
inline bool can_coalesce_avx512(const RegionLayout& layout, unsigned lanes) {
    return layout.vectors && lanes <= (layout.aligned ? 16u : 8u);
}

/// `out` has room for 16 requests; those beyond the result's number are garbage.
Coalesced coalesce_avx512(const RegionLayout&, const LineShape&, const std::uint32_t* elements, unsigned lanes,
                          const Request& like, Request* out);

}  // namespace raycache::cachesim
