// Who walks the rays of a package: a GPU (cuda_backend.cu), or the processor here (cpu_backend.cpp), which stands in
// where there is none, so that everything but the launches themselves is tested without.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tools/gpu/device_facts.hpp"
#include "tools/gpu/package/package.hpp"
#include "tools/gpu/walk.hpp"

namespace raycache::gpu {

struct BackendOptions {
    std::uint32_t device = 0;       ///< number of the GPU
    std::uint32_t block_warps = 8;  ///< warps of a CTA
};

/// Warps, each of which walks batches one after the other: warp w those from firsts[w] on, up to firsts[w + 1].
struct WarpPlan {
    std::vector<Batch> batches;
    std::vector<std::uint32_t> firsts;  ///< one more than warps
    std::uint64_t rays = 0;

    std::uint32_t warps() const { return static_cast<std::uint32_t>(firsts.size() - 1); }
};

class Backend {
public:
    virtual ~Backend() = default;
    virtual DeviceFacts facts() const = 0;
    /// Whether the seconds that walk() returns mean anything.
    virtual bool is_timed() const = 0;

    // Throw Error where the device has no room.
    virtual void load(const BvhFile&) = 0;
    /// A launch of it; forgets the one before, and its plan.
    virtual void load(const LaunchPart&) = 0;
    virtual void load(const WarpPlan&) = 0;

    /// Forgets all hits. Then finds those of the plan's rays, counting what is read.
    virtual Visits walk_counting() = 0;
    /// As a GPU would walk without an audience; seconds.
    virtual double walk() = 0;
    /// The hits found since; a ray not walked has bits that no hit has.
    virtual std::vector<Hit> hits() const = 0;
    /// Makes the next walk start with an L2 that holds none of the package.
    virtual void flush_l2() = 0;

protected:
    Backend() = default;
    Backend(const Backend&) = default;
    Backend(Backend&&) = default;
    Backend& operator=(const Backend&) = default;
    Backend& operator=(Backend&&) = default;
};

/// Each program links one. Throws Error: no device, or one that is too old.
std::unique_ptr<Backend> make_backend(const BackendOptions&);
/// As the program calls itself.
const char* program_name();

}  // namespace raycache::gpu
