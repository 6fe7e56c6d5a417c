#include "traces/loads/region_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <numeric>

#include "traces/error.hpp"
#include "traces/format.hpp"

namespace raycache::traces {
namespace {

constexpr std::uint64_t base_step = format::region_alignment;
constexpr std::uint64_t most_elements = format::max_elements;

/// A base with first = base + i * stride for some i; false if there is none.
bool find_base(std::uint64_t first, std::uint64_t stride, std::uint64_t& base) {
    base = first / base_step * base_step;
    // Bases repeat modulo the stride after at most `stride` steps.
    for (std::uint64_t steps = 0; steps < stride; ++steps, base -= base_step) {
        if ((first - base) % stride == 0) return true;
        if (base < base_step) return false;
    }
    return false;
}

}  // namespace

void RegionPlan::add(const LoadAccess& access) {
    auto at = objects_.find(key_of(access));
    if (at == objects_.end()) at = objects_.try_emplace(key_of(access), access.grain).first;
    Objects& objects = at->second;
    std::uint64_t lowest = ~std::uint64_t{0}, highest = 0;
    for (unsigned i = 0; i < access.lanes(); ++i) {
        objects.addresses.add(access.addresses[i], budget_, file_);
        lowest = std::min(lowest, access.addresses[i]);
        highest = std::max(highest, access.addresses[i]);
    }
    objects.widest = std::max(objects.widest, highest - lowest);
}

/// Regions without gaps, as few as possible; none if they cannot have the objects. Objects whose size is no power of
/// two begin a new region after a gap of 16 MiB, since different arrays of them seldom fit one.
void RegionPlan::cover(std::uint32_t size, Objects& objects, const std::vector<std::uint64_t>& pages) {
    const std::uint64_t gap = std::has_single_bit(size) ? ~std::uint64_t{0} : std::uint64_t{1} << 24;
    // The search for a base may put up to `size` steps before the first element in use.
    const std::uint64_t most_span = size * (most_elements - 1) - size * base_step;
    auto& ranges = objects.ranges;
    std::uint64_t spacing = 0;  // divides all distances within a region
    bool possible = true;
    const auto close = [&] {
        if (ranges.empty()) return;
        Range& range = ranges.back();
        Region& region = range.region;
        region.element_size = region.stride = size;
        possible &=
            spacing % size == 0 && find_base(range.first, size, region.base) && region.base <= format::max_address;
        region.count = static_cast<std::uint32_t>((range.last - region.base) / size + 1);
    };
    objects.addresses.each(pages, [&](std::uint64_t address) {
        if (!possible) return;
        if (ranges.empty() || address - ranges.back().last > gap || address - ranges.back().first > most_span) {
            close();
            // Lanes of one access may lie on both sides.
            if (!ranges.empty()) possible &= address - ranges.back().last > objects.widest;
            possible &= ranges.size() < format::max_regions;
            ranges.push_back({address, address, {}, 0});
            spacing = 0;
            return;
        }
        spacing = std::gcd(spacing, address - ranges.back().first);
        ranges.back().last = address;
    });
    close();
    if (!possible) ranges.clear();
}

Region RegionPlan::region_of_pages(std::uint32_t size, Objects& objects, std::vector<std::uint64_t> pages) {
    Region region;
    region.element_size = size;
    region.stride = objects.stride = objects.addresses.alignment();
    const std::uint64_t of_page = PageTable::page_bytes / region.stride;
    if (pages.size() > most_elements / of_page)
        throw Error(
            fmt::format("{}: objects of {} B at multiples of {}: expected them in at most {} pages of {} B, found {}; "
                        "trace a kernel that reads less memory",
                        file_, size, region.stride, most_elements / of_page, PageTable::page_bytes, pages.size()));
    budget_.charge(64 * pages.size(), file_, "pages of its loads");
    for (std::size_t i = 0; i < pages.size(); ++i) objects.page_places.emplace(pages[i], i);
    // Elements up to the last one in use.
    std::uint64_t last = 0;
    objects.addresses.each({pages.back()}, [&](std::uint64_t address) { last = address; });
    region.count =
        static_cast<std::uint32_t>((pages.size() - 1) * of_page + last % PageTable::page_bytes / region.stride + 1);
    region.pages = PageTable(std::move(pages));
    return region;
}

std::vector<Region> RegionPlan::regions() {
    std::vector<Region> regions;
    std::size_t sizes_left = objects_.size();
    for (auto& [key, objects] : objects_) {
        std::vector<std::uint64_t> pages = objects.addresses.page_numbers();
        const std::uint32_t size = std::get<0>(key);
        cover(size, objects, pages);
        // Room for one region of each size that follows.
        if (regions.size() + objects.ranges.size() + --sizes_left > format::max_regions) objects.ranges.clear();
        const std::size_t first = regions.size();
        objects.number = static_cast<std::uint8_t>(first);
        for (Range& range : objects.ranges) {
            range.number = static_cast<std::uint8_t>(regions.size());
            regions.push_back(range.region);
        }
        if (objects.ranges.empty()) regions.push_back(region_of_pages(size, objects, std::move(pages)));
        for (std::size_t i = first; i < regions.size(); ++i)
            regions[i].kind = std::get<bool>(key) ? ObjectKind::ray_state_write : ObjectKind::node;
    }
    if (regions.size() > format::max_regions)
        throw Error(fmt::format("{}: expected objects of at most {} sizes, found more; import without --fuse", file_,
                                format::max_regions));
    return regions;
}

std::uint8_t RegionPlan::place(const LoadAccess& access, std::vector<std::uint32_t>& elements) {
    const auto found = objects_.find(key_of(access));
    if (found == objects_.end()) refuse_change();
    Objects& objects = found->second;
    if (objects.ranges.empty()) {
        const std::uint64_t of_page = PageTable::page_bytes / objects.stride;
        for (unsigned i = 0; i < access.lanes(); ++i) {
            const std::uint64_t address = access.addresses[i];
            const auto at = objects.page_places.find(address >> PageTable::page_bits);
            if (at == objects.page_places.end() || address % objects.stride != 0) refuse_change();
            elements.push_back(
                static_cast<std::uint32_t>(at->second * of_page + address % PageTable::page_bytes / objects.stride));
        }
        return objects.number;
    }
    const auto after = std::upper_bound(objects.ranges.begin(), objects.ranges.end(), access.addresses[0],
                                        [](std::uint64_t a, const Range& r) { return a < r.first; });
    if (after == objects.ranges.begin()) refuse_change();
    const Range& range = *std::prev(after);
    for (unsigned i = 0; i < access.lanes(); ++i) {
        const std::uint64_t address = access.addresses[i];
        if (address < range.first || address > range.last || (address - range.region.base) % access.bytes != 0)
            refuse_change();
        elements.push_back(static_cast<std::uint32_t>((address - range.region.base) / access.bytes));
    }
    return range.number;
}

void RegionPlan::refuse_change() const {
    throw Error(
        fmt::format("{}: expected the same loads when it was read again, found others; nothing may change the "
                    "file while it is read",
                    file_));
}

}  // namespace raycache::traces
