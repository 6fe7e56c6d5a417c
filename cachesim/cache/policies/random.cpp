#include "cachesim/cache/policies/random.hpp"

#include "cachesim/cache/policies/ways_in_place.hpp"

namespace raycache::cachesim {

std::unique_ptr<Level> make_random(const CacheGeometry& geometry, unsigned caches, const LineIds& ids, InstructionSet) {
    return make_in_place<RandomOrder>(geometry, caches, ids, geometry.seed);
}

}  // namespace raycache::cachesim
