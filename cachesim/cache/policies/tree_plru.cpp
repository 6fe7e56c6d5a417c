#include "cachesim/cache/policies/tree_plru.hpp"

#include "cachesim/cache/policies/ways_in_place.hpp"

namespace raycache::cachesim {

std::unique_ptr<Level> make_tree_plru(const CacheGeometry& geometry, CacheRange caches, std::uint64_t /*lines*/,
                                      InstructionSet) {
    return make_in_place<TreePlruOrder>(geometry, caches);
}

std::unique_ptr<VictimOrder> order_tree_plru(const CacheGeometry& geometry, unsigned /*cache*/) {
    return std::make_unique<VictimOrderOf<TreePlruOrder>>(geometry.slices * geometry.sets, geometry.ways);
}

}  // namespace raycache::cachesim
