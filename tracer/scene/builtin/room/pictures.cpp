// Paintings over the sofa, and a mirror over the sideboard, in their frames.
#include <array>

#include "tracer/scene/builtin/room/parts.hpp"

namespace raycache::tracer::room {
namespace {

/// In the plane Z = 0, seen from +Z, around the origin. The content lies in the frame; `part`: of the texture, in U.
void framed(MeshBuilder& b, Vec2 half, float wood, Stuff frame, Stuff content, Vec2 part, Fineness fine) {
    const int rounding = fine.of(5, 1);
    const float x = half.x, y = half.y;
    b.use(frame);
    for (const float side : {-1.F, 1.F}) {
        bar(b, {-x - wood, side * (y + wood / 2), 0.018F}, {x + wood, side * (y + wood / 2), 0.018F}, {0, 0, 1}, wood,
            0.036F, rounding, 0.014F);
        bar(b, {side * (x + wood / 2), -y, 0.018F}, {side * (x + wood / 2), y, 0.018F}, {0, 0, 1}, wood, 0.036F,
            rounding, 0.014F);
    }
    b.use(content);
    const int cells = fine.of(6, 1);
    sheet(
        b, cells, cells,
        [&](float u, float v) {
            return Vec3{x * (2 * u - 1), y * (2 * v - 1), 0.012F};
        },
        {part.y - part.x, -1}, false);
}

}  // namespace

void pictures(MeshBuilder& b, Fineness fine) {
    struct Hung {
        Vec3 at;
        Vec2 half, part;
    };
    constexpr std::array<Hung, 3> row{{{{1.95F, 1.62F, 0.004F}, {0.24F, 0.32F}, {0, 0.7F}},
                                       {{2.75F, 1.68F, 0.004F}, {0.42F, 0.3F}, {0, 1}},
                                       {{3.55F, 1.62F, 0.004F}, {0.24F, 0.32F}, {0, 0.7F}}}};
    for (const Hung& h : row) {
        b.frame(moved(h.at));
        framed(b, h.half, 0.035F, Stuff::dark_wood, Stuff::painting, h.part, fine);
    }
    // On the wall at the greatest X, seen from the room.
    b.frame(moved({width - 0.004F, 1.55F, (sideboard_from.z + sideboard_to.z) / 2}) * turned(-0.25));
    framed(b, {0.55F, 0.38F}, 0.05F, Stuff::brass, Stuff::mirror, {0, 1}, fine);
    b.frame({});
}

}  // namespace raycache::tracer::room
