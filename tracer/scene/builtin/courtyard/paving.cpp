// The yard's floor: worn stones in rows, each a little domed and tilted, over a bed of mortar; kerbs of the arcade.
#include <array>

#include "tracer/scene/builtin/courtyard/parts.hpp"
#include "tracer/scene/builtin/modelling/random.hpp"

namespace raycache::tracer::courtyard {
namespace {

constexpr float kerb = 0.45F;  // from the column axis to the arcade floor's edge

/// A stone of unit length and width, top near y = 0, edges bent down into the joints; `wear` makes stones differ.
void stone(MeshBuilder& b, int cells, Vec3 wear) {
    const auto place = [&](float t) {  // two narrow outer cells, the others even
        const int i = static_cast<int>(t * static_cast<float>(cells) + 0.5F);
        if (i == 0 || i == cells) return i == 0 ? -0.5F : 0.5F;
        return -0.46F + 0.92F * static_cast<float>(i - 1) / static_cast<float>(cells - 2);
    };
    sheet(b, cells, cells, [&](float u, float v) {
        const float x = place(u), z = -place(v);
        const bool edge = std::abs(x) > 0.48F || std::abs(z) > 0.48F;
        const float dome = (1 - 4 * x * x) * (1 - 4 * z * z);
        const float dents =
            cos_sin(static_cast<double>(1.7F * x + wear.x)).cos * cos_sin(static_cast<double>(1.3F * z + wear.y)).cos;
        return Vec3{x, (edge ? -0.05F : 0.0F) + 0.012F * dome + 0.008F * wear.z * dents, z};
    });
}

}  // namespace

void paving(MeshBuilder& b, Fineness fine) {
    const float size = fine.value < 0.25   ? 1.1F
                       : fine.value < 0.45 ? 0.85F
                       : fine.value < 0.9  ? 0.6F
                       : fine.value < 2    ? 0.42F
                                           : 0.3F;
    Random random(31);
    std::array<MeshBuilder, 5> kinds{b.part(), b.part(), b.part(), b.part(), b.part()};
    for (MeshBuilder& kind : kinds) {
        const Vec3 wear{random.unit(), random.unit(), random.in(-1, 1)};
        stone(kind, fine.of(4, 3), wear);
    }
    const float x_end = half_x - kerb, z_end = half_z - kerb;
    const int rows = static_cast<int>(2 * z_end / size);
    const float depth = 2 * z_end / static_cast<float>(rows), joint = 0.012F + 0.015F * size;
    for (int row = 0; row < rows; ++row) {
        const float z = -z_end + depth * (static_cast<float>(row) + 0.5F);
        for (float x = -x_end; x < x_end - 0.01F;) {
            float width = size * random.in(0.85F, 1.75F);
            if (x_end - x - width < 0.6F * size) width = x_end - x;
            const Vec3 middle{x + width / 2, random.in(-0.004F, 0.008F), z};
            x += width;
            const Vec3 tilt = random.jitter(0.008F);
            const std::uint32_t kind = random.below(5), colour = random.below(9);
            const Vec3 to_fountain = middle - fountain_at;
            if (to_fountain.x * to_fountain.x + to_fountain.z * to_fountain.z <
                0.5F * fountain_radius * fountain_radius)
                continue;
            const Stuff stuff = colour < 4 ? Stuff::paver_sand : colour < 7 ? Stuff::paver_grey : Stuff::paver_rose;
            const Transform place{
                {width - joint, tilt.x * width, 0}, {0, 1, 0}, {0, tilt.z * depth, depth - joint}, middle};
            b.add(kinds[kind], place, stuff);
        }
    }
    b.use(Stuff::mortar);
    flat(b, {-half_x, -0.02F, half_z}, {half_x, -0.02F, half_z}, {half_x, -0.02F, -half_z}, {-half_x, -0.02F, -half_z});
    b.use(Stuff::stone);
    for (const Side& side : sides()) {
        b.frame(side.frame);
        const float from = kerb + 0.24F, to = side.length - kerb;
        const int stones = static_cast<int>((to - from) / (fine.value < 0.45 ? 1.7F : 0.85F));
        const float step = (to - from) / static_cast<float>(stones);
        for (int i = 0; i < stones; ++i) {
            const float x = from + step * static_cast<float>(i),
                        y = arcade_floor / 2 - 0.02F + random.in(-0.006F, 0.004F);
            bar(b, {x + 0.006F, y, -kerb - 0.11F}, {x + step - 0.006F, y, -kerb - 0.11F}, {0, 1, 0}, 0.26F,
                arcade_floor + 0.06F, fine.of(1.5, 0), 0.025F);
        }
        bar(b, {kerb - 0.02F, arcade_floor / 2 - 0.02F, -kerb - 0.11F},
            {from - 0.006F, arcade_floor / 2 - 0.02F, -kerb - 0.11F}, {0, 1, 0}, 0.26F, arcade_floor + 0.06F,
            fine.of(1.5, 0), 0.025F);
    }
    b.frame({});
}

}  // namespace raycache::tracer::courtyard
