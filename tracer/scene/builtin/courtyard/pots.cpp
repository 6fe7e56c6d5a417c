// Flower pots along the arcade, jars in the corners, bowls on the fountain's step.
#include "tracer/scene/builtin/courtyard/parts.hpp"
#include "tracer/scene/builtin/courtyard/plants.hpp"
#include "tracer/scene/builtin/modelling/random.hpp"

namespace raycache::tracer::courtyard {

std::vector<PotSite> pot_sites() {
    using Kind = PotSite::Kind;
    using Plant = PotSite::Plant;
    Random random(91);
    std::vector<PotSite> sites;
    const auto clay = [&] { return random.below(4) == 0 ? Stuff::blue_glaze : Stuff::terracotta; };
    for (const Side& side : sides()) {
        const auto put = [&](Vec3 at, float size, Kind kind, Plant plant) {
            const Stuff stuff = clay();
            sites.push_back({side.frame.point(at), size, kind, stuff, plant});
        };
        for (int i = 1; i < side.bays; ++i) {  // beside the columns, on the yard's side
            const float x = side.column(i), off = random.in(0.42F, 0.58F);
            const float shift = random.below(2) == 0 ? off : -off;
            const std::uint32_t which = random.below(4);
            put({x + shift, 0, -0.98F}, random.in(0.17F, 0.24F), Kind::classic,
                which == 0   ? Plant::agave
                : which == 1 ? Plant::shrub
                             : Plant::geranium);
            if (random.below(2) == 0) put({x + shift + 0.42F, 0, -0.94F}, 0.14F, Kind::classic, Plant::geranium);
        }
        put({1.05F, 0, -1.05F}, 0.26F, Kind::jar, Plant::fern);
        put({-2.6F, arcade_floor, 2.6F}, 0.28F, Kind::jar, Plant::shrub);
        for (int i = 0; i < side.bays; i += 2) {  // against the wall, and up on the gallery
            put({side.column(i) + 0.1F, arcade_floor, arcade_depth - 0.4F}, 0.2F, Kind::classic, Plant::agave);
            put({side.column(i) + 0.9F, gallery_floor, 0.45F}, 0.17F, Kind::classic, Plant::geranium);
        }
    }
    for (int i = 0; i < 8; ++i) {
        const auto [c, s] = cos_sin((i + 0.5) / 8);
        sites.push_back({fountain_at + Vec3{1.95F * c, 0.15F, -1.95F * s}, 0.15F, Kind::bowl, clay(), Plant::geranium});
    }
    return sites;
}

void pots(MeshBuilder& b, Fineness fine) {
    using Kind = PotSite::Kind;
    // Of unit mouth; the last two points go down to the earth inside.
    constexpr std::array<Turning, 9> classic{{{0, 0, true},
                                              {0.62F, 0, true},
                                              {0.90F, 1.30F, true},
                                              {1.0F, 1.31F, true},
                                              {1.03F, 1.45F},
                                              {1.0F, 1.6F, true},
                                              {0.90F, 1.6F, true},
                                              {0.86F, 1.42F, true},
                                              {0, 1.45F, true}}};
    constexpr std::array<Turning, 11> jar{{{0, 0, true},
                                           {0.70F, 0, true},
                                           {1.05F, 0.55F},
                                           {1.30F, 1.25F},
                                           {1.18F, 1.9F},
                                           {0.85F, 2.3F},
                                           {0.92F, 2.5F},
                                           {1.0F, 2.6F, true},
                                           {0.88F, 2.6F, true},
                                           {0.78F, 2.4F, true},
                                           {0, 2.42F, true}}};
    constexpr std::array<Turning, 8> bowl{{{0, 0, true},
                                           {0.55F, 0, true},
                                           {0.85F, 0.45F},
                                           {1.02F, 0.82F},
                                           {1.0F, 0.9F, true},
                                           {0.90F, 0.9F, true},
                                           {0.86F, 0.78F, true},
                                           {0, 0.80F, true}}};
    const auto turn = [&](std::span<const Turning> profile) {
        MeshBuilder part = b.part();
        const auto outside = profile.first(profile.size() - 1);
        if (fine.value < 0.35)
            lathe(part, every_other(outside.subspan(1)), 6);
        else
            lathe(part, curve(outside, fine.of(3, 1)), fine.of(22, 7));
        return part;
    };
    const std::array<MeshBuilder, 3> bodies{turn(classic), turn(jar), turn(bowl)};
    MeshBuilder earth = b.part();
    disc(earth, {}, 0.88F, fine.of(22, 5));
    Random random(92);
    for (const PotSite& site : pot_sites()) {
        const float s = site.size;
        const Transform place = moved(site.at) * turned(random.unit());
        b.add(bodies[static_cast<std::size_t>(site.kind)], place * scaled({s, s, s}), site.clay);
        const float inner = site.kind == Kind::jar ? 0.92F : 1;
        b.add(earth, place * moved({0, site.height() - 0.13F * s, 0}) * scaled({s * inner, s, s * inner}), Stuff::soil);
    }
}

}  // namespace raycache::tracer::courtyard
