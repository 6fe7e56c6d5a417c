// One visit of a warp as the load instructions and sector requests that a compiler and a front end make of it.
//
// An object is read by loads of load_bytes at a time, all lanes together: load k reads bytes [k * load_bytes, …) of
// every lane's object. The lanes of a load go to the tag stage in groups (FrontEnd::lanes_per_request_*); lanes of one
// group that read the same sector share one request.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>

#include "cachesim/cache/line_ids.hpp"
#include "cachesim/gpus/gpu.hpp"
#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

/// How the objects of one region are loaded.
struct LoadShape {
    LoadShape(const traces::Region& region, std::size_t number, const FrontEnd& front_end, const CacheGeometry& l1,
              const LineIds& ids)
        : base(region.base),
          stride(region.stride),
          pages(region.pages),
          load_bytes(std::min(front_end.load_bytes, std::bit_ceil(region.element_size))),
          loads((region.element_size + load_bytes - 1) / load_bytes),
          last_bytes(region.element_size - (loads - 1) * load_bytes),
          lanes_per_request(load_bytes >= 16  ? front_end.lanes_per_request_16
                            : load_bytes >= 8 ? front_end.lanes_per_request_8
                                              : front_end.lanes_per_request_4),
          sector_shift(std::countr_zero(l1.sector_bytes)) {
        const std::uint64_t page = std::uint64_t{most_banks} * l1.sector_bytes, place = base | stride;
        const std::uint64_t pieces = (base % page + std::uint64_t{region.count} * stride) / load_bytes;
        apart = lanes_per_request == traces::warp_lanes && place % load_bytes == 0 && load_bytes <= l1.sector_bytes &&
                last_bytes <= l1.sector_bytes && stride >= l1.sector_bytes && ids.dense() &&
                pieces < std::uint64_t{1} << 31 && page >= l1.line_bytes;
        if (!apart) return;
        first_piece = static_cast<std::uint32_t>(base % page / load_bytes);
        piece_stride = static_cast<std::uint32_t>(stride / load_bytes);
        first_id = static_cast<std::uint32_t>(base / page * page / l1.line_bytes - ids.offset(number));
        sector_of_piece = sector_shift - std::countr_zero(load_bytes);
        steady = place % l1.sector_bytes == 0 && l1.line_bytes % stride == 0 && base % l1.line_bytes == 0 &&
                 region.element_size <= stride;
    }

    static constexpr std::uint32_t most_banks = 32;

    std::uint64_t base, stride;
    traces::PageTable pages;
    std::uint32_t load_bytes, loads, last_bytes;  ///< last_bytes: what the last load reads
    std::uint32_t lanes_per_request;
    int sector_shift;

    /// All lanes go together, no load straddles sectors, and no two elements share one at the same place: every load
    /// asks for one sector of each distinct element. Places are counted in pieces of load_bytes, from the start of the
    /// line whose id is first_id.
    bool apart = false;
    std::uint32_t first_piece = 0, piece_stride = 0, first_id = 0;
    int sector_of_piece = 0;  ///< log2 of pieces per sector

    /// Moreover no element straddles lines, and all begin with a sector: loads of a visit take the port equally long.
    bool steady = false;

    /// First and last sector that load k reads of an element, given as Visit has it.
    std::uint64_t first_sector(std::uint32_t place, std::uint32_t k) const {
        return (address(place) + std::uint64_t{k} * load_bytes) >> sector_shift;
    }
    std::uint64_t last_sector(std::uint32_t place, std::uint32_t k) const {
        const std::uint32_t bytes = k + 1 == loads ? last_bytes : load_bytes;
        return (address(place) + std::uint64_t{k} * load_bytes + bytes - 1) >> sector_shift;
    }

private:
    std::uint64_t address(std::uint32_t place) const {
        if (apart) return base + (std::uint64_t{place} - first_piece) * load_bytes;
        return pages.empty() ? base + place * stride : pages.address(place * stride);
    }
};

/// The distinct elements that each group of lanes reads, in descending order; of LoadShape::apart, the places of their
/// first pieces.
class Visit {
public:
    /// `mask`: lanes of one vector of `simd_width`.
    void begin(const LoadShape& shape, std::uint32_t mask, const std::uint32_t* elements, unsigned simd_width) {
        count_ = 0;
        ends_ = 0;
        empty_behind_ = 0;
        if (shape.lanes_per_request == traces::warp_lanes) {
            add_group(elements, static_cast<unsigned>(std::popcount(mask)));
            if (shape.apart)
                for (unsigned i = 0; i < count_; ++i)
                    elements_[i] = shape.first_piece + elements_[i] * shape.piece_stride;
            return;
        }
        const unsigned first =
            static_cast<unsigned>(std::countr_zero(mask)) & ~(std::max(simd_width, shape.lanes_per_request) - 1);
        for (unsigned lane = first; lane < first + simd_width; lane += shape.lanes_per_request) {
            const std::uint32_t group = mask >> lane & ((1u << shape.lanes_per_request) - 1);
            if (!group) {
                ++empty_behind_;
                continue;
            }
            empty_before_[count_] = static_cast<std::uint8_t>(std::exchange(empty_behind_, 0));
            const auto lanes = static_cast<unsigned>(std::popcount(group));
            add_group(elements, lanes);
            elements += lanes;
        }
    }

    unsigned count() const { return count_; }
    std::uint32_t operator[](unsigned i) const { return elements_[i]; }
    const std::uint32_t* data() const { return elements_.data(); }
    /// Whether element i is the last of its group.
    bool ends_group(unsigned i) const { return ends_ >> i & 1; }
    /// Groups without an active lane, where lanes go in several: right before the one that element i is the first of,
    /// and behind the last.
    unsigned empty_before(unsigned i) const { return empty_before_[i]; }
    unsigned empty_behind() const { return empty_behind_; }

private:
    void add_group(const std::uint32_t* elements, unsigned lanes) {
        std::uint32_t* const out = &elements_[count_];
        unsigned n = 0;
        for (unsigned lane = 0; lane < lanes; ++lane) {  // insertion: few elements, mostly in order or equal
            const std::uint32_t element = elements[lane];
            unsigned at = n;
            while (at > 0 && out[at - 1] < element) --at;
            if (at > 0 && out[at - 1] == element) continue;
            for (unsigned i = n; i > at; --i) out[i] = out[i - 1];
            out[at] = element;
            ++n;
        }
        count_ += n;
        ends_ |= 1u << (count_ - 1);
    }

    unsigned count_ = 0, empty_behind_ = 0;
    std::uint32_t ends_ = 0;
    std::array<std::uint32_t, traces::warp_lanes> elements_{};
    std::array<std::uint8_t, traces::warp_lanes> empty_before_{};  ///< by the first element of a group
};

}  // namespace raycache::cachesim
