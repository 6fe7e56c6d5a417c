#include "tracer/scene/gltf_cameras.hpp"
#include "traces/printable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace raycache::tracer {

namespace {

/// A column of the linear part, unit; of any length that a double has. Zero where it has no direction.
Vec3 axis_of(const Transform& t, std::size_t axis) {
    const double x = t.rows[0][axis], y = t.rows[1][axis], z = t.rows[2][axis];
    const double largest = std::max({std::abs(x), std::abs(y), std::abs(z)});
    if (!(largest > 0) || !std::isfinite(largest)) return {0, 0, 0};
    const double size = std::hypot(x / largest, y / largest, z / largest);
    const auto part = [&](double v) { return static_cast<float>(v / largest / size); };
    return {part(x), part(y), part(z)};
}

void check_place(Camera& camera) {
    if (is_usable_position(camera.eye)) return;
    camera.problem = fmt::format("expected an eye within {:g} m of the origin on each axis, found {:g},{:g},{:g}",
                                 max_coordinate, camera.eye.x, camera.eye.y, camera.eye.z);
}

}  // namespace

std::vector<Camera> read_gltf_cameras(const GltfDocument& document, const std::vector<GltfPlacement>& placements,
                                      const GltfReport& report) {
    std::vector<Camera> result;
    std::size_t orthographic = 0, unusable = 0;
    for (const GltfPlacement& placement : placements) {
        const auto& source = document.model.cameras[static_cast<std::size_t>(placement.object)];
        const auto& node = document.model.nodes[static_cast<std::size_t>(placement.node)];
        if (source.type != "perspective") {
            ++orthographic;
            continue;
        }
        Camera camera;
        camera.name = printable_line(!node.name.empty()     ? node.name
                                     : !source.name.empty() ? source.name
                                                            : fmt::format("camera{}", result.size()));
        camera.eye = placement.to_world.column(3);
        camera.forward = -axis_of(placement.to_world, 2);
        camera.up = orthogonal_up(camera.forward, axis_of(placement.to_world, 1));
        camera.vertical_fov = static_cast<float>(source.perspective.yfov * 180 / std::numbers::pi);
        const bool has_direction = std::abs(length(camera.forward) - 1) < 1e-3F && is_finite(camera.up);
        if (!has_direction || !(camera.vertical_fov > 0) || !(camera.vertical_fov < 180)) {
            ++unusable;
            continue;
        }
        check_place(camera);
        result.push_back(std::move(camera));
    }
    if (orthographic > 0) report.warning(fmt::format("skipped {} orthographic cameras", orthographic));
    if (unusable > 0)
        report.warning(
            fmt::format("skipped {} cameras without a direction or with a field of view outside (0, 180)", unusable));
    return result;
}

Camera overview_camera(const Box& box) {
    const auto middle = [](float a, float b) { return static_cast<float>((double{a} + b) / 2); };
    const Vec3 center{middle(box.lower.x, box.upper.x), middle(box.lower.y, box.upper.y),
                      middle(box.lower.z, box.upper.z)};
    const double half_diagonal =
        std::hypot(double{box.upper.x} - center.x, double{box.upper.y} - center.y, double{box.upper.z} - center.z);
    Camera camera;
    camera.name = "auto";
    // The sphere around the box fits a cone of half the vertical field of view, with a margin.
    const double distance =
        1.1 * std::max(half_diagonal, 1e-3) / std::sin(camera.vertical_fov * std::numbers::pi / 360);
    const Vec3 towards_eye = normalize(Vec3{0.5F, 0.35F, 1});
    camera.eye = center + towards_eye * static_cast<float>(distance);
    camera.forward = -towards_eye;
    camera.up = orthogonal_up(camera.forward, {0, 1, 0});
    check_place(camera);
    return camera;
}

Vec3 orthogonal_up(Vec3 forward, Vec3 up) {
    Vec3 result = up - forward * dot(up, forward);
    if (!(length(result) > 1e-4F)) {
        const Vec3 other = std::abs(forward.z) < 0.9F ? Vec3{0, 0, -1} : Vec3{0, 1, 0};
        result = other - forward * dot(other, forward);
    }
    return normalize(result);
}

}  // namespace raycache::tracer
