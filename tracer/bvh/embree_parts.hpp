// What Embree makes of a scene: device, geometries with their filters, and the committed BVH. For the files of this
// folder that ask it; everyone else takes EmbreeScene or EmbreeWalker.
#pragma once

#include <embree3/rtcore.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "tracer/ray.hpp"
#include "tracer/scene/scene.hpp"
#include "tracer/scene/texel_layout.hpp"

namespace raycache::tracer {

class EmbreeParts {
public:
    /// `holes`: where alpha-masked materials have them; null: nowhere. Both must outlive it. The tree is built on one
    /// thread: with more, the order of triangles in it, and with it which of two coinciding ones is found, depends on
    /// timing. Throws Error where Embree cannot start or build.
    EmbreeParts(const Scene&, const TexelLayout* holes);
    EmbreeParts(const EmbreeParts&) = delete;
    EmbreeParts& operator=(const EmbreeParts&) = delete;

    RTCScene handle() const { return scene_.get(); }
    /// Of a hit: the triangle of the scene.
    std::uint32_t triangle(std::uint32_t geometry, std::uint32_t primitive) const {
        return parts_[geometry].triangle(primitive);
    }

    /// What Embree takes: beyond it asserts, or where those are off answers at random. A ray that rounding or a scene
    /// of extreme size has spoilt meets nothing.
    static bool takes(const Ray&);

    /// rtcIntersect1: whether there is a hit, which `found` then has.
    bool closest(const Ray& ray, RTCIntersectContext& context, RTCRayHit& found) const {
        if (!takes(ray)) return false;
        found.ray = query(ray);
        found.hit.geomID = found.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(handle(), &context, &found);
        return found.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }
    /// rtcOccluded1
    bool occluded(const Ray& ray, RTCIntersectContext& context) const {
        if (!takes(ray)) return false;
        RTCRay asked = query(ray);
        rtcOccluded1(handle(), &context, &asked);
        return asked.tfar < 0;
    }

private:
    /// Some of the scene's triangles. Those that may have holes and those too wide for float are geometries of their
    /// own: only they need a filter.
    struct Part {
        const EmbreeParts* owner;
        std::vector<std::uint32_t> triangles;  ///< scene triangle of each primitive; empty: all, in order
        std::uint32_t triangle(std::uint32_t primitive) const {
            return triangles.empty() ? primitive : triangles[primitive];
        }
    };
    enum : std::uint32_t { plain, holed, giant, part_count };
    struct Release {
        void operator()(RTCDevice handle) const { rtcReleaseDevice(handle); }
        void operator()(RTCScene handle) const { rtcReleaseScene(handle); }
    };

    static RTCRay query(const Ray&);
    std::uint32_t part_of(std::uint32_t triangle) const;
    Vec3 vertex(std::uint32_t triangle, std::size_t k) const;
    void attach(std::uint32_t part, std::size_t count);
    static void skip_holes(const RTCFilterFunctionNArguments*);
    static void skip_behind(const RTCFilterFunctionNArguments*);

    const Scene* scene_data_;
    const TexelLayout* texels_;
    Part parts_[part_count]{{this, {}}, {this, {}}, {this, {}}};
    std::unique_ptr<RTCDeviceTy, Release> device_;
    std::unique_ptr<RTCSceneTy, Release> scene_;
};

}  // namespace raycache::tracer
