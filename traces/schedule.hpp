// Which record comes next in a warp, as far as the successors of its lanes tell. Shared by encoder and decoder.
// Internal to traces/.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::traces {

/// The rules follow a lock-step while-while traversal: a warp stays at nodes while any lane has a node to visit, then
/// tests triangles; in a run of triangle records only lanes that go on to the next triangle of their leaf take part.
class Schedule {
public:
    explicit Schedule(const Header& header) : regions_(static_cast<unsigned>(header.regions.size())) {
        for (unsigned r = 0; r < regions_; ++r) triangles_[r] = header.regions[r].kind == ObjectKind::triangle;
    }

    void start_warp() {
        waiting.fill(0);
        sequential = 0;
        previous_ = ray_start;
        ray = RayType::camera;
        bounce = 0;
    }

    /// `ray_start` if no lane waits.
    std::uint8_t predicted_region() const {
        if (previous_ != ray_start && running(previous_) != 0) return previous_;
        for (unsigned r = 0; r < regions_; ++r)
            if (waiting[r] != 0) return static_cast<std::uint8_t>(r);
        return ray_start;
    }

    std::uint32_t predicted_mask(std::uint8_t region) const {
        const std::uint32_t run = region == previous_ ? running(region) : 0;
        return run != 0 ? run : waiting[region];
    }

    /// Notes a record of either kind; its lanes wait for nothing until `successors` says otherwise.
    void begin(const Record& record) {
        previous_ = record.region;
        ray = record.ray;
        bounce = record.bounce;
        if (record.is_access()) waiting[record.region] &= ~record.mask;
        sequential &= ~record.mask;
    }

    std::uint32_t busy() const {
        std::uint32_t lanes = 0;
        for (unsigned r = 0; r < regions_; ++r) lanes |= waiting[r];
        return lanes;
    }

    std::array<std::uint32_t, 256> waiting{};  ///< per region, lanes whose successor is there
    std::uint32_t sequential = 0;              ///< lanes whose latest symbol was `sequential`
    RayType ray = RayType::camera;             ///< of the previous record
    std::uint8_t bounce = 0;                   ///< of the previous record

private:
    std::uint32_t running(std::uint8_t region) const {
        return triangles_[region] ? waiting[region] & sequential : waiting[region];
    }

    std::array<bool, 256> triangles_{};
    unsigned regions_;
    std::uint8_t previous_ = ray_start;
};

/// Collects the regions of the successors of one record's lanes, without a branch per lane.
class SuccessorMasks {
public:
    /// `bit` is that of the lane.
    [[gnu::always_inline]] void add(std::uint32_t bit, std::uint32_t word) {
        low_ |= bit & (0u - (word >> 30 & 1));
        high_ |= bit & (0u - (word >> 31));
    }
    /// Adds to `waiting` the lanes of `lanes` that were added here; returns those whose word can be no link.
    std::uint32_t spread(std::uint32_t lanes, std::array<std::uint32_t, 256>& waiting) const {
        waiting[0] |= lanes & ~low_ & ~high_;
        waiting[1] |= lanes & low_ & ~high_;
        waiting[2] |= lanes & ~low_ & high_;
        return lanes & low_ & high_;
    }

private:
    std::uint32_t low_ = 0, high_ = 0;
};

}  // namespace raycache::traces
