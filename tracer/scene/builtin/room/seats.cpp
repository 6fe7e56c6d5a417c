// Sofa and armchair, with their cushions, and a blanket.
#include <array>

#include "tracer/scene/builtin/modelling/random.hpp"
#include "tracer/scene/builtin/room/parts.hpp"

namespace raycache::tracer::room {

void cushion(MeshBuilder& b, Vec3 half, Fineness fine) {
    const int cells = fine.of(12, 4);
    for (const float side : {1.F, -1.F}) {
        sheet(b, cells, cells,
              [&](float u, float v) {
                  const float x = 2 * u - 1, z = side * (1 - 2 * v), x2 = x * x, z2 = z * z;
                  const float thick = (1 - x2 * x2) * (1 - z2 * z2), pull = 1 - 0.07F * (x2 * (1 - z2) + z2 * (1 - x2));
                  return Vec3{half.x * x * pull, side * half.y * thick, half.z * z * pull};
              },
              {3, 3});
    }
}

namespace {

/// One of the soft blocks that seats are made of: from corner to corner, all edges along X round.
void block(MeshBuilder& b, Vec3 lower, Vec3 upper, float radius, Fineness fine) {
    const float y = (lower.y + upper.y) / 2, z = (lower.z + upper.z) / 2;
    bar(b, {lower.x, y, z}, {upper.x, y, z}, {0, 1, 0}, upper.z - lower.z, upper.y - lower.y, fine.of(6, 1), radius);
}

/// The same along Z.
void long_block(MeshBuilder& b, Vec3 lower, Vec3 upper, float radius, Fineness fine) {
    const float y = (lower.y + upper.y) / 2, x = (lower.x + upper.x) / 2;
    bar(b, {x, y, lower.z}, {x, y, upper.z}, {0, 1, 0}, upper.x - lower.x, upper.y - lower.y, fine.of(6, 1), radius);
}

void feet(MeshBuilder& b, float x, float z0, float z1, Fineness fine) {
    b.use(Stuff::dark_wood);
    const std::array<float, 2> radii{0.014F, 0.024F};
    for (const float at_x : {-x, x})
        for (const float at_z : {z0, z1}) {
            const std::array<Vec3, 2> leg{{{at_x * 1.02F, 0, at_z}, {at_x, 0.17F, at_z}}};
            tube(b, leg, radii, fine.of(12, 5));
        }
}

/// Faces +Z; `places` of 0.7 m between the arms.
void upholstered(MeshBuilder& b, int places, Stuff frame, Stuff cover, Fineness fine) {
    const float half = 0.35F * static_cast<float>(places);
    feet(b, half + 0.05F, -0.33F, 0.35F, fine);
    b.use(frame);
    block(b, {-half - 0.14F, 0.15F, -0.42F}, {half + 0.14F, 0.28F, 0.42F}, 0.03F, fine);
    for (const float side : {-1.F, 1.F}) {
        const float in = side * half, out = side * (half + 0.16F);
        long_block(b, {std::min(in, out), 0.2F, -0.44F}, {std::max(in, out), 0.6F, 0.44F}, 0.06F, fine);
    }
    block(b, {-half - 0.02F, 0.25F, -0.46F}, {half + 0.02F, 0.84F, -0.26F}, 0.08F, fine);
    const Transform outer = b.frame();
    for (int i = 0; i < places; ++i) {
        const float x = -half + 0.7F * static_cast<float>(i) + 0.35F;
        long_block(b, {x - 0.345F, 0.27F, -0.28F}, {x + 0.345F, 0.43F, 0.46F}, 0.045F, fine);
        b.use(cover);
        b.frame(outer * moved({x, 0.435F, 0.08F}));
        cushion(b, {0.34F, 0.035F, 0.37F}, fine);
        b.frame(outer * moved({x, 0.62F, -0.2F}) * aligned({0, 0.32F, 1}, 0, {}));
        cushion(b, {0.33F, 0.09F, 0.22F}, fine);
        b.use(frame);
        b.frame(outer);
    }
}

}  // namespace

void seats(MeshBuilder& b, Fineness fine) {
    Random random(321);
    const Transform sofa = moved(sofa_at);
    b.frame(sofa);
    upholstered(b, 3, Stuff::canvas, Stuff::linen, fine);
    constexpr std::array<Stuff, 4> covers{Stuff::teal_felt, Stuff::mustard_felt, Stuff::wool_cream, Stuff::teal_felt};
    constexpr std::array<float, 4> places{-0.86F, -0.55F, 0.72F, 0.9F};
    for (std::size_t i = 0; i < covers.size(); ++i) {
        const double turn = static_cast<double>(random.in(-0.06F, 0.06F));
        b.frame(sofa * moved({places[i], 0.67F, -0.02F + 0.05F * static_cast<float>(i % 2)}) * turned(turn) *
                aligned({0, 0.55F, 1}, 0, {}));
        b.use(covers[i]);
        cushion(b, {0.22F, 0.085F, 0.22F}, fine);
    }
    // A blanket over the right arm.
    b.frame(sofa);
    b.use(Stuff::wool_rust);
    sheet(b, fine.of(22, 6), fine.of(30, 8), [](float u, float v) {
        const float across = 1.04F + 0.29F * v, z = 0.36F - 0.5F * u;
        const float over = v < 0.35F ? v / 0.35F : v > 0.65F ? (1 - v) / 0.35F : 1.F;
        const auto [c, s] = cos_sin(static_cast<double>(3 * u));
        const float y = 0.2F + 0.412F * (over * (2 - over)), fold = 0.008F * c * (1.3F - over);
        return Vec3{across - 0.02F + fold, y + 0.004F * s + 0.004F, z};
    });
    b.frame(moved(armchair_at) * turned(static_cast<double>(armchair_turn)));
    upholstered(b, 1, Stuff::leather, Stuff::leather, fine);
    b.frame(b.frame() * moved({0.02F, 0.66F, -0.02F}) * aligned({0, 0.5F, 1}, 0, {}));
    b.use(Stuff::grey_felt);
    cushion(b, {0.21F, 0.08F, 0.21F}, fine);
    b.frame({});
}

}  // namespace raycache::tracer::room
