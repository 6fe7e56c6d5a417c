// What stands on the tables: plates, cups, glasses, a bowl, vases with twigs.
#include <array>

#include "tracer/scene/builtin/modelling/random.hpp"
#include "tracer/scene/builtin/room/parts.hpp"

namespace raycache::tracer::room {
namespace {

MeshBuilder turned_ware(const MeshBuilder& like, Fineness fine, std::span<const Turning> profile, Stuff stuff,
                        int sides) {
    MeshBuilder part = like.part();
    part.use(stuff);
    lathe(part, curve(profile, fine.of(3, 1)), fine.of(sides, 6));
    return part;
}

constexpr std::array<Turning, 8> plate_profile{{{0, 0},
                                                {0.075F, 0.001F, true},
                                                {0.078F, 0.006F},
                                                {0.132F, 0.018F},
                                                {0.136F, 0.021F},
                                                {0.128F, 0.0205F},
                                                {0.075F, 0.009F},
                                                {0, 0.008F}}};
constexpr std::array<Turning, 8> cup_profile{{{0, 0},
                                              {0.024F, 0.001F, true},
                                              {0.026F, 0.008F},
                                              {0.039F, 0.04F},
                                              {0.042F, 0.075F},
                                              {0.039F, 0.075F},
                                              {0.034F, 0.04F},
                                              {0, 0.012F}}};
/// Of a single wall.
constexpr std::array<Turning, 7> glass_profile{{{0, 0},
                                                {0.033F, 0.0005F, true},
                                                {0.034F, 0.003F},
                                                {0.006F, 0.012F},
                                                {0.0045F, 0.08F},
                                                {0.03F, 0.115F},
                                                {0.036F, 0.19F}}};
constexpr std::array<Turning, 9> bowl_profile{{{0, 0},
                                               {0.06F, 0.001F, true},
                                               {0.062F, 0.012F},
                                               {0.12F, 0.04F},
                                               {0.155F, 0.085F},
                                               {0.149F, 0.086F},
                                               {0.112F, 0.045F},
                                               {0.06F, 0.02F},
                                               {0, 0.017F}}};
constexpr std::array<Turning, 10> vase_profile{{{0, 0},
                                                {0.05F, 0.001F, true},
                                                {0.056F, 0.012F},
                                                {0.085F, 0.1F},
                                                {0.06F, 0.21F},
                                                {0.035F, 0.27F},
                                                {0.046F, 0.3F},
                                                {0.042F, 0.3F},
                                                {0.03F, 0.268F},
                                                {0, 0.02F}}};

MeshBuilder cup(const MeshBuilder& like, Fineness fine) {
    MeshBuilder part = turned_ware(like, fine, cup_profile, Stuff::porcelain, 22);
    std::vector<Vec3> handle;
    const int pieces = fine.of(10, 3);
    for (int i = 0; i <= pieces; ++i) {
        const auto [c, s] = cos_sin(0.5 * i / pieces);
        handle.push_back({0.036F + 0.024F * s, 0.042F - 0.02F * c, 0});
    }
    tube(part, handle, 0.004F, fine.of(9, 4));
    return part;
}

/// Bare twigs that fan out from the mouth of a vase.
void twigs(MeshBuilder& b, Vec3 foot, int number, Random& random, Fineness fine) {
    b.use(Stuff::bark);
    const int pieces = fine.of(12, 4);
    for (int i = 0; i < number; ++i) {
        const auto [c, s] = cos_sin(static_cast<double>(random.unit()));
        const float reach = random.in(0.08F, 0.26F), tall = random.in(0.4F, 0.62F), bow = random.in(-0.05F, 0.05F);
        std::vector<Vec3> path;
        std::vector<float> radii;
        for (int k = 0; k <= pieces; ++k) {
            const float t = static_cast<float>(k) / static_cast<float>(pieces), out = reach * t * t;
            path.push_back(foot + Vec3{out * c + bow * t * (1 - t) * s, tall * t, -out * s + bow * t * (1 - t) * c});
            radii.push_back(0.0035F - 0.0025F * t);
        }
        tube(b, path, radii, fine.of(6, 3));
        const int buds = 9;
        for (int k = 0; k < buds; ++k) {
            const float t = 0.35F + 0.65F * random.unit(), out = reach * t * t;
            const Vec3 off = random.jitter(0.012F);
            b.use(Stuff::wool_cream);
            ball(b, foot + Vec3{out * c + bow * t * (1 - t) * s, tall * t, -out * s + bow * t * (1 - t) * c} + off,
                 0.007F, fine.of(8, 4));
            b.use(Stuff::bark);
        }
    }
}

void fruit(MeshBuilder& b, Vec3 bowl, Random& random, Fineness fine) {
    for (int i = 0; i < 7; ++i) {
        const auto [c, s] = cos_sin(i < 6 ? (i + 0.2) / 6.0 : 0);
        const float out = i < 6 ? 0.075F : 0;
        b.use(random.below(3) == 0 ? Stuff::mustard_felt : Stuff::book_red);
        ball(b, bowl + Vec3{out * c, i < 6 ? 0.07F : 0.12F, -out * s}, random.in(0.034F, 0.04F), fine.of(22, 6));
    }
}

}  // namespace

void tableware(MeshBuilder& b, Fineness fine) {
    Random random(341);
    const MeshBuilder plate = turned_ware(b, fine, plate_profile, Stuff::porcelain, 34), mug = cup(b, fine);
    const MeshBuilder wine_glass = turned_ware(b, fine, glass_profile, Stuff::glass, 22);
    const MeshBuilder bowl = turned_ware(b, fine, bowl_profile, Stuff::clay, 34);
    const MeshBuilder glass_vase = turned_ware(b, fine, std::span(vase_profile).first(7), Stuff::glass, 26);
    const MeshBuilder clay_vase = turned_ware(b, fine, vase_profile, Stuff::clay, 26);

    const Transform dining = moved(dining_table_at + Vec3{0, dining_height + 0.001F, 0});
    constexpr std::array<Vec3, 6> covers{{{-0.42F, 0.5F, -0.27F},
                                          {0.4F, 0.5F, -0.27F},
                                          {-0.4F, 0, 0.27F},
                                          {0.44F, 0, 0.27F},
                                          {0.66F, 0.25F, 0},
                                          {-0.66F, 0.75F, 0}}};
    for (const Vec3 c : covers) {  // y: the way it faces, in turns
        const Transform cover = dining * moved({c.x, 0, c.z}) * turned(static_cast<double>(c.y));
        b.add(plate, cover);
        b.add(plate, cover * moved({0, 0.011F, 0}) * scaled({0.72F, 0.9F, 0.72F}));
        b.add(wine_glass, cover * moved({0.15F, 0, random.in(-0.16F, -0.12F)}));
        const double handle = static_cast<double>(random.unit());
        b.add(mug, cover * moved({-0.17F, 0, -0.1F}) * turned(handle));
    }
    b.add(bowl, dining);
    fruit(b, dining.origin, random, fine);

    const Transform low = moved(coffee_table_at + Vec3{0, coffee_height + 0.001F, 0});
    b.add(glass_vase, low * moved({0.3F, 0, -0.1F}) * scaled({0.85F, 0.85F, 0.85F}));
    twigs(b, (low * moved({0.3F, 0.03F, -0.1F})).origin, 9, random, fine);
    b.add(mug, low * moved({-0.02F, 0, 0.16F}) * turned(0.1));
    b.add(mug, low * moved({0.1F, 0, 0.2F}) * turned(0.63));

    const Vec3 board{(sideboard_from.x + sideboard_to.x) / 2, sideboard_to.y + 0.001F, sideboard_from.z + 0.3F};
    b.add(clay_vase, moved(board) * scaled({1.2F, 1.15F, 1.2F}));
    twigs(b, board + Vec3{0, 0.2F, 0}, 12, random, fine);
    for (int i = 0; i < 3; ++i)
        b.add(wine_glass,
              moved(board + Vec3{0.05F * static_cast<float>(i % 2), 0, 0.75F + 0.11F * static_cast<float>(i)}));
}

}  // namespace raycache::tracer::room
