// How much a rough mirror reflects in all. Single scattering by GGX microfacets with Schlick's Fresnel term reflects
// F0 * scale + offset of what comes from one direction: Schlick is linear in F0, so two tables serve every colour
// (B. Karis, "Real Shading in Unreal Engine 4", SIGGRAPH course 2013, the split sum). The rest of the light is what a
// coat lets through to the surface below it, or what microfacets would scatter more than once.
#pragma once

namespace raycache::tracer {

struct GgxAlbedo {
    float scale = 0, offset = 0;

    float of(float f0) const { return f0 * scale + offset; }
    float white() const { return scale + offset; }  ///< for F = 1
};

/// For light that leaves at `cosine` in [0, 1] from the normal; `roughness` as in glTF. Tables are made on first use
/// (under a tenth of a second), by integration; their error is below 0.006.
GgxAlbedo ggx_albedo(float cosine, float roughness);

/// The cosine-weighted mean over all directions.
GgxAlbedo ggx_mean_albedo(float roughness);

}  // namespace raycache::tracer
