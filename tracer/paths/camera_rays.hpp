// Primary rays of a pinhole camera, and where points lie in its picture.
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

    std::uint32_t width() const { return static_cast<std::uint32_t>(width_); }
    std::uint32_t height() const { return static_cast<std::uint32_t>(height_); }

    /// A direction in the camera's frame: x to the right, y up, z along the view.
    Vec3 to_view(Vec3 direction) const {
        return {dot(direction, right_), dot(direction, up_), dot(direction, forward_)};
    }
    /// Where a point of that frame, its origin the eye, lies in the picture: in pixels from the top left corner. Its
    /// depth z must be above 0.
    Vec2 project(Vec3 view) const {
        const float scale = height_ / (half_height_ * view.z);
        return {0.5F * (width_ + view.x * scale), 0.5F * (height_ - view.y * scale)};
    }
    /// The point of that frame which lies there, at that depth.
    Vec3 unproject(Vec2 place, float depth) const {
        const float scale = depth * half_height_ / height_;
        return {(2 * place.x - width_) * scale, (height_ - 2 * place.y) * scale, depth};
    }

private:
    Vec3 eye_, forward_, right_, up_;
    float half_height_, width_, height_;
};

}  // namespace raycache::tracer
