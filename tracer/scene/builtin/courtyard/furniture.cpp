// Tables with and without cloth, slatted and iron chairs, parasols.
#include <array>

#include "tracer/scene/builtin/courtyard/parts.hpp"
#include "tracer/scene/builtin/modelling/random.hpp"

namespace raycache::tracer::courtyard {
namespace {

/// Bars of one piece of furniture: all of one wood and rounding.
struct Carpenter {
    MeshBuilder& b;
    int rounding;
    void operator()(Vec3 from, Vec3 to, float width, float height, Vec3 up = {0, 1, 0}) const {
        bar(b, from, to, up, width, height, rounding, 0.008F);
    }
};

/// Seen by the sitter: front is +Z.
void slatted_chair(MeshBuilder& b, Fineness fine) {
    const Carpenter put{b, fine.of(1.3, 0)};
    const Vec3 z{0, 0, 1};
    for (const float x : {-0.19F, 0.19F}) {
        put({x, 0, 0.19F}, {x, 0.43F, 0.19F}, 0.036F, 0.036F, z);
        put({x, 0, -0.24F}, {x, 0.45F, -0.19F}, 0.036F, 0.036F, z);
        put({x, 0.44F, -0.19F}, {x, 0.92F, -0.27F}, 0.036F, 0.032F, z);
    }
    if (fine.value < 0.4) {
        put({-0.2F, 0.44F, 0}, {0.2F, 0.44F, 0}, 0.42F, 0.025F);
    } else {
        for (const float x : {-0.19F, 0.19F}) {
            put({x, 0.20F, -0.21F}, {x, 0.20F, 0.19F}, 0.02F, 0.03F);
            put({x, 0.415F, -0.19F}, {x, 0.415F, 0.19F}, 0.025F, 0.045F);
        }
        put({-0.19F, 0.26F, 0.19F}, {0.19F, 0.26F, 0.19F}, 0.02F, 0.03F);
        put({-0.19F, 0.26F, -0.212F}, {0.19F, 0.26F, -0.212F}, 0.02F, 0.03F);
        const int slats = std::min(7, fine.of(6, 4));
        for (int i = 0; i < slats; ++i) {
            const float at = -0.18F + 0.40F * static_cast<float>(i) / static_cast<float>(slats - 1);
            put({-0.215F, 0.45F, at}, {0.215F, 0.45F, at}, 0.34F / static_cast<float>(slats), 0.018F);
        }
    }
    const int backs = std::min(4, fine.of(3, 2));
    for (int i = 0; i < backs; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(backs - 1), y = 0.60F + 0.28F * t;
        const float deep = -0.19F - 0.167F * (y - 0.44F);
        put({-0.2F, y, deep}, {0.2F, y, deep}, 0.016F, 0.20F / static_cast<float>(backs) + 0.01F);
    }
}

void iron_chair(MeshBuilder& b, Fineness fine) {
    const int around = fine.of(6, 3), pieces = fine.of(8, 3);
    b.use(Stuff::iron);
    const auto hoop = [&](float width, float top, float wire) {
        std::vector<Vec3> path{{-width, 0, -0.22F}, {-width, 0.45F, -0.18F}};
        for (int i = 0; i <= pieces; ++i) {
            const auto [c, s] = cos_sin(0.5 * i / pieces);
            const float y = top - width + width * s;
            path.push_back({-width * c, y, -0.18F - 0.2F * (y - 0.45F)});
        }
        path.push_back({width, 0.45F, -0.18F});
        path.push_back({width, 0, -0.22F});
        tube(b, path, wire, around);
    };
    hoop(0.18F, 0.90F, 0.011F);
    if (fine.value > 0.35) {
        std::vector<Vec3> heart;
        for (int i = 0; i <= 2 * pieces; ++i) {
            const auto [c, s] = cos_sin(static_cast<double>(i) / (2 * pieces));
            const float y = 0.68F + 0.1F * c;
            heart.push_back({0.1F * s, y, -0.18F - 0.2F * (y - 0.45F)});
        }
        tube(b, heart, 0.007F, around);
        ring(b, {0, 0.24F, 0}, 0.16F, 0.008F, 2 * pieces, around);
    }
    for (const float x : {-0.16F, 0.16F}) {
        const std::array<Vec3, 3> leg{{{x, 0.45F, 0.12F}, {x * 0.9F, 0.24F, 0.13F}, {x * 1.15F, 0, 0.2F}}};
        tube(b, leg, 0.010F, around);
    }
    b.use(Stuff::light_wood);
    constexpr std::array<Turning, 6> seat{
        {{0, 0.44F}, {0.20F, 0.44F, true}, {0.215F, 0.447F}, {0.215F, 0.463F}, {0.20F, 0.47F, true}, {0, 0.465F}}};
    if (fine.value < 0.35)
        lathe(b, std::span(seat).subspan(3), 6);
    else
        lathe(b, curve(seat, fine.of(1, 1)), fine.of(16, 8));
}

void pedestal(MeshBuilder& b, Fineness fine, bool top) {
    b.use(Stuff::dark_wood);
    constexpr std::array<Turning, 8> stem{{{0.06F, 0.10F, true},
                                           {0.075F, 0.16F},
                                           {0.05F, 0.24F},
                                           {0.045F, 0.40F},
                                           {0.06F, 0.48F},
                                           {0.04F, 0.55F},
                                           {0.05F, 0.68F},
                                           {0.12F, 0.71F}}};
    lathe(b, curve(stem, fine.of(2, 1)), fine.of(12, 5));
    for (int i = 0; i < 4; ++i) {
        const auto [c, s] = cos_sin(0.25 * i + 0.125);
        const std::array<Vec3, 4> foot{{{0, 0.22F, 0},
                                        {0.16F * c, 0.18F, -0.16F * s},
                                        {0.26F * c, 0.06F, -0.26F * s},
                                        {0.36F * c, 0.025F, -0.36F * s}}};
        const std::array<float, 4> radii{0.035F, 0.03F, 0.026F, 0.024F};
        tube(b, foot, radii, fine.of(7, 3));
    }
    b.use(Stuff::light_wood);
    constexpr std::array<Turning, 6> plate{
        {{0, 0.70F}, {0.50F, 0.70F, true}, {0.525F, 0.71F}, {0.525F, 0.73F}, {0.51F, 0.74F, true}, {0, 0.74F}}};
    if (top) lathe(b, curve(plate, fine.of(2, 1)), fine.of(36, 12));
}

/// Lies on the plate and hangs in folds.
void cloth(MeshBuilder& b, Fineness fine, Stuff stuff) {
    b.use(stuff);
    sheet(b, std::max(18, fine.of(56, 18)), fine.of(7, 3), [](float u, float v) {
        const auto [c, s] = cos_sin(static_cast<double>(u));
        // From the rim, v = 0, up over the edge at v = 0.5 and in to the middle, v = 1.
        if (v > 0.49F) {
            const float r = std::max(0.004F, 0.535F * (1 - v) / 0.5F);  // no needles
            return Vec3{r * c, 0.742F, -r * s};
        }
        const float down = (0.5F - v) / 0.5F;
        const float fold =
            cos_sin(9 * static_cast<double>(u)).cos + 0.5F * cos_sin(5 * static_cast<double>(u) + 0.1).cos;
        const float r = 0.54F + down * (0.04F + 0.03F * fold);
        return Vec3{r * c, 0.742F - 0.34F * down - 0.02F * down * fold, -r * s};
    });
}

void plank_table(MeshBuilder& b, Fineness fine) {
    const Carpenter put{b, fine.of(1.3, 0)};
    const int planks = std::min(7, fine.of(5, 3));
    for (int i = 0; i < planks; ++i) {
        const float width = 0.92F / static_cast<float>(planks), z = -0.46F + width * (static_cast<float>(i) + 0.5F);
        put({-0.46F, 0.727F, z}, {0.46F, 0.727F, z}, width - 0.006F, 0.025F);
    }
    for (const float x : {-0.4F, 0.4F}) {
        for (const float z : {-0.4F, 0.4F}) put({x, 0, z}, {x, 0.715F, z}, 0.06F, 0.06F, {0, 0, 1});
        put({x, 0.67F, -0.4F}, {x, 0.67F, 0.4F}, 0.025F, 0.08F);
        put({-0.4F, 0.67F, x}, {0.4F, 0.67F, x}, 0.025F, 0.08F);
    }
}

void parasol(MeshBuilder& b, Fineness fine, Stuff one, Stuff other) {
    const int across = fine.of(5, 1), down = fine.of(6, 2), around = fine.of(8, 4);
    for (int gore = 0; gore < 8; ++gore) {
        b.use(gore % 2 == 0 ? one : other);
        const auto at = [&](float u, float v) {  // v = 0 at the valance
            const auto [c, s] = cos_sin((gore + static_cast<double>(u)) / 8);
            const float between = 4 * u * (1 - u);
            const float out = std::min(1.0F, (1 - v) / 0.9F), hang = std::max(0.0F, 0.1F - v) * 1.6F;
            const float r = std::max(0.015F, 1.55F * out) * (1 - 0.06F * between);
            return Vec3{r * c, 2.95F - 0.62F * out * (0.75F + 0.25F * out) - 0.05F * between * out - hang, -r * s};
        };
        sheet(b, across, std::max(down, 3), at);
    }
    b.use(Stuff::light_wood);
    const std::array<Vec3, 2> pole{{{0, 0, 0}, {0, 3.02F, 0}}};
    tube(b, pole, 0.022F, around);
    for (int rib = 0; rib < 8; ++rib) {
        const auto [c, s] = cos_sin(rib / 8.0);
        const std::array<Vec3, 2> stick{{{0, 2.25F, 0}, {0.85F * c, 2.55F, -0.85F * s}}};
        tube(b, stick, 0.009F, fine.of(5, 3));
    }
}

}  // namespace

void furniture(MeshBuilder& b, Fineness fine) {
    using Kind = TableSite::Kind;
    MeshBuilder wooden = b.part(), iron = b.part(), planks = b.part(), round = b.part(), covered = b.part();
    slatted_chair(wooden, fine);
    iron_chair(iron, fine);
    plank_table(planks, fine);
    pedestal(round, fine, true);
    pedestal(covered, fine, false);
    Random random(41);
    int number = 0;
    for (const TableSite& site : table_sites) {
        const Transform place = moved(site.at) * turned(site.turn);
        if (site.kind == Kind::square_blue) b.add(planks, place, Stuff::light_wood);
        if (site.kind == Kind::round_wood) b.add(round, place);
        if (site.kind == Kind::round_cloth) {
            b.add(covered, place);
            b.frame(place);
            cloth(b, fine, number % 2 == 0 ? Stuff::white_cloth : Stuff::red_cloth);
            b.frame({});
        }
        if (site.parasol) {
            b.frame(place);
            parasol(b, fine, number % 2 == 0 ? Stuff::red_cloth : Stuff::green_paint, Stuff::white_cloth);
            b.frame({});
        }
        for (int i = 0; i < site.chairs; ++i) {
            const float quarter = static_cast<float>(i) * 0.25F + random.in(-0.02F, 0.02F);
            const float away = random.in(0.56F, 0.74F);
            const float aside = random.in(-0.06F, 0.06F), askew = random.in(-0.04F, 0.04F);
            const Transform seat = place * turned(quarter) * moved({aside, 0, -away}) * turned(askew);
            if (site.kind == Kind::round_cloth)
                b.add(iron, seat);
            else
                b.add(wooden, seat, site.kind == Kind::square_blue ? Stuff::blue_paint : Stuff::dark_wood);
        }
        ++number;
    }
}

}  // namespace raycache::tracer::courtyard
