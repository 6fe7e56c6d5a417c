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

/// Form::tables: of a run of ids, the low half of its lines' offset and what the high half contributes to a set.
struct SetRun {
    std::uint32_t first, offset, high;
};

class SetFinder {
public:
    /// `ids` must outlive this object.
    SetFinder(const CacheGeometry&, const LineIds& ids, InstructionSet);

    /// Sets of the look-ups in a cache. Of the access behind a look-up, region_of(access) says where its line lies.
    /// `place`: where the sets may be put.
    template <class RegionOf>
    std::uint32_t* operator()(const Lookups& lookups, const RegionOf& region_of,
                              std::vector<std::uint32_t>& place) const {
        if (place.size() < lookups.count + room) place.resize(2 * lookups.count + room);
        const std::uint32_t* const lines = lookups.lines.data();
        const std::uint32_t* const accesses = lookups.accesses.data();
        std::uint32_t* const sets = place.data();
        switch (form_) {
            case Form::low_bits:
                for (std::size_t i = 0; i < lookups.count; ++i) sets[i] = lines[i] & (sets_per_cache_ - 1);
                break;
            case Form::tables:
                find_by_tables_(lines, lookups.count, runs_, map_, sets);
                break;
            case Form::any:
                for (std::size_t i = 0; i < lookups.count; ++i)
                    sets[i] = static_cast<std::uint32_t>(map_(ids_.line(lines[i], region_of(accesses[i]))));
                break;
        }
        return sets;
    }

    /// The same, numbered through some caches, of which cache_of(access) is asked.
    template <class RegionOf, class CacheOf>
    const std::uint32_t* operator()(const Lookups& lookups, const RegionOf& region_of, const CacheOf& cache_of,
                                    std::vector<std::uint32_t>& place) const {
        std::uint32_t* const sets = (*this)(lookups, region_of, place);
        for (std::size_t i = 0; i < lookups.count; ++i) sets[i] += cache_of(lookups.accesses[i]) * sets_per_cache_;
        return sets;
    }

private:
    enum class Form {
        low_bits,  ///< one slice, linear sets, and an id has the low bits of its line
        tables,    ///< LineMap::tables(), a vector of lines at once
        any,
    };
    static constexpr std::size_t room = 16;  ///< for a vector that is written beyond the last look-up

    LineMap map_;
    const LineIds& ids_;
    std::uint32_t sets_per_cache_;
    Form form_ = Form::any;
    std::vector<SetRun> runs_;
    void (*find_by_tables_)(const std::uint32_t* lines, std::size_t count, const std::vector<SetRun>&, const LineMap&,
                            std::uint32_t* sets) = nullptr;  ///< for the instruction set
};

}  // namespace raycache::cachesim
