// What the tracer says and the cache model hears: one warp's memory accesses, in program order.
//
// A trace is a sequence of launches (one sample index each, or 32 consecutive ones with the `samples` thread map); a
// launch is a sequence of warps in dispatch order; a warp is a sequence of records. A record is either
//   * a warp access: the lanes of `mask` each read one whole object (a node, a triangle, a texel) of one region, or
//   * a ray start: the lanes of `mask` begin a ray of the given kind. It reads no memory; it only counts rays.
// The trace says *what* is read; how a GPU splits an object into load instructions is the business of its preset.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

namespace raycache::traces {

/// Lanes of a warp. Fixed by the format: a CPU's narrower vectors are formed from it by the replay.
inline constexpr unsigned warp_lanes = 32;

/// What a ray is for. Stored in the file: append only.
enum class RayType : std::uint8_t { camera = 0, bounce = 1, shadow = 2 };
inline constexpr unsigned ray_types = 3;

/// Highest bounce number a record can carry.
inline constexpr unsigned max_bounce = 255;

/// `region` of a ray-start record.
inline constexpr std::uint8_t ray_start = 0xff;

/// One record. 8 bytes; the element indices of its lanes stand in WarpTrace::elements.
struct Record {
    std::uint32_t mask = 0;   ///< active lanes, bit l = lane l; never 0
    std::uint8_t region = 0;  ///< index into Header::regions, or `ray_start`
    RayType ray = RayType::camera;
    /// Path vertex the ray belongs to. Camera rays: 0. Bounce rays: 1 for the first bounce. Shadow rays: the bounce
    /// number of the ray whose hit they leave from, so 0 at the camera hit.
    std::uint8_t bounce = 0;
    std::uint8_t reserved = 0;  ///< always 0

    bool is_access() const { return region != ray_start; }
    unsigned lanes() const { return static_cast<unsigned>(std::popcount(mask)); }
    bool operator==(const Record&) const = default;
};
static_assert(sizeof(Record) == 8);

/// All records of one warp in one launch.
struct WarpTrace {
    std::uint32_t launch = 0;  ///< ordinal into Header::launches
    std::uint32_t warp = 0;    ///< ordinal of the warp in its launch, 0 … Header::warps_per_launch - 1
    std::vector<Record> records;
    /// For each access record in order, popcount(mask) element indices, lowest lane first. The byte address of an
    /// element is Region::base + index * Region::stride.
    std::vector<std::uint32_t> elements;

    void clear() {
        records.clear();
        elements.clear();
    }
    bool operator==(const WarpTrace&) const = default;
};

}  // namespace raycache::traces
