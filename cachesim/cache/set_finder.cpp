#include "cachesim/cache/set_finder.hpp"

#include <algorithm>

#include "cachesim/vector_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cachesim/cache/set_finder.cpp"
#include <hwy/foreach_target.h>

#include "cachesim/vector_ops-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace raycache::cachesim::HWY_NAMESPACE {
namespace {

/// Sets of lines, from tables of what each byte of a line contributes. Reads and writes whole vectors, so that both
/// arrays have room for one behind the last.
void find_by_tables(const std::uint32_t* lines, std::size_t count, const std::vector<SetRun>& runs, const LineMap& map,
                    std::uint32_t* sets) {
    const auto& tables = map.tables();
    const std::size_t bytes = std::min<std::size_t>(tables.size(), 4);
    const hn::RebindToSigned<Words> indices;
    for (std::size_t i = 0; i < count; i += lanes_of_vector) {
        const Vector id = load(lines + i);
        Vector offset = all(runs[0].offset), set = all(runs[0].high);
        for (std::size_t run = 1; run < runs.size(); ++run) {
            const Mask before = hn::Lt(id, all(runs[run].first));
            offset = hn::IfThenElse(before, offset, all(runs[run].offset));
            set = hn::IfThenElse(before, set, all(runs[run].high));
        }
        Vector line = hn::Add(id, offset);
        for (std::size_t byte = 0; byte < bytes; ++byte) {
            const auto at = hn::BitCast(indices, hn::And(line, all(0xff)));
            set = hn::Xor(set, hn::GatherIndex(words_tag, tables[byte].data(), at));
            line = hn::ShiftRight<8>(line);
        }
        store(sets + i, set);
    }
}

}  // namespace
}  // namespace raycache::cachesim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "cachesim/dispatch.hpp"

namespace raycache::cachesim {

HWY_EXPORT(find_by_tables);

SetFinder::SetFinder(const CacheGeometry& geometry, const LineIds& ids, InstructionSet instructions)
    : map_(geometry, ids.last_line()),
      ids_(ids),
      sets_per_cache_(static_cast<std::uint32_t>(geometry.slices * geometry.sets)) {
    if (!ids.dense()) return;
    if (map_.is_low_bits() && geometry.sets <= 1u << LineIds::equal_bits) form_ = Form::low_bits;
    constexpr std::size_t most_runs = 8;
    if (map_.tables().empty() || instructions == InstructionSet::scalar || ids.runs().size() > most_runs) return;
    const auto& runs = ids.runs();
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const std::uint64_t end = i + 1 < runs.size() ? runs[i + 1].first : ids.bound();
        const std::uint64_t first = runs[i].first + runs[i].offset, last = end - 1 + runs[i].offset;
        if (first >> 32 != last >> 32) return;  // half of a line must do
        runs_.push_back({runs[i].first, static_cast<std::uint32_t>(runs[i].offset),
                         static_cast<std::uint32_t>(map_(first >> 32 << 32))});
    }
    find_by_tables_ = RAYCACHE_DISPATCH(find_by_tables, instructions);
    form_ = Form::tables;
}

}  // namespace raycache::cachesim
#endif
