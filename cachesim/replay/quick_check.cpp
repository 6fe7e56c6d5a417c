#include "cachesim/replay/quick_check.hpp"

#include <algorithm>

#include "cachesim/vector_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cachesim/replay/quick_check.cpp"
#include <hwy/foreach_target.h>

#include "cachesim/vector_ops-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace raycache::cachesim::HWY_NAMESPACE {
namespace {

bool is_right(const traces::WarpTrace& warp, const std::vector<traces::Region>& regions) {
    const std::uint32_t *element = warp.elements.data(), *const end = element + warp.elements.size();
    Mask wrong = lowest(0);
    for (const traces::Record& record : warp.records) {
        if (static_cast<unsigned>(record.ray) >= traces::ray_types) return false;
        if (!record.is_access()) continue;
        unsigned left = record.lanes();
        if (record.region >= regions.size() || left == 0 || left > end - element) return false;
        const Vector count = all(regions[record.region].count);
        for (; left > 0;) {
            const unsigned now = std::min(left, lanes_of_vector);
            const bool whole = end - element >= static_cast<std::ptrdiff_t>(lanes_of_vector);  // of later records, too
            const Vector found = whole ? load(element) : load_lowest(element, now);
            wrong = hn::Or(wrong, hn::AndNot(hn::Lt(found, count), lowest(now)));
            left -= now;
            element += now;
        }
    }
    return hn::AllFalse(words_tag, wrong) && element == end;
}

}  // namespace
}  // namespace raycache::cachesim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "cachesim/dispatch.hpp"

namespace raycache::cachesim {

HWY_EXPORT(is_right);

IsRight* quick_check(InstructionSet instructions) {
    return instructions == InstructionSet::scalar ? nullptr : &RAYCACHE_DISPATCH(is_right, instructions);
}

}  // namespace raycache::cachesim
#endif
