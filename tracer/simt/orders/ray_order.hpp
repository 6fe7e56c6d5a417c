// How the rays of a wavefront are regrouped before they form warps: a sort key per ray, and what the sort costs.
// One file per order in this folder, one line each in registry.cpp.
//
// A key is a pure function of the ray and of what the order took from the scene when it was made: const, no state, safe
// from any thread. Rays are sorted by ascending key; equal keys keep their order, so the result is deterministic.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tracer/ray.hpp"
#include "tracer/scene/scene.hpp"

namespace raycache::tracer {

class RayOrder {
public:
    virtual ~RayOrder() = default;
    virtual std::uint32_t key(const Ray&) const = 0;
    /// Keys are below 2^key_bits(); 1 … 32. Decides how many passes the radix sort takes.
    virtual unsigned key_bits() const = 0;
    /// Whether runs of equal keys are sorted as one (Garanzha & Loop).
    virtual bool compresses_runs() const { return false; }
};

struct RayOrderEntry {
    std::string name, description;
    /// Null for `none`, which leaves rays as they come. The scene is not kept.
    std::unique_ptr<RayOrder> (*make)(const Scene&);
};
const std::vector<RayOrderEntry>& ray_orders();

/// Throws UsageError for an unknown name, listing the valid ones.
const RayOrderEntry& ray_order_entry(const std::string& name);

/// The permutation that sorts these keys, stably: element i of the result is the index of the ray that comes i-th.
std::vector<std::uint32_t> sorted_indices(const std::vector<std::uint32_t>& keys);

}  // namespace raycache::tracer
