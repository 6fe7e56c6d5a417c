// The upper floor's wooden posts with brackets, the beam they carry, and the railing with turned balusters.
#include <array>

#include "tracer/scene/builtin/courtyard/parts.hpp"

namespace raycache::tracer::courtyard {
namespace {

constexpr float rail_y = gallery_floor + 0.98F, low_rail_y = gallery_floor + 0.16F;

void post(MeshBuilder& b, Fineness fine) {
    const int rounding = fine.of(1, 0);
    const bool coarse = fine.value < 0.45;
    b.use(Stuff::pale_stone);
    box(b, {-0.17F, gallery_floor, -0.17F}, {0.17F, gallery_floor + 0.25F, 0.17F});
    b.use(Stuff::dark_wood);
    constexpr std::array<Turning, 8> profile{{{0.13F, 0.25F, true},
                                              {0.13F, 0.5F, true},
                                              {0.105F, 0.55F, true},
                                              {0.115F, 1.3F},
                                              {0.095F, 2.3F, true},
                                              {0.12F, 2.34F},
                                              {0.10F, 2.39F, true},
                                              {0.10F, 2.5F, true}}};
    const Transform outer = b.frame();
    b.frame(outer * moved({0, gallery_floor, 0}));
    if (coarse)
        lathe(b, every_other(profile), 5);
    else
        lathe(b, curve(profile, fine.of(3, 1)), fine.of(16, 6));
    b.frame(outer);
    // The bracket: three boards, each longer than the one below.
    for (int i = coarse ? 2 : 0; i < 3; ++i) {
        const float reach = 0.22F + 0.2F * static_cast<float>(i);
        const float y = beam_bottom - 0.20F + 0.08F * static_cast<float>(i);
        bar(b, {-reach, y, 0}, {reach, y, 0}, {0, 1, 0}, 0.2F, 0.08F, rounding, 0.02F);
    }
}

void baluster(MeshBuilder& b, Fineness fine) {
    b.use(Stuff::green_paint);
    constexpr std::array<Turning, 13> profile{{{0.028F, 0, true},
                                               {0.028F, 0.09F, true},
                                               {0.018F, 0.10F, true},
                                               {0.026F, 0.13F},
                                               {0.018F, 0.16F},
                                               {0.036F, 0.27F},
                                               {0.030F, 0.40F},
                                               {0.015F, 0.58F},
                                               {0.024F, 0.61F},
                                               {0.016F, 0.64F, true},
                                               {0.028F, 0.66F, true},
                                               {0.028F, 0.76F, true},
                                               {0.028F, 0.80F}}};
    if (fine.value < 0.5) {
        constexpr std::array<Turning, 4> coarse{{{0.022F, 0}, {0.034F, 0.3F}, {0.016F, 0.6F}, {0.026F, 0.8F}}};
        lathe(b, std::span(coarse).subspan(fine.value < 0.25 ? 1 : 0), fine.of(6, 3));
        return;
    }
    lathe(b, curve(profile, fine.of(1.4, 1)), fine.of(8, 4));
}

}  // namespace

void gallery(MeshBuilder& b, Fineness fine) {
    MeshBuilder upright = b.part();
    post(upright, fine);
    MeshBuilder turned_bar = b.part();
    baluster(turned_bar, fine);
    const int rounding = fine.of(1.2, 0);
    for (const Side& side : sides()) {
        b.frame(side.frame);
        for (int i = 0; i < side.bays; ++i) {
            b.add(upright, moved({side.column(i), 0, 0}));
            const float left = side.column(i) + 0.12F, right = side.column(i + 1) - 0.12F;
            b.use(Stuff::green_paint);
            bar(b, {left, rail_y, 0}, {right, rail_y, 0}, {0, 1, 0}, 0.11F, 0.06F, rounding, 0.02F);
            bar(b, {left, low_rail_y, 0}, {right, low_rail_y, 0}, {0, 1, 0}, 0.07F, 0.05F, rounding, 0.01F);
            const int balusters = std::min(26, fine.of(17, 10));
            for (int k = 0; k < balusters; ++k) {
                const float t = (static_cast<float>(k) + 0.5F) / static_cast<float>(balusters);
                const float bottom = fine.value < 0.25 ? low_rail_y - 0.2F : low_rail_y;
                b.add(turned_bar, moved({left + (right - left) * t, bottom, 0}));
            }
        }
        b.use(Stuff::dark_wood);
        const float y = (beam_bottom + beam_top) / 2;
        bar(b, {-0.12F, y, 0}, {side.length - 0.12F, y, 0}, {0, 1, 0}, 0.24F, beam_top - beam_bottom, rounding, 0.03F);
    }
    b.frame({});
}

}  // namespace raycache::tracer::courtyard
