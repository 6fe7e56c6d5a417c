// A rug of tufts with a pattern of lozenges.
#include <algorithm>
#include <cmath>

#include "tracer/scene/builtin/modelling/random.hpp"
#include "tracer/scene/builtin/room/parts.hpp"

namespace raycache::tracer::room {
namespace {

constexpr std::size_t tuft_triangles = 3, tuft_vertices = 5, ground_triangles = 2, ground_vertices = 4;

std::size_t tufts(std::size_t triangles) {
    return triangles > ground_triangles ? (triangles - ground_triangles) / tuft_triangles : 0;
}

Stuff color_at(float u, float v) {
    const float across = 5 * u, along = 3 * v;
    const float x = across - std::floor(across) - 0.5F, z = along - std::floor(along) - 0.5F;
    const float from_middle = (x < 0 ? -x : x) + (z < 0 ? -z : z), edge = std::min({u, 1 - u, v, 1 - v});
    if (edge < 0.03F) return Stuff::wool_grey;
    if (from_middle < 0.12F || (from_middle > 0.42F && from_middle < 0.5F)) return Stuff::wool_rust;
    return Stuff::wool_cream;
}

}  // namespace

std::size_t rug_vertices(std::size_t triangles) {
    return triangles < ground_triangles ? 0 : ground_vertices + tuft_vertices * tufts(triangles);
}

void rug(MeshBuilder& b, std::size_t triangles) {
    if (triangles < ground_triangles) return;
    const float wide = rug_to.x - rug_from.x, deep = rug_to.z - rug_from.z;
    b.use(Stuff::wool_grey);
    flat(b, {rug_from.x, rug_from.y, rug_to.z}, rug_to, {rug_to.x, rug_from.y, rug_from.z}, rug_from);
    const std::size_t count = tufts(triangles);
    if (b.counting()) return b.count(tuft_vertices * count, tuft_triangles * count);
    Random random(361);
    // In rows, so that tufts that lie together are together in the file too, as a weaver makes them.
    const float spacing = std::sqrt(wide * deep / static_cast<float>(std::max<std::size_t>(count, 1)));
    const auto columns = std::max<std::size_t>(1, static_cast<std::size_t>(wide / spacing));
    const std::size_t rows = (count + columns - 1) / columns;
    const float thick = std::min(0.009F, 0.45F * spacing);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t row = i / columns;
        const float u = (static_cast<float>(i % columns) + random.unit()) / static_cast<float>(columns);
        const float v = (static_cast<float>(row) + random.unit()) / static_cast<float>(rows);
        const auto [c, s] = cos_sin(static_cast<double>(random.unit()));
        const float tall = random.in(0.014F, 0.024F);
        const Vec3 lean = random.jitter(0.011F);
        const Vec3 foot{rug_from.x + wide * u, rug_from.y, rug_from.z + deep * v}, side{c * thick, 0, s * thick};
        const Vec3 middle = foot + Vec3{0.3F * lean.x, 0.55F * tall, 0.3F * lean.z};
        const Vec3 tip = foot + Vec3{lean.x, tall, lean.z};
        b.use(color_at(u, v));
        const std::uint32_t first = b.vertex(foot - side);
        b.vertex(foot + side), b.vertex(middle + side * 0.9F), b.vertex(middle - side * 0.9F), b.vertex(tip);
        b.quad(first, first + 1, first + 2, first + 3);
        b.triangle(first + 3, first + 2, first + 4);
    }
}

}  // namespace raycache::tracer::room
