// The three lamps: a pendant over the dining table, one that stands beside the sofa, one on the sideboard.
#include <array>

#include "tracer/scene/builtin/modelling/random.hpp"
#include "tracer/scene/builtin/room/parts.hpp"

namespace raycache::tracer::room {
namespace {

/// A cone of cloth that glows itself, since a small bulb inside would be found by few rays: open above and below, with
/// rims of wire; Y = 0 is its lower edge.
void cloth_shade(MeshBuilder& b, float lower, float upper, float tall, Fineness fine) {
    b.use(Stuff::shade);
    const int around = fine.of(60, 12);
    sheet(b, around, fine.of(14, 2), [&](float u, float v) {
        const auto [c, s] = cos_sin(static_cast<double>(u));
        const float r = lower + (upper - lower) * v + 0.0015F * cos_sin(static_cast<double>(30 * u)).cos;
        return Vec3{r * c, tall * v, -r * s};
    });
    b.use(Stuff::brass);
    ring(b, {0, 0, 0}, lower, 0.003F, around, fine.of(6, 3));
    ring(b, {0, tall, 0}, upper, 0.003F, around, fine.of(6, 3));
}

}  // namespace

void lamps(MeshBuilder& b, Fineness fine) {
    const int sides = fine.of(14, 5);
    // Over the dining table.
    b.frame(moved({dining_table_at.x, 1.62F, dining_table_at.z}));
    constexpr std::array<Turning, 9> dome{{{0.24F, 0, true},
                                           {0.235F, 0.07F},
                                           {0.15F, 0.16F},
                                           {0.045F, 0.2F},
                                           {0.03F, 0.26F, true},
                                           {0.012F, 0.265F, true},
                                           {0.01F, 0.29F, true},
                                           {0.004F, 0.295F, true},
                                           {0.004F, 0.3F}}};
    constexpr std::array<Turning, 5> lining{
        {{0.036F, 0.192F}, {0.146F, 0.156F}, {0.231F, 0.069F}, {0.236F, 0.002F, true}, {0.24F, 0, true}}};
    b.use(Stuff::iron);
    lathe(b, curve(dome, fine.of(4, 1)), fine.of(48, 12));
    b.use(Stuff::white_paint);
    lathe(b, curve(lining, fine.of(4, 1)), fine.of(48, 12));
    b.use(Stuff::iron);
    const std::array<Vec3, 2> flex{{{0, 0.29F, 0}, {0, height - 1.62F, 0}}};
    tube(b, flex, 0.003F, fine.of(6, 3));
    const std::array<Vec3, 2> rose{{{0, height - 1.65F, 0}, {0, height - 1.62F, 0}}};
    tube(b, rose, 0.05F, fine.of(24, 8));
    b.use(Stuff::globe);
    ball(b, {0, 0.06F, 0}, 0.09F, fine.of(24, 8));

    // Beside the sofa.
    b.frame(moved(floor_lamp_at));
    b.use(Stuff::brass);
    constexpr std::array<Turning, 5> foot{
        {{0, 0}, {0.15F, 0, true}, {0.15F, 0.012F, true}, {0.02F, 0.03F}, {0.011F, 0.06F}}};
    lathe(b, curve(foot, fine.of(3, 1)), fine.of(40, 10));
    const std::array<Vec3, 2> stem{{{0, 0.05F, 0}, {0, 1.5F, 0}}};
    tube(b, stem, 0.011F, sides);
    b.frame(b.frame() * moved({0, 1.36F, 0}));
    cloth_shade(b, 0.23F, 0.16F, 0.3F, fine);

    // On the sideboard.
    b.frame(moved({(sideboard_from.x + sideboard_to.x) / 2, sideboard_to.y, sideboard_to.z - 0.28F}));
    b.use(Stuff::porcelain);
    constexpr std::array<Turning, 7> belly{
        {{0, 0}, {0.06F, 0, true}, {0.07F, 0.015F}, {0.1F, 0.11F}, {0.055F, 0.2F}, {0.018F, 0.25F}, {0.014F, 0.3F}}};
    lathe(b, curve(belly, fine.of(4, 1)), fine.of(36, 10));
    b.frame(b.frame() * moved({0, 0.25F, 0}));
    cloth_shade(b, 0.17F, 0.11F, 0.22F, fine);
    b.frame({});
}

}  // namespace raycache::tracer::room
