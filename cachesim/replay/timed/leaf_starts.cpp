#include "cachesim/replay/timed/leaf_starts.hpp"

namespace raycache::cachesim {

LeafStarts::LeafStarts(const std::vector<traces::Region>& regions) : regions_(regions.size()) {
    for (std::size_t r = 0; r < regions.size(); ++r) regions_[r].kind = regions[r].kind;
    for (const traces::Region& from : regions) {
        for (const std::uint32_t link : from.links) {
            if (link == traces::no_link) continue;
            const std::uint32_t to = link >> 30, element = link & 0x3fffffffu;
            if (to >= regions.size() || !is_triangle(to) || element >= regions[to].count) continue;
            std::vector<std::uint64_t>& first = regions_[to].first;
            if (first.empty()) first.resize((std::size_t{regions[to].count} + 63) / 64);
            first[element / 64] |= std::uint64_t{1} << (element % 64);
        }
    }
}

}  // namespace raycache::cachesim
