// Successor tables on disk: predicted, split into byte planes, compressed. Internal to traces/.
#pragma once

#include <cstdint>
#include <span>

#include "traces/bytes.hpp"
#include "traces/fault.hpp"
#include "traces/header.hpp"

namespace raycache::traces {

/// What a link is predicted from. Stored in the file.
enum class LinkPrediction : std::uint8_t {
    element = 0,   ///< the element itself; suits depth-first orders
    previous = 1,  ///< the link before, of the same target region; suits breadth-first orders
};
inline constexpr unsigned link_predictions = 2;

struct EncodedLinks {
    LinkPrediction prediction = LinkPrediction::element;
    Bytes bytes;
};

/// The smaller of both predictions. `self` is the index of the region.
EncodedLinks encode_links(const Region&, unsigned self);

/// Fills region.links, whose kind, count and degree are known and bounded. Refuses links outside `regions`.
void decode_links(std::span<Region> regions, unsigned self, LinkPrediction, std::span<const std::uint8_t> stored,
                  const Origin&);

}  // namespace raycache::traces
