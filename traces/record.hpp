// What the tracer says and the cache model hears: one warp's memory accesses, in program order.
//
// A trace is a sequence of launches (one sample index each, or 32 consecutive ones with the `samples` thread map); a
// launch is a sequence of warps in dispatch order; a warp is a sequence of records. A record is either
//   * a warp access: the lanes of `mask` each read one whole object (a node, a triangle, a texel) of one region, or
//   * a ray start: the lanes of `mask` begin a ray of the given kind. It reads no memory; it only counts rays.
// A trace of a program's instructions also says what else a warp issues, and which access waits for which (IssueStep).
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

/// What a warp does beside its accesses, where the trace says so: it waits until what one access of its own reads is
/// there, and then issues instructions that access no memory of the trace. A warp issues in order: what stands behind a
/// step issues after it.
struct IssueStep {
    std::uint32_t access = 0;        ///< accesses (records) of the warp before this step
    std::uint32_t needs = 0;         ///< 0: it waits for nothing; n: for access number n - 1, which is one of those
    std::uint32_t instructions = 0;  ///< that follow

    bool operator==(const IssueStep&) const = default;
};

/// All records of one warp in one launch.
struct WarpTrace {
    std::uint32_t launch = 0;  ///< ordinal into Header::launches
    std::uint32_t warp = 0;    ///< ordinal of the warp in its launch, 0 … Header::warps_per_launch - 1
    std::vector<Record> records;
    /// For each access record in order, popcount(mask) element indices, lowest lane first. The byte address of an
    /// element is Region::base + index * Region::stride.
    std::vector<std::uint32_t> elements;
    /// Of a trace that says what waits for what (Header::issue), of a warp that accesses anything: its steps in order,
    /// at most two an access and one more, the last one behind all accesses. Else none: each access then waits for the
    /// one before it, and a GPU file says how many instructions a visit takes.
    std::vector<IssueStep> issue = {};

    void clear() {
        records.clear();
        elements.clear();
        issue.clear();
    }
    bool operator==(const WarpTrace&) const = default;
};

}  // namespace raycache::traces
