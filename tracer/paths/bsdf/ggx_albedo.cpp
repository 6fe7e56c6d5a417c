#include "tracer/paths/bsdf/ggx_albedo.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tracer/paths/bsdf/fresnel.hpp"
#include "tracer/paths/bsdf/ggx.hpp"

namespace raycache::tracer {
namespace {

constexpr unsigned columns = 32, rows = 32, points = 1024;

GgxAlbedo mix(const GgxAlbedo& a, const GgxAlbedo& b, float t) {
    return {a.scale + (b.scale - a.scale) * t, a.offset + (b.offset - a.offset) * t};
}

/// Columns are dense near grazing, where the albedo turns fastest.
float cosine_of(unsigned column) {
    const float x = static_cast<float>(column) / (columns - 1);
    return x * x;
}

GgxAlbedo smooth(float cosine) {
    const float rise = schlick_rise(cosine);
    return {1 - rise, rise};
}

/// By the Hammersley points of visible normals, whose weight is G2 / G1. Half of them mirror the other half.
GgxAlbedo integrate(float cosine, float roughness) {
    const Ggx ggx(roughness);
    cosine = std::max(cosine, 1e-3F);
    const Vec3 wo{std::sqrt(1 - cosine * cosine), 0, cosine};
    double scale = 0, offset = 0;
    for (unsigned i = 0; i < points; ++i) {
        float halves = 0, unit = 0.5F;
        for (unsigned bits = i; bits != 0; bits >>= 1, unit /= 2) halves += static_cast<float>(bits & 1U) * unit;
        const Vec3 h = ggx.sample(wo, {(static_cast<float>(i) + 0.5F) / points, 0.75F + 0.5F * halves});
        const Vec3 wi = reflect(wo, h);
        if (!(wi.z > 0)) continue;
        const float weight = ggx.masking_shadowing(wo, wi) / ggx.masking(wo), rise = schlick_rise(dot(wo, h));
        scale += double{weight} * (1 - double{rise});
        offset += double{weight} * double{rise};
    }
    return {static_cast<float>(scale / points), static_cast<float>(offset / points)};
}

struct Tables {
    std::array<std::array<GgxAlbedo, columns>, rows> albedo;
    std::array<GgxAlbedo, rows> mean;

    Tables() {
        for (unsigned r = 0; r < rows; ++r) {
            const float roughness = static_cast<float>(r) / (rows - 1);
            for (unsigned c = 0; c < columns; ++c)
                albedo[r][c] = r == 0 ? smooth(cosine_of(c)) : integrate(cosine_of(c), roughness);
            // 2 mu dmu = d(mu^2); the mean of what interpolation will return.
            constexpr unsigned steps = 512;
            double scale = 0, offset = 0;
            for (unsigned i = 0; i < steps; ++i) {
                const GgxAlbedo a = at(r, std::sqrt((static_cast<float>(i) + 0.5F) / steps));
                scale += double{a.scale};
                offset += double{a.offset};
            }
            mean[r] = {static_cast<float>(scale / steps), static_cast<float>(offset / steps)};
        }
    }

    GgxAlbedo at(unsigned row, float cosine) const {
        const float x = std::sqrt(std::clamp(cosine, 0.0F, 1.0F)) * (columns - 1);
        const unsigned c = std::min(static_cast<unsigned>(x), columns - 2);
        return mix(albedo[row][c], albedo[row][c + 1], x - static_cast<float>(c));
    }

    struct Row {
        unsigned index;
        float t;
    };
    static Row row(float roughness) {
        const float y = std::clamp(roughness, 0.0F, 1.0F) * (rows - 1);
        const unsigned r = std::min(static_cast<unsigned>(y), rows - 2);
        return {r, y - static_cast<float>(r)};
    }
};

const Tables& tables() {
    static const Tables made;
    return made;
}

}  // namespace

GgxAlbedo ggx_albedo(float cosine, float roughness) {
    if (roughness < Ggx::smooth_below) return smooth(cosine);
    const auto [r, t] = Tables::row(roughness);
    return mix(tables().at(r, cosine), tables().at(r + 1, cosine), t);
}

GgxAlbedo ggx_mean_albedo(float roughness) {
    // The mean of (1 - cosine)^5 is 1/21.
    if (roughness < Ggx::smooth_below) return {20.0F / 21, 1.0F / 21};
    const auto [r, t] = Tables::row(roughness);
    return mix(tables().mean[r], tables().mean[r + 1], t);
}

}  // namespace raycache::tracer
