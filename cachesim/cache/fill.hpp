// Which sectors a miss fetches beside the missing ones: those that are absent and lie in the same aligned piece of
// CacheGeometry::fill_bytes. A GPU's L2 may read DRAM in pieces of 64 B, say, and so fetch two sectors for one.
#pragma once

#include <cstdint>

#include "cachesim/cache/geometry.hpp"

namespace raycache::cachesim {

class Fill {
public:
    explicit Fill(const CacheGeometry& geometry)
        : sectors_per_piece_(geometry.fill_bytes > geometry.sector_bytes ? geometry.fill_bytes / geometry.sector_bytes
                                                                         : 1),
          piece_((std::uint64_t{1} << sectors_per_piece_) - 1) {}

    /// Whether a miss of one sector can fetch others.
    bool widens() const { return sectors_per_piece_ > 1; }

    /// All sectors of the pieces that hold one of these; the sectors that are present included.
    std::uint32_t pieces(std::uint32_t missing) const {
        std::uint64_t all = 0;
        for (std::uint64_t piece = piece_; piece >> 32 == 0; piece <<= sectors_per_piece_)
            if (missing & piece) all |= piece;
        return static_cast<std::uint32_t>(all);
    }

private:
    std::uint32_t sectors_per_piece_;
    std::uint64_t piece_;  ///< the sectors of the first piece
};

}  // namespace raycache::cachesim
