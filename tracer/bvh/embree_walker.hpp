// Walks rays by each of Embree's entry points, for programs that measure how long that takes: one ray at a time or in
// packets, with Embree told that a packet is coherent or that it is not. A render takes EmbreeScene, one ray at a time.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tracer/ray.hpp"
#include "tracer/scene/scene.hpp"
#include "tracer/scene/texel_layout.hpp"

namespace raycache::tracer {

class EmbreeParts;

/// One way to ask Embree.
struct WalkMode {
    std::string name;       ///< "single", "packet8", "packet8-coherent"
    unsigned width = 1;     ///< rays in a call: rtcIntersect1, 4, 8, 16
    bool coherent = false;  ///< RTC_INTERSECT_CONTEXT_FLAG_COHERENT, which Embree reads with packets only
};

/// All there are, single rays first.
const std::vector<WalkMode>& walk_modes();
/// Throws UsageError for an unknown name: lists the valid ones, and the closest.
const WalkMode& walk_mode(const std::string& name);

/// What Embree says of itself on this processor.
struct EmbreeFacts {
    std::string version;           ///< "3.13.5"
    std::string isa;               ///< the widest vectors it uses: "SSE", "AVX", "AVX2", "AVX-512"
    std::vector<unsigned> widths;  ///< of packets that it walks natively; without 1, which it always does

    bool walks(const WalkMode& mode) const;
};
/// Throws Error if Embree cannot start.
EmbreeFacts embree_facts();

/// The scene in Embree, as EmbreeScene has it with holes. Belongs to no thread.
class EmbreeWalker {
public:
    /// Of memory, about, for each triangle.
    static constexpr std::uint64_t triangle_bytes = 200;

    /// Both arguments must outlive it.
    EmbreeWalker(const Scene&, const TexelLayout&);
    ~EmbreeWalker();
    EmbreeWalker(const EmbreeWalker&) = delete;
    EmbreeWalker& operator=(const EmbreeWalker&) = delete;

    /// Nearest hits: ends[i] is the t of ray i's, infinity where it has none. A packet is `mode.width` rays that
    /// follow each other; the last may have fewer. EmbreeFacts::walks(mode) must hold.
    void closest(std::span<const Ray>, const WalkMode& mode, float* ends) const;
    /// Whether there is any hit: ends[i] is 0 where there is, else infinity.
    void occluded(std::span<const Ray>, const WalkMode& mode, float* ends) const;

private:
    std::unique_ptr<const EmbreeParts> scene_;
};

}  // namespace raycache::tracer
