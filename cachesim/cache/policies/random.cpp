#include "cachesim/cache/policies/random.hpp"

#include "cachesim/cache/policies/ways_in_place.hpp"

namespace raycache::cachesim {

std::unique_ptr<Level> make_random(const CacheGeometry& geometry, CacheRange caches, std::uint64_t /*lines*/,
                                   InstructionSet) {
    return make_in_place<RandomOrder>(geometry, caches, geometry.seed, geometry.slices * geometry.sets * caches.first);
}

std::unique_ptr<VictimOrder> order_random(const CacheGeometry& geometry, unsigned cache) {
    const std::uint64_t sets = geometry.slices * geometry.sets;
    return std::make_unique<VictimOrderOf<RandomOrder>>(sets, geometry.ways, geometry.seed, cache * sets);
}

}  // namespace raycache::cachesim
