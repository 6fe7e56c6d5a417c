// What stands on the tables: covers with plate, glass, knife and fork, and in the middle a bottle, fruit or cups.
#include <array>

#include "tracer/scene/builtin/courtyard/parts.hpp"
#include "tracer/scene/builtin/modelling/random.hpp"

namespace raycache::tracer::courtyard {
namespace {

MeshBuilder turned_ware(const MeshBuilder& like, Fineness fine, std::span<const Turning> profile, Stuff stuff,
                        int sides) {
    MeshBuilder part = like.part();
    part.use(stuff);
    if (fine.value < 0.35)
        lathe(part, every_other(profile), 5);
    else
        lathe(part, curve(profile, fine.of(2, 1)), fine.of(sides, 5));
    return part;
}

MeshBuilder plate(const MeshBuilder& like, Fineness fine) {
    constexpr std::array<Turning, 7> profile{{{0, 0.004F},
                                              {0.07F, 0.002F},
                                              {0.12F, 0.014F},
                                              {0.132F, 0.018F},
                                              {0.12F, 0.018F},
                                              {0.075F, 0.008F},
                                              {0, 0.008F}}};
    MeshBuilder part = turned_ware(like, fine, profile, Stuff::porcelain, 22);
    part.use(Stuff::blue_glaze);
    if (fine.value > 0.4) ring(part, {0, 0.0185F, 0}, 0.129F, 0.004F, fine.of(22, 6), fine.of(3, 3));
    return part;
}

MeshBuilder cup(const MeshBuilder& like, Fineness fine) {
    constexpr std::array<Turning, 8> profile{{{0, 0},
                                              {0.025F, 0.001F, true},
                                              {0.028F, 0.012F},
                                              {0.040F, 0.045F},
                                              {0.042F, 0.072F},
                                              {0.039F, 0.072F},
                                              {0.035F, 0.04F},
                                              {0, 0.012F}}};
    MeshBuilder part = turned_ware(like, fine, profile, Stuff::porcelain, 14);
    const int pieces = fine.of(6, 3);
    std::vector<Vec3> handle;
    for (int i = 0; i <= pieces; ++i) {
        const auto [c, s] = cos_sin(0.5 * i / pieces);
        handle.push_back({0.038F + 0.024F * s, 0.04F - 0.018F * c, 0});
    }
    part.use(Stuff::porcelain);
    if (fine.value > 0.4) tube(part, handle, 0.004F, fine.of(5, 3));
    return part;
}

MeshBuilder fork(const MeshBuilder& like, Fineness fine) {
    MeshBuilder part = like.part();
    const int rounding = fine.of(0.9, 0);
    bar(part, {0, 0.006F, -0.09F}, {0, 0.006F, 0.05F}, {0, 1, 0}, 0.008F, 0.003F, rounding, 0.001F);
    for (int i = 0; i < 4 && fine.value > 0.5; ++i) {
        const float x = -0.009F + 0.006F * static_cast<float>(i);
        bar(part, {x, 0.007F, 0.048F}, {x, 0.010F, 0.10F}, {0, 1, 0}, 0.0035F, 0.002F, rounding, 0.001F);
    }
    return part;
}

MeshBuilder knife(const MeshBuilder& like, Fineness fine) {
    MeshBuilder part = like.part();
    const int rounding = fine.of(0.9, 0);
    bar(part, {0, 0.006F, -0.09F}, {0, 0.006F, 0.01F}, {0, 1, 0}, 0.011F, 0.006F, rounding, 0.002F);
    bar(part, {0, 0.004F, 0.01F}, {0.002F, 0.004F, 0.11F}, {0, 1, 0}, 0.014F, 0.0015F, rounding, 0.0006F);
    return part;
}

/// A heap: six below, three on top of them and one above.
MeshBuilder fruit_bowl(const MeshBuilder& like, Fineness fine, Random& random) {
    constexpr std::array<Turning, 8> bowl{{{0, 0},
                                           {0.06F, 0.002F, true},
                                           {0.062F, 0.015F},
                                           {0.12F, 0.045F},
                                           {0.15F, 0.085F},
                                           {0.144F, 0.085F},
                                           {0.11F, 0.05F},
                                           {0, 0.02F}}};
    MeshBuilder part = turned_ware(like, fine, bowl, Stuff::blue_glaze, 20);
    MeshBuilder fruit = like.part();
    ball(fruit, {}, 0.04F, fine.of(9, 4));
    const std::array<Vec3, 4> layers{{{6, 0.085F, 0.075F}, {1, 0.07F, 0}, {3, 0.135F, 0.042F}, {1, 0.185F, 0}}};
    for (const Vec3 layer : layers) {
        for (int i = 0; i < static_cast<int>(layer.x); ++i) {
            const auto [c, s] = cos_sin(static_cast<double>((static_cast<float>(i) + 0.3F) / layer.x));
            const bool lemon = random.below(3) == 0;
            const Vec3 shape = lemon ? Vec3{0.85F, 0.8F, 1.05F} : Vec3{1, 0.96F, 1};
            part.add(fruit, moved({layer.z * c, layer.y, -layer.z * s}) * turned(random.unit()) * scaled(shape),
                     lemon ? Stuff::lemon_peel : Stuff::orange_peel);
        }
    }
    return part;
}

}  // namespace

void tableware(MeshBuilder& b, Fineness fine) {
    constexpr std::array<Turning, 9> bottle_profile{{{0, 0},
                                                     {0.036F, 0.002F, true},
                                                     {0.037F, 0.02F},
                                                     {0.037F, 0.18F},
                                                     {0.015F, 0.235F},
                                                     {0.013F, 0.29F, true},
                                                     {0.016F, 0.292F, true},
                                                     {0.016F, 0.305F, true},
                                                     {0, 0.305F}}};
    constexpr std::array<Turning, 7> glass_profile{{{0, 0},
                                                    {0.028F, 0.001F, true},
                                                    {0.033F, 0.11F},
                                                    {0.035F, 0.125F},
                                                    {0.032F, 0.12F},
                                                    {0.027F, 0.012F, true},
                                                    {0, 0.010F}}};
    constexpr std::array<Turning, 8> jug_profile{{{0, 0},
                                                  {0.05F, 0.002F, true},
                                                  {0.075F, 0.06F},
                                                  {0.07F, 0.13F},
                                                  {0.045F, 0.19F},
                                                  {0.055F, 0.225F},
                                                  {0.048F, 0.22F},
                                                  {0, 0.10F}}};
    Random random(51);
    const MeshBuilder dish = plate(b, fine), mug = cup(b, fine), prongs = fork(b, fine), blade = knife(b, fine);
    const MeshBuilder fruit = fruit_bowl(b, fine, random);
    const MeshBuilder bottle = turned_ware(b, fine, bottle_profile, Stuff::bottle_glass, 14);
    const MeshBuilder glass = turned_ware(b, fine, glass_profile, Stuff::bottle_glass, 12);
    const MeshBuilder jug = turned_ware(b, fine, jug_profile, Stuff::terracotta, 16);
    int number = 0;
    for (const TableSite& site : table_sites) {
        const Transform top = moved(site.at + Vec3{0, table_height + 0.004F, 0}) * turned(site.turn);
        for (int i = 0; i < site.chairs; ++i) {
            const Transform cover = top * turned(0.25 * i + static_cast<double>(random.in(-0.01F, 0.01F)));
            b.add(dish, cover * moved({0, 0, -0.33F}));
            const double slant = random.in(-0.02F, 0.02F), other = random.in(-0.02F, 0.02F);
            if (fine.value > 0.3) b.add(prongs, cover * moved({0.17F, 0, -0.33F}) * turned(slant), Stuff::brass);
            if (fine.value > 0.3) b.add(blade, cover * moved({-0.17F, 0, -0.33F}) * turned(other), Stuff::brass);
            const float away = random.in(-0.2F, -0.14F), handle = random.unit();
            const Transform drink = cover * moved({-0.16F, 0, away}) * turned(handle);
            b.add(random.below(2) == 0 ? mug : glass, drink);
        }
        if (number % 3 != 1) b.add(fruit, top * moved({0.02F, 0, 0.03F}));
        if (number % 3 != 0) b.add(bottle, top * moved({-0.15F, 0, 0.02F}));
        if (number % 3 == 1) b.add(jug, top * moved({0.03F, 0, 0.05F}));
        ++number;
    }
}

}  // namespace raycache::tracer::courtyard
