// The sets that lines go to, for many look-ups at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cachesim/cache/line_ids.hpp"
#include "cachesim/cache/line_map.hpp"
#include "cachesim/cache/lookups.hpp"
#include "cachesim/instruction_set.hpp"

namespace raycache::cachesim {

class SetFinder {
public:
    /// `ids` must outlive this object.
    SetFinder(const CacheGeometry&, const LineIds& ids, InstructionSet);

    /// Sets of the look-ups, numbered through all caches of the level. Of the access behind a look-up,
    /// region_of(access) and cache_of(access) say where its line lies and which cache is asked.
    template <class RegionOf, class CacheOf>
    const std::uint32_t* operator()(const Lookups& lookups, const RegionOf& region_of, const CacheOf& cache_of) {
        if (sets_.size() < lookups.count + room) sets_.resize(2 * lookups.count + room);
        const std::uint32_t* const lines = lookups.lines.data();
        const std::uint32_t* const accesses = lookups.accesses.data();
        std::uint32_t* const sets = sets_.data();
        switch (form_) {
            case Form::low_bits:
                for (std::size_t i = 0; i < lookups.count; ++i) sets[i] = lines[i] & (sets_per_cache_ - 1);
                break;
            case Form::tables:
                find_by_tables(lookups);
                break;
            case Form::any:
                for (std::size_t i = 0; i < lookups.count; ++i)
                    sets[i] = static_cast<std::uint32_t>(map_(ids_.line(lines[i], region_of(accesses[i]))));
                break;
        }
        for (std::size_t i = 0; i < lookups.count; ++i) sets[i] += cache_of(accesses[i]) * sets_per_cache_;
        return sets;
    }

private:
    enum class Form {
        low_bits,  ///< one slice, linear sets, and an id has the low bits of its line
        tables,    ///< LineMap::tables(), sixteen lines at once
        any,
    };
    static constexpr std::size_t room = 16;  ///< for a vector that is written beyond the last look-up

    void find_by_tables(const Lookups&);

    LineMap map_;
    const LineIds& ids_;
    std::uint32_t sets_per_cache_;
    Form form_ = Form::any;
    /// Form::tables: of each run of ids, the low half of its lines' offset and what the high half contributes.
    struct Run {
        std::uint32_t first, offset, high;
    };
    std::vector<Run> runs_;
    std::vector<std::uint32_t> sets_;
};

}  // namespace raycache::cachesim
