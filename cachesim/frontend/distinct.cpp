#include "cachesim/frontend/distinct.hpp"

#include <bit>

#include "cachesim/vector_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cachesim/frontend/distinct.cpp"
#include <hwy/foreach_target.h>

#include "cachesim/vector_ops-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace raycache::cachesim::HWY_NAMESPACE {
namespace {

#if RAYCACHE_HAS_CONFLICTS
std::uint32_t repeated(Vector what, unsigned count) {
    return bits_of(hn::And(lowest(count), hn::Ne(conflicts(what), hn::Zero(words_tag))));
}

unsigned distinct(const std::uint32_t* elements, unsigned count) {
    const Vector first = load_lowest(elements, count);
    if (count <= lanes_of_vector) return count - static_cast<unsigned>(std::popcount(repeated(first, count)));
    const unsigned rest = count - lanes_of_vector;
    const Vector second = load_lowest(elements + lanes_of_vector, rest);
    Mask in_first = hn::Eq(second, all(elements[0]));
    for (unsigned lane = 1; lane < lanes_of_vector; ++lane)
        in_first = hn::Or(in_first, hn::Eq(second, all(elements[lane])));
    const std::uint32_t again = repeated(second, rest) | bits_of(hn::And(lowest(rest), in_first));
    return count - static_cast<unsigned>(std::popcount(repeated(first, lanes_of_vector)) + std::popcount(again));
}
CountDistinct* fastest() { return distinct; }
#else
CountDistinct* fastest() { return distinct_by_bits; }
#endif

}  // namespace
}  // namespace raycache::cachesim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "cachesim/dispatch.hpp"

namespace raycache::cachesim {

HWY_EXPORT(fastest);

CountDistinct* count_distinct(InstructionSet instructions) {
    return instructions == InstructionSet::scalar ? distinct_by_bits : RAYCACHE_DISPATCH(fastest, instructions)();
}

unsigned distinct_by_bits(const std::uint32_t* elements, unsigned count) {
    std::uint64_t low_bits = 0;  // bit b: an element with these six low bits has come
    unsigned distinct = 0;
    for (unsigned i = 0; i < count; ++i) {
        const std::uint64_t bit = std::uint64_t{1} << (elements[i] & 63);
        unsigned first = i;
        if (low_bits & bit)
            for (first = 0; elements[first] != elements[i];) ++first;
        distinct += first == i;
        low_bits |= bit;
    }
    return distinct;
}

}  // namespace raycache::cachesim
#endif
