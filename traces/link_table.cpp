#include "traces/link_table.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "traces/compression.hpp"
#include "traces/lane_stack.hpp"

namespace raycache::traces {
namespace {

/// Maps links to codes near zero and back. A code is the target region (3 for no link) in the top bits over the
/// element's zigzag difference, modulo 2^30, from the prediction.
class LinkCoder {
public:
    LinkCoder(LinkPrediction prediction, unsigned self)
        : from_element_(prediction == LinkPrediction::element), self_(self) {}

    std::uint32_t encode(std::uint32_t element, std::uint32_t link) {
        if (link == no_link) return unlinkable << element_bits;
        const std::uint32_t region = link >> element_bits, target = link & element_mask;
        const std::uint32_t difference = (target - prediction(region, element)) << 2;  // the sign bit to the top
        last_[region] = target;
        const std::uint32_t sign = 0u - (difference >> 31);
        return region << element_bits | ((((difference >> 2) << 1) ^ sign) & element_mask);
    }
    std::uint32_t decode(std::uint32_t element, std::uint32_t code) {
        const std::uint32_t region = code >> element_bits;
        if (region == unlinkable) return no_link;
        const std::uint32_t target = (prediction(region, element) + unzigzag(code & element_mask)) & element_mask;
        last_[region] = target;
        return region << element_bits | target;
    }

private:
    std::uint32_t prediction(std::uint32_t region, std::uint32_t element) const {
        return from_element_ && region == self_ ? element + 1 : last_[region] + 1;
    }

    bool from_element_;
    unsigned self_;
    std::array<std::uint32_t, unlinkable> last_{element_mask, element_mask, element_mask};
};

}  // namespace

EncodedLinks encode_links(const Region& region, unsigned self) {
    EncodedLinks best;
    const std::size_t count = region.links.size();
    if (count == 0) return best;
    Bytes planes(count * 4);
    for (const auto prediction : {LinkPrediction::element, LinkPrediction::previous}) {
        LinkCoder coder(prediction, self);
        for (std::size_t i = 0; i < count; ++i) {
            const auto element = static_cast<std::uint32_t>(i / region.degree);
            const std::uint32_t code = coder.encode(element, region.links[i]);
            for (unsigned k = 0; k < 4; ++k) planes[k * count + i] = static_cast<std::uint8_t>(code >> (8 * k));
        }
        Bytes bytes;
        compress(planes, Effort::small, bytes);
        if (best.bytes.empty() || bytes.size() < best.bytes.size()) best = {prediction, std::move(bytes)};
    }
    return best;
}

void decode_links(std::span<Region> regions, unsigned self, LinkPrediction prediction,
                  std::span<const std::uint8_t> stored, const Origin& origin) {
    Region& region = regions[self];
    const std::size_t count = std::size_t{region.degree} * region.count;
    check_content_size(stored, std::uint64_t{count} * 4, origin);
    region.links.assign(count, 0);
    std::size_t at = 0;  // all lowest bytes come first, then all second ones …
    unsigned shift = 0;
    decompress_pieces(stored, std::uint64_t{count} * 4, origin, [&](std::span<const std::uint8_t> piece) {
        while (!piece.empty()) {
            const std::size_t run = std::min(piece.size(), count - at);
            for (std::size_t i = 0; i < run; ++i) region.links[at + i] |= std::uint32_t{piece[i]} << shift;
            piece = piece.subspan(run);
            at += run;
            if (at == count) at = 0, shift += 8;
        }
    });
    LinkCoder coder(prediction, self);
    for (std::size_t i = 0; i < count; ++i) {
        const auto element = static_cast<std::uint32_t>(i / region.degree);
        const std::uint32_t link = coder.decode(element, region.links[i]);
        if (link != no_link) {
            const std::uint32_t to = link >> element_bits;
            if (to >= regions.size() || (link & element_mask) >= regions[to].count)
                refuse(origin, fmt::format("link {} of element {} of region {}", i % region.degree, element, self),
                       "an element of the trace", fmt::format("element {} of region {}", link & element_mask, to),
                       recapture);
        }
        region.links[i] = link;
    }
}

}  // namespace raycache::traces
