// A ray from the surface of a pixel, marched through a depth buffer: what screen-space ambient occlusion sends.
//
// The ray goes from P, the point of the pixel's centre, to Q = P + radius * d in the camera's frame, no nearer to the
// camera than the least depth of the picture. On the screen it is a straight line, along which 1 / z is linear (M.
// McGuire, M. Mara, "Efficient GPU screen-space ray tracing", JCGT 2014). Step i of n stands at the share
// (i + offset) / n of that line, in the pixel into which it falls; the pixel's centre at its stored depth is the point
// D. D blocks the ray if
//   * the ray is there behind it, by `thickness` at most:  0 < z(ray) - z(D) <= thickness
//     (the surface is taken to be that thick: what lies behind it no depth buffer knows), and
//   * it lies above the plane of P's surface, dot(D - P, n) > 0, by more than storing and arithmetic may be wrong: a
//     flat surface never blocks itself, at whatever angle it is seen.
// Outside the picture nothing blocks.
#pragma once

#include <algorithm>
#include <cstdint>

#include "tracer/paths/camera_rays.hpp"
#include "tracer/paths/depth_buffer.hpp"
#include "tracer/vec.hpp"

namespace raycache::tracer {

struct ScreenMarch {
    float radius = 1;         ///< metres, at least 0
    float thickness = 1;      ///< metres, at least 0
    std::uint32_t steps = 8;  ///< at least 1
};

class ScreenRay {
public:
    ScreenRay() = default;
    /// From the pixel (x, y), no sky. `direction`: unit, in the camera's frame; `offset`: of the steps, 0 … 1.
    ScreenRay(const DepthBuffer& depths, const CameraRays& camera, const ScreenMarch& march, std::uint32_t x,
              std::uint32_t y, Vec3 direction, float offset)
        : offset_(offset) {
        const std::uint32_t element = depths.element(x, y);
        reciprocal_ = depths.reciprocal(element);
        normal_ = depths.normal(element);
        from_ = centre(x, y);
        start_ = camera.unproject(from_, depths.near() / reciprocal_);
        Vec3 way = direction * march.radius;
        if (const float nearest = std::min(start_.z, depths.near()); start_.z + way.z < nearest)
            way = way * ((nearest - start_.z) / way.z);
        const Vec3 end = start_ + way;
        const Vec2 to = camera.project(end);
        along_ = {to.x - from_.x, to.y - from_.y};
        along_reciprocal_ = depths.near() / end.z - reciprocal_;
        error_ = depths.error_of(reciprocal_) * length(start_);
    }

    /// The pixel of a step; false where it lies outside the picture.
    bool step(std::uint32_t i, const DepthBuffer& depths, const ScreenMarch& march, std::uint32_t& x,
              std::uint32_t& y) {
        const float share = (static_cast<float>(i) + offset_) / static_cast<float>(march.steps);
        const float px = from_.x + along_.x * share, py = from_.y + along_.y * share;
        if (!(px >= 0 && py >= 0 && px < static_cast<float>(depths.width()) &&
              py < static_cast<float>(depths.height())))
            return false;
        x = static_cast<std::uint32_t>(px);
        y = static_cast<std::uint32_t>(py);
        here_ = reciprocal_ + along_reciprocal_ * share;
        return true;
    }

    /// Whether the surface of that pixel, the last that step() gave, blocks the ray. `stored`:
    /// DepthBuffer::reciprocal().
    bool is_blocked(float stored, std::uint32_t x, std::uint32_t y, const DepthBuffer& depths, const CameraRays& camera,
                    const ScreenMarch& march) const {
        if (!(stored > here_)) return false;
        const float depth = depths.near() / stored;
        if (depths.near() / here_ - depth > march.thickness) return false;
        const Vec3 surface = camera.unproject(centre(x, y), depth);
        const Vec3 apart = surface - start_;
        const float distance = length(surface);
        const float error = error_ + depths.error_of(stored) * distance + of_normal * length(apart) +
                            of_arithmetic * (distance + length(start_));
        return dot(apart, normal_) > error;
    }

private:
    static constexpr float of_normal = 0x1p-12F;      ///< of pack_unit()
    static constexpr float of_arithmetic = 0x1p-20F;  ///< a few roundings of float

    static Vec2 centre(std::uint32_t x, std::uint32_t y) {
        return {static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F};
    }

    Vec3 start_, normal_;   ///< P and n
    Vec2 from_, along_;     ///< on the screen: P, and from there to Q
    float reciprocal_ = 0;  ///< near / z of P
    float along_reciprocal_ = 0;
    float here_ = 0;  ///< near / z of the ray at the last step
    float offset_ = 0, error_ = 0;
};

}  // namespace raycache::tracer
