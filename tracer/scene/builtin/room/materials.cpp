#include "tracer/scene/builtin/room/materials.hpp"

namespace raycache::tracer::room {
namespace {

enum { no_texture = -1, wood_texture, weave_texture, painting_texture };

Material matt(const char* name, Vec3 color, int texture = no_texture) {
    Material m;
    m.name = name;
    m.base_color = color;
    m.base_color_texture = texture;
    return m;
}

Material coated(const char* name, Vec3 color, float roughness, int texture = no_texture) {
    Material m = matt(name, color, texture);
    m.roughness = roughness;
    return m;
}

Material metal(const char* name, Vec3 color, float roughness) {
    Material m = coated(name, color, roughness);
    m.metallic = 1;
    return m;
}

/// A pane: what stands on the tables is blown so thin that it bends no ray.
Material clear(const char* name, Vec3 color) {
    Material m = coated(name, color, 0);
    m.transmission = 1;
    return m;
}

/// Reflects nothing: a light that lights itself from near by is all noise.
Material lamp(const char* name, Vec3 radiance) {
    Material m = matt(name, {0, 0, 0});
    m.emission = radiance;
    return m;
}

}  // namespace

std::vector<Material> materials() {
    // In the order of Stuff.
    return {
        matt("wall", {0.80F, 0.76F, 0.69F}),
        matt("blue wall", {0.20F, 0.31F, 0.36F}),
        matt("ceiling", {0.86F, 0.85F, 0.82F}),
        coated("white paint", {0.82F, 0.81F, 0.77F}, 0.35F),
        coated("oak", {0.78F, 0.60F, 0.42F}, 0.45F, wood_texture),
        coated("walnut", {0.42F, 0.27F, 0.17F}, 0.4F, wood_texture),
        coated("dark wood", {0.09F, 0.055F, 0.035F}, 0.35F),
        matt("linen", {0.72F, 0.67F, 0.58F}, weave_texture),
        matt("canvas", {0.58F, 0.54F, 0.46F}),
        matt("grey felt", {0.24F, 0.26F, 0.28F}),
        matt("mustard felt", {0.72F, 0.44F, 0.08F}),
        matt("teal felt", {0.05F, 0.28F, 0.29F}),
        matt("curtain", {0.83F, 0.79F, 0.72F}),
        matt("cream wool", {0.78F, 0.72F, 0.60F}),
        matt("grey wool", {0.36F, 0.36F, 0.36F}),
        matt("rust wool", {0.53F, 0.19F, 0.08F}),
        coated("leather", {0.34F, 0.15F, 0.07F}, 0.5F),
        matt("paper", {0.80F, 0.76F, 0.66F}),
        coated("red book", {0.50F, 0.07F, 0.06F}, 0.6F),
        coated("blue book", {0.08F, 0.16F, 0.38F}, 0.6F),
        coated("green book", {0.10F, 0.27F, 0.14F}, 0.6F),
        coated("black book", {0.05F, 0.05F, 0.055F}, 0.5F),
        coated("ochre book", {0.66F, 0.46F, 0.18F}, 0.6F),
        matt("painting", {1, 1, 1}, painting_texture),
        coated("porcelain", {0.85F, 0.84F, 0.81F}, 0.15F),
        matt("clay", {0.58F, 0.30F, 0.19F}),
        matt("soil", {0.07F, 0.045F, 0.03F}),
        matt("bark", {0.20F, 0.14F, 0.09F}),
        coated("dark leaf", {0.05F, 0.17F, 0.045F}, 0.5F),
        coated("light leaf", {0.14F, 0.30F, 0.08F}, 0.5F),
        metal("steel", {0.62F, 0.62F, 0.63F}, 0.2F),
        metal("brass", {0.80F, 0.58F, 0.26F}, 0.25F),
        metal("iron", {0.16F, 0.16F, 0.17F}, 0.5F),
        metal("mirror", {0.93F, 0.93F, 0.93F}, 0.06F),
        clear("glass", {0.94F, 0.97F, 0.96F}),
        lamp("lamp shade", {3.4F, 2.7F, 1.75F}),
        lamp("globe", {9, 7, 4.4F}),
        lamp("daylight", {10.5F, 12, 14.5F}),
    };
}

}  // namespace raycache::tracer::room
