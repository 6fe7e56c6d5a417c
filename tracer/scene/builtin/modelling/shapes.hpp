// Surfaces that the parts of built-in scenes are put together from. All go into the builder's current frame and
// material, with smooth normals where the surface is curved and face normals where it is flat.
#pragma once

#include <span>
#include <vector>

#include "tracer/scene/builtin/modelling/mesh_builder.hpp"

namespace raycache::tracer::modelling {

/// How fine a part is made. 1 is about right for half a million triangles; counts grow in proportion, so triangles of a
/// curved surface grow with the square.
struct Fineness {
    double value = 1;

    int of(double at_one, int least) const {
        const double wanted = at_one * value + 0.5;
        return wanted < least ? least : static_cast<int>(wanted);
    }
};

/// A flat quadrilateral, counter-clockwise from the front. `uv_per_metre` > 0 lays a texture along edge ab.
void flat(MeshBuilder&, Vec3 a, Vec3 b, Vec3 c, Vec3 d, float uv_per_metre = 0);

/// An axis-aligned box: 12 triangles.
void box(MeshBuilder&, Vec3 lower, Vec3 upper);

/// The same with a texture on every face: 24 vertices.
void textured_box(MeshBuilder&, Vec3 lower, Vec3 upper, float uv_per_metre);

/// A straight bar of rectangular section whose long edges are rounded in `rounding` steps (0: sharp, 12 triangles).
/// `up` sets the direction of `height`.
void bar(MeshBuilder&, Vec3 from, Vec3 to, Vec3 up, float width, float height, int rounding, float radius = 0.008F);

/// One point of a turned profile, from the bottom of the outside upwards.
struct Turning {
    float radius, y;
    bool sharp = false;  ///< the curve through the points has a corner here
};

/// Catmull-Rom curve through the points, `steps` pieces between neighbours; sharp points stay corners.
std::vector<Turning> curve(std::span<const Turning> points, int steps);

/// The first, the last and every other point: the same silhouette for things that may use few triangles.
std::vector<Turning> every_other(std::span<const Turning> points);

/// Surface of revolution around Y. A sharp point gets two normals; a point of radius 0 closes the surface.
void lathe(MeshBuilder&, std::span<const Turning> profile, int sides);
void ball(MeshBuilder&, Vec3 centre, float radius, int sides);
void disc(MeshBuilder&, Vec3 centre, float radius, int sides);

/// A round tube along a path, closed at both ends; one radius per point.
void tube(MeshBuilder&, std::span<const Vec3> path, std::span<const float> radii, int sides);
void tube(MeshBuilder&, std::span<const Vec3> path, float radius, int sides);
/// A ring of wire in the XZ plane.
void ring(MeshBuilder&, Vec3 centre, float radius, float wire, int around, int sides);

/// A curved sheet of nu x nv cells with `at(u, v)` in [0, 1]^2; its front is where du x dv points.
template <class At>
void sheet(MeshBuilder& b, int nu, int nv, const At& at, Vec2 uv_scale = {0, 0}, bool smooth = true) {
    const auto columns = static_cast<std::size_t>(nu) + 1, rows = static_cast<std::size_t>(nv) + 1;
    if (b.counting()) return b.count(columns * rows, 2 * (columns - 1) * (rows - 1));
    std::vector<Vec3> p;
    p.reserve(columns * rows);
    for (std::size_t j = 0; j < rows; ++j) {
        for (std::size_t i = 0; i < columns; ++i) {
            p.push_back(
                at(static_cast<float>(i) / static_cast<float>(nu), static_cast<float>(j) / static_cast<float>(nv)));
        }
    }
    const auto first = static_cast<std::uint32_t>(b.vertices());
    for (std::size_t j = 0; j < rows; ++j) {
        for (std::size_t i = 0; i < columns; ++i) {
            Vec3 normal;
            if (smooth) {
                const std::size_t left = i > 0 ? i - 1 : i, right = i + 1 < columns ? i + 1 : i;
                const std::size_t below = j > 0 ? j - 1 : j, above = j + 1 < rows ? j + 1 : j;
                normal = normalize(cross(p[j * columns + right] - p[j * columns + left],
                                         p[above * columns + i] - p[below * columns + i]));
            }
            b.vertex(p[j * columns + i], normal,
                     {uv_scale.x * static_cast<float>(i) / static_cast<float>(nu),
                      uv_scale.y * static_cast<float>(j) / static_cast<float>(nv)});
        }
    }
    for (std::size_t j = 0; j + 1 < rows; ++j) {
        for (std::size_t i = 0; i + 1 < columns; ++i) {
            const auto a = static_cast<std::uint32_t>(first + j * columns + i);
            const auto up = static_cast<std::uint32_t>(columns);
            b.quad(a, a + 1, a + 1 + up, a + up);
        }
    }
}

}  // namespace raycache::tracer::modelling
