#include "cachesim/cache/policies/fifo.hpp"

#include "cachesim/cache/policies/ways_in_place.hpp"

namespace raycache::cachesim {

std::unique_ptr<Level> make_fifo(const CacheGeometry& geometry, CacheRange caches, std::uint64_t /*lines*/,
                                 InstructionSet) {
    return make_in_place<FifoOrder>(geometry, caches);
}

std::unique_ptr<VictimOrder> order_fifo(const CacheGeometry& geometry, unsigned /*cache*/) {
    return std::make_unique<VictimOrderOf<FifoOrder>>(geometry.slices * geometry.sets, geometry.ways);
}

}  // namespace raycache::cachesim
