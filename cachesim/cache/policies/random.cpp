#include "cachesim/cache/policies/random.hpp"

#include "cachesim/cache/policies/ways_in_place.hpp"

namespace raycache::cachesim {

std::unique_ptr<Level> make_random(const CacheGeometry& geometry, unsigned caches, std::uint64_t /*lines*/, InstructionSet) {
    return make_in_place<RandomOrder>(geometry, caches, geometry.seed);
}

std::unique_ptr<VictimOrder> order_random(const CacheGeometry& geometry, unsigned cache) {
    return std::make_unique<VictimOrderOf<RandomOrder>>(geometry.slices * geometry.sets, geometry.ways, geometry.seed + cache);
}

}  // namespace raycache::cachesim
