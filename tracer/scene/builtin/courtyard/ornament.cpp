// Lanterns on chains under the arcade's ceiling, and strings of cut paper across the yard.
#include <array>

#include "tracer/scene/builtin/courtyard/parts.hpp"
#include "tracer/scene/builtin/modelling/random.hpp"

namespace raycache::tracer::courtyard {
namespace {

/// Six-sided; hangs with its ring at the origin.
void lantern(MeshBuilder& b, Fineness fine) {
    const int around = fine.of(4, 3);
    b.use(Stuff::iron);
    const auto corner = [](int i, float r, float y) {
        const auto [c, s] = cos_sin(i / 6.0);
        return Vec3{r * c, y, -r * s};
    };
    const bool coarse = fine.value < 0.4;
    for (int i = 0; i < 6; ++i) {
        for (const auto& [r0, y0, r1, y1] :
             {std::array{0.15F, -0.22F, 0.10F, -0.56F}, std::array{0.03F, -0.08F, 0.16F, -0.22F}}) {
            if (coarse && r0 < 0.1F) continue;
            const std::array<Vec3, 2> rod{{corner(i, r0, y0), corner(i, r1, y1)}};
            tube(b, rod, 0.007F, around);
        }
        if (coarse) continue;
        for (const auto& [r, y] : {std::array{0.16F, -0.22F}, std::array{0.10F, -0.56F}, std::array{0.125F, -0.39F}}) {
            const std::array<Vec3, 2> rod{{corner(i, r, y), corner(i + 1, r, y)}};
            tube(b, rod, 0.006F, around);
        }
    }
    constexpr std::array<Turning, 5> roof{
        {{0.18F, -0.22F, true}, {0.15F, -0.17F}, {0.07F, -0.11F}, {0.03F, -0.04F}, {0, -0.03F}}};
    lathe(b, curve(roof, fine.of(2, 1)), fine.of(12, 6));
    constexpr std::array<Turning, 4> foot{{{0, -0.62F}, {0.05F, -0.60F}, {0.11F, -0.565F, true}, {0, -0.56F}}};
    lathe(b, curve(foot, fine.of(2, 1)), fine.of(12, 6));
    b.use(Stuff::wax);
    constexpr std::array<Turning, 4> candle{
        {{0.03F, -0.56F, true}, {0.03F, -0.40F, true}, {0.024F, -0.395F}, {0, -0.40F}}};
    if (coarse)
        lathe(b, every_other(candle), 3);
    else
        lathe(b, candle, fine.of(10, 5));
}

void chain(MeshBuilder& b, Fineness fine, float length) {
    b.use(Stuff::iron);
    if (fine.value < 0.4) {
        const std::array<Vec3, 2> rod{{{0, 0, 0}, {0, length, 0}}};
        return tube(b, rod, 0.008F, 3);
    }
    MeshBuilder link = b.part();
    link.use(Stuff::iron);
    ring(link, {}, 0.022F, 0.005F, fine.of(8, 5), fine.of(4, 3));
    const float step = 0.05F;
    const int links = static_cast<int>(length / step);
    for (int i = 0; i <= links; ++i) {
        const Transform upright{{0, 1.4F, 0}, {1, 0, 0}, {0, 0, -1}, {0, step * static_cast<float>(i), 0}};
        b.add(link, moved({}) * turned(i % 2 == 0 ? 0 : 0.25) * upright);
    }
}

/// A string that sags between two points, with a paper flag every half metre.
void paper_string(MeshBuilder& b, Fineness fine, Vec3 from, Vec3 to, Random& random) {
    const Vec3 span = to - from, along = normalize(Vec3{span.x, 0, span.z}), across{-along.z, 0, along.x};
    const auto hang = [&](float t) { return from + span * t + Vec3{0, -0.75F * 4 * t * (1 - t), 0}; };
    const int pieces = fine.of(40, 12);
    std::vector<Vec3> path;
    for (int i = 0; i <= pieces; ++i) path.push_back(hang(static_cast<float>(i) / static_cast<float>(pieces)));
    b.use(Stuff::white_cloth);
    tube(b, path, 0.006F, fine.of(4, 3));
    const int flags = static_cast<int>(length(span) / 0.5F);
    const int nu = fine.of(3, 1), nv = fine.of(3, 2);
    for (int i = 1; i < flags; ++i) {
        const Vec3 top = hang(static_cast<float>(i) / static_cast<float>(flags));
        const float lean = random.in(-0.35F, 0.35F), curl = random.in(-0.06F, 0.06F);
        constexpr std::array<Stuff, 3> colours{Stuff::paper_pink, Stuff::paper_yellow, Stuff::paper_green};
        b.use(colours[static_cast<std::size_t>(i) % 3]);
        sheet(b, nu, nv,
              [&](float u, float v) {
                  const float out = lean * 0.3F * v + curl * (4 * u * (1 - u) + v * v);
                  return top + along * (0.42F * (u - 0.5F)) + across * out +
                         Vec3{0, -0.32F * v * (1 - 0.1F * std::abs(lean)), 0};
              },
              {1, 1});
    }
}

}  // namespace

void ornament(MeshBuilder& b, Fineness fine) {
    MeshBuilder lamp = b.part();
    lantern(lamp, fine);
    constexpr float hook = slab_bottom - 0.1F, lamp_y = 3.35F;
    MeshBuilder links = b.part();
    chain(links, fine, hook - lamp_y);
    Random random(61);
    for (const Side& side : sides()) {
        b.frame(side.frame);
        for (int i = 0; i < side.bays; ++i) {
            const Vec3 at{side.column(i) + side.pitch() / 2, lamp_y, 1.55F};
            b.add(lamp, moved(at) * turned(random.unit()));
            b.add(links, moved(at));
        }
    }
    b.frame({});
    constexpr float y = 6.9F;
    paper_string(b, fine, {-3.33F, y, half_z}, {0, y, -half_z}, random);
    paper_string(b, fine, {0, y, half_z}, {3.33F, y, -half_z}, random);
    paper_string(b, fine, {6.67F, y, half_z}, {6.67F, y, -half_z}, random);
}

}  // namespace raycache::tracer::courtyard
