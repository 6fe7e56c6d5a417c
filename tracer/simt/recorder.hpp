// Where a warp's accesses go: into a WarpTrace, or nowhere.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "traces/record.hpp"
#include "traces/symbols.hpp"

namespace raycache::tracer {

/// Where the lanes of one record, lowest first, write which element they read and which symbol of traces/FORMAT.md says
/// where they go next.
struct OpenRecord {
    std::uint32_t* element;
    std::uint8_t* symbol;
};

/// For rays that leave no trace; the calls compile to next to nothing.
class NullRecorder {
public:
    void kind(traces::RayType, std::uint8_t) {}
    std::uint32_t start_rays(std::uint32_t, std::uint8_t) { return 0; }
    OpenRecord open(std::uint32_t, std::uint8_t) { return {unread_, unread_symbols_}; }
    void close(const OpenRecord&) {}
    void repeat(std::uint32_t, std::uint8_t) {}
    std::uint32_t place(const std::uint8_t*) const { return 0; }
    void set_symbol(std::uint32_t, std::uint8_t) {}

private:
    std::uint32_t unread_[traces::warp_lanes];
    std::uint8_t unread_symbols_[traces::warp_lanes];
};

/// Collects the records of one warp. Reuse it for the next: its memory stays.
class WarpRecorder {
public:
    void clear() {
        records_.clear();
        used_elements_ = used_symbols_ = 0;
    }
    void kind(traces::RayType type, std::uint8_t bounce) {
        type_ = type;
        bounce_ = bounce;
    }

    /// Starts a ray in each lane of `mask`, all with the same symbol; returns the place of the first.
    std::uint32_t start_rays(std::uint32_t mask, std::uint8_t symbol) {
        records_.push_back({mask, traces::ray_start, type_, bounce_, 0});
        make_room();
        const auto first = static_cast<std::uint32_t>(used_symbols_);
        const unsigned lanes = records_.back().lanes();
        for (unsigned i = 0; i < lanes; ++i) symbols_[used_symbols_++] = symbol;
        return first;
    }

    /// An access by the lanes of `mask`. Write to the places returned and advance them; then close().
    OpenRecord open(std::uint32_t mask, std::uint8_t region) {
        records_.push_back({mask, region, type_, bounce_, 0});
        make_room();
        return {elements_.data() + used_elements_, symbols_.data() + used_symbols_};
    }
    void close(const OpenRecord& end) {
        used_elements_ = static_cast<std::size_t>(end.element - elements_.data());
        used_symbols_ = static_cast<std::size_t>(end.symbol - symbols_.data());
    }

    /// The lanes of the access closed last read the same elements of another region.
    void repeat(std::uint32_t mask, std::uint8_t region) {
        const OpenRecord out = open(mask, region);
        const unsigned lanes = records_.back().lanes();
        std::copy_n(out.element - lanes, lanes, out.element);
        std::fill_n(out.symbol, lanes, traces::symbol::end_of_ray);
        close({out.element + lanes, out.symbol + lanes});
    }

    /// A symbol is often known only when the lane goes on: names the place of a symbol, as long as clear() is not
    /// called.
    std::uint32_t place(const std::uint8_t* symbol) const {
        return static_cast<std::uint32_t>(symbol - symbols_.data());
    }
    void set_symbol(std::uint32_t place, std::uint8_t symbol) { symbols_[place] = symbol; }

    /// Copies what was recorded.
    void store(traces::WarpTrace& out) const {
        out.records = records_;
        out.elements.assign(elements_.begin(), elements_.begin() + static_cast<std::ptrdiff_t>(used_elements_));
    }
    void store_symbols(traces::WarpSymbols& out) const {
        out.assign(symbols_.begin(), symbols_.begin() + static_cast<std::ptrdiff_t>(used_symbols_));
    }

private:
    void make_room() {
        if (elements_.size() - used_elements_ < traces::warp_lanes) elements_.resize(2 * elements_.size() + 4096);
        if (symbols_.size() - used_symbols_ < traces::warp_lanes) symbols_.resize(2 * symbols_.size() + 4096);
    }

    std::vector<traces::Record> records_;
    std::vector<std::uint32_t> elements_;
    std::vector<std::uint8_t> symbols_;
    std::size_t used_elements_ = 0, used_symbols_ = 0;
    traces::RayType type_ = traces::RayType::camera;
    std::uint8_t bounce_ = 0;
};

}  // namespace raycache::tracer
