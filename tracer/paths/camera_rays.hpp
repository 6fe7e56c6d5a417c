// Primary rays of a pinhole camera.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "tracer/ray.hpp"
#include "tracer/scene/scene.hpp"

namespace raycache::tracer {

class CameraRays {
public:
    CameraRays(const Camera& camera, std::uint32_t width, std::uint32_t height)
        : eye_(camera.eye),
          forward_(camera.forward),
          half_height_(std::fabs(std::tan(camera.vertical_fov * (std::numbers::pi_v<float> / 360.0F)))),
          width_(static_cast<float>(width)),
          height_(static_cast<float>(height)) {
        right_ = normalize(cross(camera.forward, camera.up));
        up_ = cross(right_, camera.forward);
    }

    /// Through the point `offset` in [0,1)^2 of pixel (x, y); (0, 0) is the top left corner of the picture.
    Ray ray(std::uint32_t x, std::uint32_t y, Vec2 offset) const {
        const float sx = (2 * (static_cast<float>(x) + offset.x) - width_) / height_ * half_height_;
        const float sy = (height_ - 2 * (static_cast<float>(y) + offset.y)) / height_ * half_height_;
        Ray made;
        made.origin = eye_;
        made.direction = normalize(forward_ + right_ * sx + up_ * sy);
        return made;
    }

private:
    Vec3 eye_, forward_, right_, up_;
    float half_height_, width_, height_;
};

}  // namespace raycache::tracer
