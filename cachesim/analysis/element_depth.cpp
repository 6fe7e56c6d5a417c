#include "cachesim/analysis/element_depth.hpp"

#include <algorithm>
#include <cstdint>

#include "traces/memory_budget.hpp"

namespace raycache::cachesim {

namespace {

/// Links can lead to these regions only (traces/header.hpp).
constexpr std::size_t linked_regions = 3;

constexpr std::uint32_t region_of(std::uint32_t link) { return link >> 30; }
constexpr std::uint32_t element_of(std::uint32_t link) { return link & 0x3fffffffu; }

}  // namespace

ElementDepth::ElementDepth(const std::vector<traces::Region>& regions)
    : depths_(std::min(regions.size(), linked_regions)) {
    if (regions.empty() || regions[0].count == 0 || regions[0].links.empty()) return;
    known_ = true;
    std::uint64_t elements = 0;
    for (std::size_t r = 0; r < depths_.size(); ++r) elements += regions[r].count;
    MemoryBudget().check(elements, "trace", "the depth of each element that links may lead to");
    for (std::size_t r = 0; r < depths_.size(); ++r) depths_[r].assign(regions[r].count, none);

    // Breadth first, so that the first way found is the shortest.
    std::vector<std::uint32_t> front{0}, next;
    depths_[0][0] = 0;
    for (unsigned depth = 1; !front.empty(); ++depth) {
        next.clear();
        for (const std::uint32_t from : front) {
            const traces::Region& region = regions[region_of(from)];
            if (region.links.empty()) continue;
            const std::uint32_t* const links = &region.links[std::size_t{element_of(from)} * region.degree];
            for (unsigned i = 0; i < region.degree; ++i) {
                const std::uint32_t to = links[i];
                if (to == traces::no_link) continue;
                std::uint8_t& known = depths_[region_of(to)][element_of(to)];
                if (known != none) continue;
                known = static_cast<std::uint8_t>(std::min<unsigned>(depth, deepest));
                next.push_back(to);
            }
        }
        front.swap(next);
    }
    for (std::size_t r = 0; r < depths_.size(); ++r) {
        if (regions[r].kind != traces::ObjectKind::triangle) continue;
        for (std::size_t e = 1; e < depths_[r].size(); ++e)
            if (depths_[r][e] == none) depths_[r][e] = depths_[r][e - 1];
    }
}

}  // namespace raycache::cachesim
