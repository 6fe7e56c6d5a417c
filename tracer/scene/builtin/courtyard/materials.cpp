#include "tracer/scene/builtin/courtyard/materials.hpp"

namespace raycache::tracer::courtyard {
namespace {

enum { no_texture = -1, plaster_texture, mosaic_texture, paper_texture };

Material plain(const char* name, Vec3 color, int texture = no_texture, bool mask = false) {
    Material m;
    m.name = name;
    m.base_color = color;
    m.base_color_texture = texture;
    m.alpha_mask = mask;
    return m;
}

}  // namespace

std::vector<Material> materials() {
    // In the order of Stuff.
    return {
        plain("ochre plaster", {0.95F, 0.60F, 0.24F}, plaster_texture),
        plain("white plaster", {0.97F, 0.92F, 0.82F}, plaster_texture),
        plain("red plaster", {0.50F, 0.15F, 0.09F}),
        plain("mosaic", {1, 1, 1}, mosaic_texture),
        plain("stone", {0.40F, 0.34F, 0.27F}),
        plain("pale stone", {0.58F, 0.52F, 0.43F}),
        plain("mortar", {0.22F, 0.19F, 0.16F}),
        plain("grey paver", {0.31F, 0.29F, 0.26F}),
        plain("sand paver", {0.42F, 0.36F, 0.28F}),
        plain("rose paver", {0.40F, 0.28F, 0.22F}),
        plain("red roof tile", {0.48F, 0.16F, 0.08F}),
        plain("orange roof tile", {0.60F, 0.25F, 0.12F}),
        plain("brown roof tile", {0.35F, 0.15F, 0.09F}),
        plain("dark wood", {0.11F, 0.060F, 0.033F}),
        plain("light wood", {0.42F, 0.25F, 0.12F}),
        plain("blue paint", {0.06F, 0.21F, 0.38F}),
        plain("green paint", {0.07F, 0.25F, 0.18F}),
        plain("iron", {0.035F, 0.035F, 0.040F}),
        plain("brass", {0.62F, 0.43F, 0.14F}),
        plain("dark glass", {0.020F, 0.024F, 0.030F}),
        plain("bottle glass", {0.02F, 0.10F, 0.04F}),
        plain("water", {0.05F, 0.16F, 0.17F}),
        plain("terracotta", {0.56F, 0.23F, 0.12F}),
        plain("blue glaze", {0.04F, 0.11F, 0.36F}),
        plain("soil", {0.075F, 0.048F, 0.030F}),
        plain("porcelain", {0.80F, 0.79F, 0.76F}),
        plain("white cloth", {0.82F, 0.80F, 0.74F}),
        plain("red cloth", {0.55F, 0.06F, 0.05F}),
        plain("orange peel", {0.85F, 0.33F, 0.03F}),
        plain("lemon peel", {0.82F, 0.68F, 0.08F}),
        plain("wax", {0.80F, 0.72F, 0.55F}),
        plain("bark", {0.17F, 0.115F, 0.075F}),
        plain("deep leaf", {0.045F, 0.13F, 0.030F}),
        plain("mid leaf", {0.085F, 0.21F, 0.040F}),
        plain("light leaf", {0.18F, 0.32F, 0.060F}),
        plain("olive leaf", {0.16F, 0.20F, 0.085F}),
        plain("dark ivy", {0.035F, 0.12F, 0.035F}),
        plain("light ivy", {0.12F, 0.26F, 0.065F}),
        plain("agave", {0.19F, 0.30F, 0.22F}),
        plain("bougainvillea", {0.72F, 0.05F, 0.32F}),
        plain("geranium", {0.75F, 0.05F, 0.04F}),
        plain("pink paper", {0.90F, 0.12F, 0.42F}, paper_texture, true),
        plain("yellow paper", {0.92F, 0.70F, 0.06F}, paper_texture, true),
        plain("green paper", {0.06F, 0.55F, 0.28F}, paper_texture, true),
    };
}

}  // namespace raycache::tracer::courtyard
