// Regions of the trace format for objects that lie anywhere in memory.
//
// Objects of one size, those that are read and those that are written apart, get regions without gaps where those can
// have them: elements at base + i * stride, the base a multiple of 2 MiB, the stride their size, less than 2^30 of
// them. Where they cannot (objects of 48 B at multiples of 16), or where the lanes of one access might lie in two of
// them, they get one region of pages (Region::pages): an access is one record, however far apart its lanes are.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "traces/header.hpp"
#include "traces/loads/address_set.hpp"
#include "traces/loads/load_access.hpp"
#include "traces/memory_budget.hpp"

namespace raycache::traces {

class RegionPlan {
public:
    /// `file` is named in errors.
    RegionPlan(MemoryBudget& budget, std::string file) : budget_(budget), file_(std::move(file)) {}

    /// To be called with every access.
    void add(const LoadAccess&);

    /// Then once: the regions. Throws Error if the format cannot have so many objects.
    std::vector<Region> regions();

    /// Then, of any access that was added: its record's region, and its elements appended. Throws Error if it was not.
    std::uint8_t place(const LoadAccess&, std::vector<std::uint32_t>& elements);

private:
    /// A region without gaps: its first and last element in use.
    struct Range {
        std::uint64_t first = 0, last = 0;
        Region region;
        std::uint8_t number = 0;
    };
    struct Objects {
        explicit Objects(std::uint32_t grain) : addresses(grain) {}
        AddressSet addresses;
        std::uint64_t widest = 0;  ///< between lanes of an access
        std::vector<Range> ranges;
        std::unordered_map<std::uint64_t, std::uint64_t> page_places;  ///< in the region of pages, if not empty
        std::uint32_t stride = 0;
        std::uint8_t number = 0;  ///< of that region
    };

    void cover(std::uint32_t size, Objects&, const std::vector<std::uint64_t>& pages);
    Region region_of_pages(std::uint32_t size, Objects&, std::vector<std::uint64_t> pages);
    [[noreturn]] void refuse_change() const;

    MemoryBudget& budget_;
    std::string file_;
    /// Size and grain, and whether they are written.
    using Key = std::tuple<std::uint32_t, std::uint32_t, bool>;
    static Key key_of(const LoadAccess& a) { return {a.bytes, a.grain, a.is_store}; }

    std::map<Key, Objects> objects_;
};

}  // namespace raycache::traces
