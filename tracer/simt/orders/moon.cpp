// B. Moon, Y. Byun, T.-J. Kim, P. Claudio, H.-S. Kim, Y.-J. Ban, S. W. Nam, S.-E. Yoon: "Cache-Oblivious Ray
// Reordering", ACM Transactions on Graphics 29 (3), 2010. Rays are sorted along a space-filling curve by where they
// approximately hit. The paper intersects simplified meshes; here the coarse structure is a grid of 64^3 voxels that
// says which of them triangles touch (32 KiB). The approximate hit is the point where the ray enters the first such
// voxel after the one it starts in, or where it leaves the scene. The key is its Morton code.
// Voxels along the ray: J. Amanatides, A. Woo: "A Fast Voxel Traversal Algorithm for Ray Tracing", Eurographics 1987.
#include <array>
#include <cmath>
#include <limits>

#include "tracer/simt/orders/morton_code.hpp"
#include "tracer/simt/orders/ray_order.hpp"

namespace raycache::tracer {
namespace {

constexpr int cells = 64;

class Moon final : public RayOrder {
public:
    explicit Moon(const Scene& scene)
        : bounds_(scene.bounds()), voxels_(bounds_, cells), grid_(bounds_, 1024), touched_(cells * cells * cells) {
        for (std::size_t t = 0; t < scene.triangle_count(); ++t) {
            std::array<Vec3, 3> corner;
            for (std::size_t k = 0; k < 3; ++k) corner[k] = scene.positions[scene.indices[3 * t + k]];
            mark(corner);
        }
    }
    std::uint32_t key(const Ray& ray) const override { return morton_code(grid_(approximate_hit(ray))); }
    unsigned key_bits() const override { return 30; }

private:
    Vec3 voxel_size() const { return (bounds_.upper - bounds_.lower) / static_cast<float>(cells); }
    static std::size_t index(int x, int y, int z) {
        return (static_cast<std::size_t>(z) * cells + static_cast<std::size_t>(y)) * cells +
               static_cast<std::size_t>(x);
    }

    /// Voxels of the triangle's bounding box that its plane cuts: all that it touches, and a few more at its edges.
    void mark(const std::array<Vec3, 3>& corner) {
        Box box;
        for (const Vec3 p : corner) box.add(p);
        const Cell first = voxels_(box.lower), last = voxels_(box.upper);
        const Vec3 normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
        const Vec3 half = voxel_size() * 0.5F;
        const float reach =
            1.001F * (std::fabs(normal.x) * half.x + std::fabs(normal.y) * half.y + std::fabs(normal.z) * half.z);
        for (std::uint32_t z = first.z; z <= last.z; ++z)
            for (std::uint32_t y = first.y; y <= last.y; ++y)
                for (std::uint32_t x = first.x; x <= last.x; ++x) {
                    const Vec3 corner_of_voxel =
                        bounds_.lower +
                        voxel_size() * Vec3{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
                    if (std::fabs(dot(normal, corner_of_voxel + half - corner[0])) <= reach)
                        touched_[index(static_cast<int>(x), static_cast<int>(y), static_cast<int>(z))] = true;
                }
    }

    Vec3 approximate_hit(const Ray& ray) const {
        const Cell start = voxels_(ray.origin);
        std::array<int, 3> at{static_cast<int>(start.x), static_cast<int>(start.y), static_cast<int>(start.z)};
        std::array<int, 3> step{};
        std::array<float, 3> next{}, delta{};  // t of the next wall of each axis, t from wall to wall
        const Vec3 size = voxel_size();
        for (int a = 0; a < 3; ++a) {
            const auto i = static_cast<std::size_t>(a);
            const float d = ray.direction[a];
            step[i] = d > 0 ? 1 : -1;
            const int wall = at[i] + (d > 0 ? 1 : 0);
            const float far = std::numeric_limits<float>::infinity();
            next[i] = d != 0 && size[a] > 0
                          ? (bounds_.lower[a] + static_cast<float>(wall) * size[a] - ray.origin[a]) / d
                          : far;
            delta[i] = d != 0 ? size[a] / std::fabs(d) : far;
        }
        for (;;) {
            std::size_t axis = next[0] < next[1] ? 0 : 1;
            if (next[2] < next[axis]) axis = 2;
            const float t = next[axis];
            if (!std::isfinite(t)) return ray.origin;
            at[axis] += step[axis];
            next[axis] += delta[axis];
            const bool outside = at[axis] < 0 || at[axis] >= cells;
            if (outside || t >= ray.t_max || touched_[index(at[0], at[1], at[2])])
                return ray.origin + ray.direction * t;
        }
    }

    Box bounds_;
    CellGrid voxels_, grid_;
    std::vector<bool> touched_;
};

}  // namespace

RayOrderEntry moon_order() {
    return {"moon", "Morton code of the approximate hit point, found in a grid of 64^3 voxels (2010)",
            [](const Scene& scene) -> std::unique_ptr<RayOrder> { return std::make_unique<Moon>(scene); }};
}

}  // namespace raycache::tracer
