// Where a warp's accesses go: into a WarpTrace, or nowhere.
#pragma once

#include <cstdint>
#include <vector>

#include "traces/record.hpp"

namespace raycache::tracer {

/// Renders need no trace; the calls compile to nothing.
class NullRecorder {
public:
    void kind(traces::RayType, std::uint8_t) {}
    void start_rays(std::uint32_t) {}
    std::uint32_t* open(std::uint32_t, std::uint8_t) { return unread_; }
    void close(const std::uint32_t*) {}

private:
    std::uint32_t unread_[traces::warp_lanes];
};

/// Collects the records of one warp. Reuse it for the next: its memory stays.
class WarpRecorder {
public:
    void clear() {
        records_.clear();
        used_ = 0;
    }
    void kind(traces::RayType type, std::uint8_t bounce) {
        type_ = type;
        bounce_ = bounce;
    }
    void start_rays(std::uint32_t mask) { records_.push_back({mask, traces::ray_start, type_, bounce_, 0}); }

    /// An access by the lanes of `mask`: write their elements to the returned place, lowest lane first, and close() at
    /// its end.
    std::uint32_t* open(std::uint32_t mask, std::uint8_t region) {
        records_.push_back({mask, region, type_, bounce_, 0});
        if (elements_.size() - used_ < traces::warp_lanes) elements_.resize(2 * elements_.size() + 4096);
        return elements_.data() + used_;
    }
    void close(const std::uint32_t* end) { used_ = static_cast<std::size_t>(end - elements_.data()); }

    /// Copies what was recorded.
    void store(traces::WarpTrace& out) const {
        out.records = records_;
        out.elements.assign(elements_.begin(), elements_.begin() + static_cast<std::ptrdiff_t>(used_));
    }

private:
    std::vector<traces::Record> records_;
    std::vector<std::uint32_t> elements_;
    std::size_t used_ = 0;
    traces::RayType type_ = traces::RayType::camera;
    std::uint8_t bounce_ = 0;
};

}  // namespace raycache::tracer
