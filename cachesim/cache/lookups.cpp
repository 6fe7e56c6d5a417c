#include "cachesim/cache/lookups.hpp"

#include <algorithm>

#include "cachesim/vector_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cachesim/cache/lookups.cpp"
#include <hwy/foreach_target.h>

#include "cachesim/vector_ops-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace raycache::cachesim::HWY_NAMESPACE {
namespace {

/// Of `count` look-ups, those with sectors move to the front; returns how many. Behind the last there is room for a
/// vector.
std::size_t keep_fetched(std::uint32_t* lines, std::uint32_t* sectors, std::uint32_t* accesses, std::size_t count) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; i += lanes_of_vector) {
        const auto left = static_cast<unsigned>(std::min<std::size_t>(count - i, lanes_of_vector));
        const Vector line = load(lines + i), access = load(accesses + i),
                     fetched = hn::IfThenElseZero(lowest(left), load(sectors + i));
        const Mask some = hn::Ne(fetched, hn::Zero(words_tag));
        store(lines + kept, compressed(line, some));
        store(sectors + kept, compressed(fetched, some));
        store(accesses + kept, compressed(access, some));
        kept += count_of(some);
    }
    return kept;
}

}  // namespace
}  // namespace raycache::cachesim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "cachesim/dispatch.hpp"

namespace raycache::cachesim {

HWY_EXPORT(keep_fetched);

void Lookups::drop_answered(InstructionSet instructions) {
    if (instructions != InstructionSet::scalar) {
        count = RAYCACHE_DISPATCH(keep_fetched, instructions)(lines.data(), sectors.data(), accesses.data(), count);
        return;
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
        lines[kept] = lines[i];
        sectors[kept] = sectors[i];
        accesses[kept] = accesses[i];
        kept += sectors[i] != 0;
    }
    count = kept;
}

}  // namespace raycache::cachesim
#endif
