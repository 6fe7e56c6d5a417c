// Two steps, a round basin with a glazed band, two bowls on a turned stem, and water.
#include <array>

#include "tracer/scene/builtin/courtyard/parts.hpp"
#include "tracer/scene/builtin/modelling/random.hpp"

namespace raycache::tracer::courtyard {
namespace {

/// Rings that run out from the falling water.
void pool(MeshBuilder& b, float y, float inner, float outer, int around, int rings) {
    sheet(b, around, rings, [&](float u, float v) {
        const float r = outer + (inner - outer) * v;
        const auto [c, s] = cos_sin(static_cast<double>(u));
        const float wave =
            0.010F * cos_sin(static_cast<double>(r * 5.3F)).cos * cos_sin(3 * static_cast<double>(u)).sin;
        return Vec3{r * c, y + wave, -r * s};
    });
}

/// Arcs of water from the rim of a bowl into the one below.
void jets(MeshBuilder& b, Fineness fine, int count, float r, float y, float reach, float drop) {
    const int pieces = fine.of(5, 3), around = fine.of(5, 3);
    for (int i = 0; i < count; ++i) {
        const auto [c, s] = cos_sin((i + 0.5) / count);
        std::vector<Vec3> path;
        std::vector<float> radii;
        for (int k = 0; k <= pieces; ++k) {
            const float t = static_cast<float>(k) / static_cast<float>(pieces);
            const float out = r + reach * t, level = y + 0.35F * drop * t - 1.35F * drop * t * t;
            path.push_back({out * c, level, -out * s});
            radii.push_back(0.014F - 0.006F * t);
        }
        tube(b, path, radii, around);
    }
}

}  // namespace

void fountain(MeshBuilder& b, Fineness fine) {
    const int around = fine.of(44, 16), steps = fine.of(3, 1);
    b.frame(moved(fountain_at));
    b.use(Stuff::stone);
    constexpr std::array<Turning, 7> stairs{{{fountain_radius, -0.05F, true},
                                             {fountain_radius, 0.13F, true},
                                             {fountain_radius - 0.02F, 0.15F, true},
                                             {1.80F, 0.15F, true},
                                             {1.80F, 0.25F, true},
                                             {1.78F, 0.27F, true},
                                             {1.55F, 0.27F, true}}};
    lathe(b, stairs, around);
    b.use(Stuff::pale_stone);
    constexpr std::array<Turning, 12> basin{{{1.62F, 0.26F, true},
                                             {1.62F, 0.34F, true},
                                             {1.54F, 0.38F, true},
                                             {1.54F, 0.40F, true},
                                             {1.54F, 0.64F, true},
                                             {1.54F, 0.66F, true},
                                             {1.64F, 0.70F},
                                             {1.66F, 0.745F},
                                             {1.62F, 0.78F, true},
                                             {1.36F, 0.78F, true},
                                             {1.34F, 0.76F, true},
                                             {1.34F, 0.2F, true}}};
    lathe(b, curve(basin, steps), around);
    b.use(Stuff::blue_glaze);
    constexpr std::array<Turning, 2> band{{{1.55F, 0.43F, true}, {1.55F, 0.62F, true}}};
    lathe(b, band, around);
    b.use(Stuff::water);
    pool(b, 0.64F, 0.1F, 1.345F, around, fine.of(14, 2));
    b.use(Stuff::pale_stone);
    constexpr std::array<Turning, 15> stem{{{0.34F, 0.2F, true},
                                            {0.34F, 0.74F, true},
                                            {0.24F, 0.78F, true},
                                            {0.15F, 0.90F},
                                            {0.19F, 1.05F},
                                            {0.13F, 1.24F, true},
                                            {0.16F, 1.27F, true},
                                            {0.45F, 1.34F},
                                            {0.74F, 1.52F},
                                            {0.80F, 1.58F},
                                            {0.77F, 1.61F, true},
                                            {0.70F, 1.57F},
                                            {0.30F, 1.47F, true},
                                            {0.12F, 1.50F, true},
                                            {0.09F, 1.70F}}};
    lathe(b, curve(stem, steps), around);
    constexpr std::array<Turning, 14> upper{{{0.09F, 1.70F},
                                             {0.12F, 1.82F},
                                             {0.08F, 1.94F, true},
                                             {0.10F, 1.96F, true},
                                             {0.25F, 2.00F},
                                             {0.40F, 2.12F},
                                             {0.42F, 2.16F, true},
                                             {0.36F, 2.12F},
                                             {0.12F, 2.06F, true},
                                             {0.06F, 2.14F, true},
                                             {0.11F, 2.24F},
                                             {0.10F, 2.34F},
                                             {0.04F, 2.46F},
                                             {0, 2.50F}}};
    lathe(b, curve(upper, steps), std::max(10, around / 2));
    b.use(Stuff::water);
    pool(b, 1.575F, 0.1F, 0.72F, around, fine.of(8, 1));
    pool(b, 2.125F, 0.05F, 0.37F, std::max(10, around / 2), fine.of(4, 1));
    jets(b, fine, 12, 0.79F, 1.60F, 0.32F, 0.95F);
    jets(b, fine, 6, 0.41F, 2.15F, 0.16F, 0.56F);
    b.frame({});
}

}  // namespace raycache::tracer::courtyard
