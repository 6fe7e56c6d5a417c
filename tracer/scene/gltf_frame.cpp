#include "tracer/scene/gltf_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace raycache::tracer {
namespace {

/// Coordinates up to so many times the detail keep it: their float steps are a 65536th of it.
constexpr double far_for_its_size = 256;
/// Float steps above this share of a mesh's size are worth a warning.
constexpr double coarse_share = 1.0 / 512;
/// Details, in metres, whose third powers a float holds with room to spare: distances are quotients of such products.
constexpr double smallest_detail = 0x1p-20, largest_detail = 0x1p30;
constexpr std::uint64_t most_samples = 16384;

/// An axis-aligned box in double.
struct Extent {
    Vec3d lower{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                std::numeric_limits<double>::infinity()};
    Vec3d upper = lower * -1;

    void add(Vec3d p) {
        lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
        upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
    }
    Vec3d nearest(Vec3d p) const {
        return {std::clamp(p.x, lower.x, upper.x), std::clamp(p.y, lower.y, upper.y),
                std::clamp(p.z, lower.z, upper.z)};
    }
    double distance(Vec3d p) const { return length(nearest(p) - p); }
    Vec3d middle() const { return lower * 0.5 + upper * 0.5; }
    double size() const { return max_abs(upper - lower); }
    double reach() const { return std::max(max_abs(lower), max_abs(upper)); }
    bool usable() const { return reach() <= double{max_coordinate}; }  // false for NaN
};

/// The triangles of the placed meshes, or evenly spread ones of very many.
std::vector<Extent> sample_triangles(const GltfPlacedMeshes& meshes) {
    std::uint64_t total = 0;
    const auto each = [&](auto&& body) {
        for (const GltfPlacement& placement : meshes.placements)
            for (const GltfPrimitive& p : meshes.primitives[static_cast<std::size_t>(placement.object)])
                body(placement.to_world, p, p.indices.size() / 3);
    };
    each([&](const Transform&, const GltfPrimitive&, std::uint64_t count) { total += count; });
    const std::uint64_t stride = std::max<std::uint64_t>(1, total / most_samples);
    // The first of each mesh, so that a small one among large ones counts.
    const bool firsts = meshes.placements.size() <= most_samples;
    std::vector<Extent> samples;
    samples.reserve(std::min(total, 2 * most_samples));
    std::uint64_t next = 0;  // triangles until the next sample
    each([&](const Transform& to_world, const GltfPrimitive& p, std::uint64_t count) {
        const auto add = [&](std::uint64_t t) {
            Extent box;
            for (std::size_t k = 0; k < 3; ++k) box.add(to_world.exact_point(p.positions[p.indices[3 * t + k]]));
            if (box.usable()) samples.push_back(box);
        };
        if (firsts && next != 0 && count != 0) add(0);
        for (; next < count; next += stride) add(next);
        next -= count;
    });
    return samples;
}

std::optional<Vec3d> first_eye(const std::vector<GltfPlacement>& cameras, const GltfDocument& document) {
    for (const GltfPlacement& placement : cameras) {
        if (document.model.cameras[static_cast<std::size_t>(placement.object)].type != "perspective") continue;
        const Vec3d eye = placement.to_world.exact_point({0, 0, 0});
        if (max_abs(eye) <= double{max_coordinate}) return eye;
        return std::nullopt;
    }
    return std::nullopt;
}

double nth(std::vector<double>& numbers, std::size_t n) {
    std::nth_element(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(n), numbers.end());
    return numbers[n];
}

Vec3d median(const std::vector<Extent>& samples) {
    const auto along = [&](int axis) {
        std::vector<double> middles;
        middles.reserve(samples.size());
        for (const Extent& box : samples) middles.push_back(box.middle()[axis]);
        return nth(middles, middles.size() / 2);
    };
    return {along(0), along(1), along(2)};
}

double power_of_two_below(double x) { return std::ldexp(1.0, std::ilogb(x)); }

/// Of a float as large as `x`.
double float_step(double x) { return x > 0 ? std::ldexp(power_of_two_below(x), -23) : 0; }

std::string place(Vec3d p) { return fmt::format("{:.9g},{:.9g},{:.9g}", p.x, p.y, p.z); }

}  // namespace

GltfFrame choose_gltf_frame(const GltfPlacedMeshes& meshes, const std::vector<GltfPlacement>& cameras,
                            const GltfDocument& document) {
    const std::vector<Extent> samples = sample_triangles(meshes);
    if (samples.empty()) return {};
    const std::optional<Vec3d> eye = first_eye(cameras, document);
    Vec3d center;
    double seen = std::numeric_limits<double>::infinity();
    if (eye) {
        const auto nearest = std::min_element(samples.begin(), samples.end(), [&](const Extent& a, const Extent& b) {
            return a.distance(*eye) < b.distance(*eye);
        });
        center = nearest->nearest(*eye);
        seen = std::max(nearest->distance(*eye), nearest->size());
    } else {
        center = median(samples);
    }
    std::vector<double> distances, sizes;
    for (const Extent& box : samples) {
        distances.push_back(box.distance(center));
        sizes.push_back(box.size());
    }
    const std::size_t an_eighth = std::min(samples.size() - 1, std::max<std::size_t>(samples.size() / 8, 3));
    double detail = std::min(nth(distances, an_eighth), seen);
    if (!(detail > 0)) detail = nth(sizes, sizes.size() / 2);
    if (!(detail > 0)) return {};

    GltfFrame result;
    result.detail = detail;
    if (max_abs(center) > far_for_its_size * detail) {
        const double grid = power_of_two_below(4 * detail);
        const auto on_grid = [&](double x) { return std::round(x / grid) * grid; };
        result.frame.origin = {on_grid(center.x), on_grid(center.y), on_grid(center.z)};
    }
    if (detail < smallest_detail || detail > largest_detail) result.frame.unit = power_of_two_below(detail);
    return result;
}

void report_coarse_places(const GltfPlacedMeshes& meshes, const GltfFrame& frame, const GltfReport& report) {
    struct Coarse {
        std::size_t count = 0;
        double worst = coarse_share, step = 0, reach = 0, size = 0;
        int node = 0;
        void see(double step_, double size_, double reach_, int node_) {
            if (!(step_ > coarse_share * size_)) return;
            ++count;
            if (step_ / size_ > worst) {
                worst = step_ / size_;
                step = step_, reach = reach_, size = size_, node = node_;
            }
        }
    };
    std::vector<std::vector<Extent>> boxes(meshes.primitives.size());
    for (std::size_t m = 0; m < boxes.size(); ++m)
        for (const GltfPrimitive& primitive : meshes.primitives[m]) {
            Extent& box = boxes[m].emplace_back();
            for (const Vec3 p : primitive.positions) box.add(p);
        }
    Coarse vertices, places;
    for (const GltfPlacement& placement : meshes.placements)
        for (const Extent& box : boxes[static_cast<std::size_t>(placement.object)]) {
            if (!(box.size() > 0)) continue;
            Extent world;
            for (int corner = 0; corner < 8; ++corner)
                world.add(placement.to_world.exact_point(
                    (Vec3d{(corner & 1) != 0 ? box.upper.x : box.lower.x, (corner & 2) != 0 ? box.upper.y : box.lower.y,
                           (corner & 4) != 0 ? box.upper.z : box.lower.z})));
            if (!world.usable()) continue;
            const double size = std::max(world.size(), frame.detail);
            const double scale = world.size() / box.size();
            vertices.see(float_step(box.reach()) * scale, size, box.reach(), placement.node);
            const double reach =
                std::max(max_abs(world.lower - frame.frame.origin), max_abs(world.upper - frame.frame.origin));
            places.see(float_step(reach), size, reach, placement.node);
        }
    if (vertices.count > 0)
        report.warning(fmt::format(
            "meshes have lost detail in the file itself ({}): node {}'s vertices lie {:g} m from its origin, where "
            "floats are {:.2g} m apart, in something {:.3g} m wide; give its vertices small coordinates and the "
            "distance to the node's translation",
            vertices.count, vertices.node, vertices.reach, vertices.step, vertices.size));
    if (places.count > 0)
        report.warning(fmt::format(
            "meshes stand too far for float from {}, on which the scene is centred ({}): node {}'s, {:.3g} m wide, "
            "{:g} m away, where floats are {:.2g} m apart; rays there are unreliable: export that part alone, or with "
            "its camera as the file's first",
            place(frame.frame.origin), places.count, places.node, places.size, places.reach, places.step));
}

Transform in_frame(const Transform& to_world, const SceneFrame& frame) {
    Transform result = to_world;
    for (std::size_t r = 0; r < 3; ++r) {
        result.rows[r][3] -= frame.origin[static_cast<int>(r)];
        for (double& number : result.rows[r]) number /= frame.unit;
    }
    return result;
}

}  // namespace raycache::tracer
