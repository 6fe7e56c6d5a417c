#include "cachesim/cache/policies/tree_plru.hpp"

#include "cachesim/cache/policies/ways_in_place.hpp"

namespace raycache::cachesim {

std::unique_ptr<Level> make_tree_plru(const CacheGeometry& geometry, unsigned caches, std::uint64_t /*lines*/,
                                      InstructionSet) {
    return make_in_place<TreePlruOrder>(geometry, caches);
}

}  // namespace raycache::cachesim
