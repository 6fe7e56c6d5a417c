// Records what an integrator reads that walks no BVH (IntegratorEntry::walks_bvh), for a trace that then has none.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "tracer/paths/traversal.hpp"
#include "tracer/simt/recorder.hpp"
#include "traces/error.hpp"

namespace raycache::tracer {

class RegionTraversal final : public Traversal {
public:
    /// `first_region`: index of the first region of the integrator's own.
    RegionTraversal(WarpRecorder& recorder, std::uint8_t first_region)
        : recorder_(recorder), first_region_(first_region) {}

    // There is nothing to walk or to shade. Throw Error.
    void closest(std::uint32_t, traces::RayType, std::uint8_t, const Ray*, Hit*) override { refuse(); }
    std::uint32_t occluded(std::uint32_t, traces::RayType, std::uint8_t, const Ray*) override { refuse(); }
    void read_texels(std::uint32_t, traces::RayType, std::uint8_t, const std::uint32_t*) override { refuse(); }

    void start(std::uint32_t mask, traces::RayType type, std::uint8_t bounce) override {
        recorder_.kind(type, bounce);
        std::uint32_t symbol = recorder_.start_rays(mask, traces::symbol::end_of_ray);
        for (; mask != 0; mask &= mask - 1) last_symbol_[static_cast<unsigned>(std::countr_zero(mask))] = symbol++;
    }

    void read_region(std::uint32_t mask, traces::RayType type, std::uint8_t bounce, std::uint8_t region,
                     const std::uint32_t* elements) override {
        recorder_.kind(type, bounce);
        OpenRecord out = recorder_.open(mask, static_cast<std::uint8_t>(first_region_ + region));
        std::uint32_t symbol = recorder_.place(out.symbol);
        for (; mask != 0; mask &= mask - 1) {
            const auto l = static_cast<unsigned>(std::countr_zero(mask));
            recorder_.set_symbol(last_symbol_[l], traces::symbol::literal);
            last_symbol_[l] = symbol++;
            *out.element++ = elements[l];
            *out.symbol++ = traces::symbol::end_of_ray;
        }
        recorder_.close(out);
    }

private:
    [[noreturn]] static void refuse() {
        throw Error("an integrator that says it walks no BVH asked for one: set walks_bvh in its entry");
    }

    WarpRecorder& recorder_;
    std::uint8_t first_region_;
    std::array<std::uint32_t, traces::warp_lanes> last_symbol_{};  ///< by lane, its place
};

}  // namespace raycache::tracer
