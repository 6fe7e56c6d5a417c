#include "tracer/scene/emission.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "tracer/scene/texel_layout.hpp"

namespace raycache::tracer {

namespace {

struct TexelPoint {
    double x, y;
};

/// A convex polygon in the plane of texels. Four half planes cut at most four corners off a triangle more than it has.
struct TexelPolygon {
    std::array<TexelPoint, 8> points;
    std::size_t size = 0;
    void add(TexelPoint p) { points[size++] = p; }

    double area() const {
        double twice = 0;
        for (std::size_t i = 0; i + 2 < size; ++i) {
            const TexelPoint a = points[0], b = points[i + 1], c = points[i + 2];
            twice += (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        }
        return std::abs(twice) / 2;
    }
};

/// The part where sign * (coordinate - limit) >= 0 (I. Sutherland, G. Hodgman, "Reentrant polygon clipping", CACM
/// 1974).
TexelPolygon clip_texels(const TexelPolygon& whole, double TexelPoint::*axis, double limit, double sign) {
    TexelPolygon part;
    for (std::size_t i = 0; i < whole.size; ++i) {
        const TexelPoint a = whole.points[i], b = whole.points[(i + 1) % whole.size];
        const double da = sign * (a.*axis - limit), db = sign * (b.*axis - limit);
        if (da >= 0) part.add(a);
        if ((da >= 0) != (db >= 0)) {
            const double t = da / (da - db);
            TexelPoint cut{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
            cut.*axis = limit;
            part.add(cut);
        }
    }
    return part;
}

TexelPolygon strip_of(const TexelPolygon& whole, double TexelPoint::*axis, double low) {
    return clip_texels(clip_texels(whole, axis, low, 1), axis, low + 1, -1);
}

/// Where a convex polygon meets the horizontal line at `y`.
TexelPoint span_at(const TexelPolygon& polygon, double y) {
    TexelPoint span{1e300, -1e300};
    for (std::size_t i = 0; i < polygon.size; ++i) {
        const TexelPoint p = polygon.points[i];
        if (p.y != y) continue;
        span = {std::min(span.x, p.x), std::max(span.y, p.x)};
    }
    return span;
}

}  // namespace

MeanEmission::MeanEmission(const Scene& scene, const Material& material) : scene_(scene), material_(material) {
    whole_ = double{luminance(material.emission)};
    if (material.emission_texture < 0 || !(whole_ > 0)) return;
    texture_ = &scene.textures[static_cast<std::size_t>(material.emission_texture)];
    double sum = 0;
    for (std::int64_t y = 0; y < texture_->height; ++y)
        for (std::int64_t x = 0; x < texture_->width; ++x) sum += texel(x, y);
    whole_ = sum / (double{static_cast<double>(texture_->width)} * texture_->height);
}

double MeanEmission::texel(std::int64_t x, std::int64_t y) const {
    const TextureLookup lookup = material_.emission_lookup;
    const std::size_t column = wrap_texel(x, texture_->width, lookup.s),
                      row = wrap_texel(y, texture_->height, lookup.t);
    const std::uint8_t* stored = &texture_->rgba[4 * (row * texture_->width + column)];
    const auto& linear = linear_of_srgb();
    return double{luminance(material_.emission * Vec3{linear[stored[0]], linear[stored[1]], linear[stored[2]]})};
}

float MeanEmission::of(std::uint32_t triangle) const {
    if (!texture_ || black()) return static_cast<float>(whole_);
    double x[3], y[3];
    constexpr float corners[3][2] = {{0, 0}, {1, 0}, {0, 1}};
    for (int k = 0; k < 3; ++k) {
        const Vec2 at = texcoord_at(scene_, triangle, corners[k][0], corners[k][1], material_.emission_lookup.layer);
        x[k] = double{at.x} * texture_->width;
        y[k] = double{at.y} * texture_->height;
    }
    return static_cast<float>(over(x, y));
}

double MeanEmission::over(const double (&x)[3], const double (&y)[3]) const {
    const auto [least_x, most_x] = std::minmax({x[0], x[1], x[2]});
    const auto [least_y, most_y] = std::minmax({y[0], y[1], y[2]});
    const double first_x = std::floor(least_x), first_y = std::floor(least_y);
    const double columns = std::floor(most_x) - first_x + 1, rows = std::floor(most_y) - first_y + 1;
    constexpr double farthest = 1e15;  // numbers of texels stay exact
    if (!(columns * rows <= static_cast<double>(most_texels)) || std::abs(first_x) > farthest ||
        std::abs(first_y) > farthest)
        return whole_;
    if (columns == 1 && rows == 1) return texel(static_cast<std::int64_t>(first_x), static_cast<std::int64_t>(first_y));

    TexelPolygon triangle;
    for (int k = 0; k < 3; ++k) triangle.add({x[k], y[k]});
    double sum = 0, covered = 0;
    for (double row = first_y; row < first_y + rows; ++row) {
        const TexelPolygon slab = strip_of(triangle, &TexelPoint::y, row);
        if (slab.size < 3) continue;
        // Columns that lie within the triangle from the top to the bottom of the row.
        const TexelPoint top = span_at(slab, row), bottom = span_at(slab, row + 1);
        const double full_from = std::ceil(std::max(top.x, bottom.x)), full_to = std::floor(std::min(top.y, bottom.y));
        double low = slab.points[0].x, high = low;
        for (std::size_t i = 1; i < slab.size; ++i) {
            low = std::min(low, slab.points[i].x);
            high = std::max(high, slab.points[i].x);
        }
        for (double column = std::floor(low); column < high; ++column) {
            const bool full = column >= full_from && column + 1 <= full_to;
            const double area = full ? 1 : strip_of(slab, &TexelPoint::x, column).area();
            covered += area;
            if (area > 0) sum += area * texel(static_cast<std::int64_t>(column), static_cast<std::int64_t>(row));
        }
    }
    const double area = triangle.area();
    constexpr double rounding = 1e-6;
    return area > 0 && std::abs(covered - area) <= rounding * area ? sum / covered : at_points(x, y);
}

/// Of a triangle that is a line on the texture. Nothing found black may be lit after all: then the whole texture's.
double MeanEmission::at_points(const double (&x)[3], const double (&y)[3]) const {
    constexpr int side = 16;
    double sum = 0;
    int count = 0;
    for (int i = 0; i < side; ++i)
        for (int j = 0; i + j < side; ++j, ++count) {
            const double u = (i + 1.0 / 3) / side, v = (j + 1.0 / 3) / side, w = 1 - u - v;
            sum += texel(static_cast<std::int64_t>(std::floor(w * x[0] + u * x[1] + v * x[2])),
                         static_cast<std::int64_t>(std::floor(w * y[0] + u * y[1] + v * y[2])));
        }
    return sum > 0 ? sum / count : whole_;
}

bool has_area(const Scene& scene, std::size_t triangle) {
    const std::uint32_t* index = &scene.indices[3 * triangle];
    const Vec3 a = scene.positions[index[0]], b = scene.positions[index[1]], c = scene.positions[index[2]];
    return max_component(max(cross(b - a, c - a), cross(c - a, b - a))) > 0;
}

bool emits_light(const Scene& scene) {
    for (const PunctualLight& light : scene.punctual_lights)
        if (max_component(light.intensity) > 0) return true;
    std::vector<std::optional<MeanEmission>> of_material(scene.materials.size());
    for (std::size_t t = 0; t < scene.triangle_count(); ++t) {
        const std::uint16_t m = scene.material_of[t];
        if (!(max_component(scene.materials[m].emission) > 0) || !has_area(scene, t)) continue;
        if (!of_material[m]) of_material[m].emplace(scene, scene.materials[m]);
        if (!of_material[m]->black() && of_material[m]->of(static_cast<std::uint32_t>(t)) > 0) return true;
    }
    return false;
}

}  // namespace raycache::tracer
