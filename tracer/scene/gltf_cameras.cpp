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

void place(Camera& camera, Vec3d eye, const SceneFrame& frame) {
    camera.eye = frame.to_local(eye).rounded();
    camera.problem = problem_of_eye(eye, frame);
}

}  // namespace

std::string problem_of_eye(Vec3d eye, const SceneFrame& frame) {
    const double limit = double{max_coordinate} * std::min(1.0, frame.unit);
    const bool within = is_usable_position((eye * (1 / std::min(1.0, frame.unit))).rounded());
    if (within && is_usable_position(frame.to_local(eye).rounded())) return {};
    return fmt::format("expected an eye within {:g} m of the origin on each axis, found {:g},{:g},{:g}", limit, eye.x,
                       eye.y, eye.z);
}

std::vector<Camera> read_gltf_cameras(const GltfDocument& document, const std::vector<GltfPlacement>& placements,
                                      const SceneFrame& frame, const GltfReport& report) {
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
        camera.forward = -axis_of(placement.to_world, 2);
        camera.up = orthogonal_up(camera.forward, axis_of(placement.to_world, 1));
        camera.vertical_fov = static_cast<float>(source.perspective.yfov * 180 / std::numbers::pi);
        const bool has_direction = std::abs(length(camera.forward) - 1) < 1e-3F && is_finite(camera.up);
        if (!has_direction || !(camera.vertical_fov > 0) || !(camera.vertical_fov < 180)) {
            ++unusable;
            continue;
        }
        place(camera, placement.to_world.exact_point({0, 0, 0}), frame);
        result.push_back(std::move(camera));
    }
    if (orthographic > 0) report.warning(fmt::format("skipped {} orthographic cameras", orthographic));
    if (unusable > 0)
        report.warning(
            fmt::format("skipped {} cameras without a direction or with a field of view outside (0, 180)", unusable));
    return result;
}

Box box_in_view(const Scene& scene, const GltfReport& report) {
    constexpr std::size_t most_samples = 65536;
    constexpr double far_from_others = 20;
    const auto box_of = [&](std::size_t triangle) {
        Box box;
        for (std::size_t k = 0; k < 3; ++k) box.add(scene.positions[scene.indices[3 * triangle + k]]);
        return box;
    };
    const std::size_t count = scene.triangle_count(), stride = std::max<std::size_t>(1, count / most_samples);
    const auto quantile = [&](std::size_t tenths, auto&& of_box) {
        std::vector<double> values;
        for (std::size_t t = 0; t < count; t += stride) values.push_back(of_box(box_of(t)));
        const auto nth = values.begin() + static_cast<std::ptrdiff_t>((values.size() * tenths + 9) / 10 - 1);
        std::nth_element(values.begin(), nth, values.end());
        return *nth;
    };
    const auto middle = [&](int axis) {
        return quantile(5, [&](const Box& b) { return (double{b.lower[axis]} + double{b.upper[axis]}) / 2; });
    };
    const Vec3d center(middle(0), middle(1), middle(2));
    const double reach =
        quantile(9, [&](const Box& b) { return std::max(length(b.lower - center), length(b.upper - center)); });
    Box all, most;
    std::size_t left_out = 0;
    double away = 0;
    for (std::size_t t = 0; t < count; ++t) {
        const Box box = box_of(t);
        const double distance = std::max(length(box.lower - center), length(box.upper - center));
        all.add(box);
        if (distance > far_from_others * reach) {
            ++left_out;
            away = std::max(away, distance);
        } else {
            most.add(box);
        }
    }
    if (left_out == 0 || !(reach > 0)) return all;
    report.warning(fmt::format(
        "the camera added leaves out {} triangles that reach {:g} m from the others; to see them, give --eye and "
        "--look-at",
        left_out, away * scene.frame.unit));
    return most;
}

Camera overview_camera(const Box& box, const SceneFrame& frame) {
    const auto middle = [](float a, float b) { return static_cast<float>((double{a} + b) / 2); };
    const Vec3 center{middle(box.lower.x, box.upper.x), middle(box.lower.y, box.upper.y),
                      middle(box.lower.z, box.upper.z)};
    const double half_diagonal =
        std::hypot(double{box.upper.x} - center.x, double{box.upper.y} - center.y, double{box.upper.z} - center.z);
    Camera camera;
    camera.name = "auto";
    // The sphere around the box fits a cone of half the vertical field of view, with a margin.
    const double distance =
        1.1 * (half_diagonal > 0 ? half_diagonal : 1e-3) / std::sin(camera.vertical_fov * std::numbers::pi / 360);
    const Vec3 towards_eye = normalize(Vec3{0.5F, 0.35F, 1});
    place(camera, frame.to_world(Vec3d(center) + Vec3d(towards_eye) * distance), frame);
    camera.forward = -towards_eye;
    camera.up = orthogonal_up(camera.forward, {0, 1, 0});
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
