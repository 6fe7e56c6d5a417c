// First in, first out: what came first goes first, however often it was used since. A sector that comes later to a line
// that is there does not make the line younger.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "cachesim/cache/level.hpp"
#include "cachesim/cache/policies/victim_order.hpp"
#include "cachesim/instruction_set.hpp"

namespace raycache::cachesim {

class FifoOrder {
public:
    FifoOrder(std::uint64_t sets, std::uint64_t ways) : ways_(ways), oldest_(sets) {}

    void use(std::uint64_t /*set*/, std::uint64_t /*way*/) {}

    /// Lines came in the order of the ways, so they go in that order, over and over.
    std::uint64_t victim(std::uint64_t set) {
        const std::uint32_t way = oldest_[set];
        oldest_[set] = way + 1 == ways_ ? 0 : way + 1;
        return way;
    }

private:
    std::uint64_t ways_;
    std::vector<std::uint32_t> oldest_;  ///< by set: the way whose line came first
};

std::unique_ptr<Level> make_fifo(const CacheGeometry&, CacheRange caches, std::uint64_t lines, InstructionSet);
std::unique_ptr<VictimOrder> order_fifo(const CacheGeometry&, unsigned cache);

}  // namespace raycache::cachesim
