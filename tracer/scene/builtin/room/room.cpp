#include "tracer/scene/builtin/room/room.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "tracer/scene/builtin/modelling/budget.hpp"
#include "tracer/scene/builtin/modelling/finish.hpp"
#include "tracer/scene/builtin/room/parts.hpp"

namespace raycache::tracer::room {
namespace {

/// The rug takes all that the others leave.
constexpr std::array<Part, 10> budget{{
    {shell, 0.05},
    {floor_boards, 0.05},
    {curtains, 0.10},
    {seats, 0.10},
    {tables, 0.09},
    {books, 0.13},
    {tableware, 0.09},
    {lamps, 0.05},
    {pictures, 0.03},
    {plant, 0.09},
}};

}  // namespace

Scene build(std::uint64_t detail) {
    const std::uint64_t wanted = std::clamp(detail == 0 ? default_detail : detail, min_detail, max_detail);
    MeshBuilder b = build_within(wanted, budget, {rug, rug_vertices});

    Scene scene;
    scene.name = "room(detail=" + std::to_string(wanted) + ")";
    std::move(b).move_into(scene);
    scene.materials = materials();
    scene.textures = textures();
    scene.cameras = {
        camera("sofa", {5.55F, 1.5F, 4.85F}, {2.3F, 0.9F, 1.1F}, 52),
        camera("windows", {5.6F, 1.45F, 1.0F}, {1.2F, 0.95F, 3.2F}, 56),
        camera("table", {2.75F, 1.25F, 4.9F}, {1.35F, 0.78F, 3.85F}, 48),
    };
    scene.hash = hash(scene);
    return scene;
}

}  // namespace raycache::tracer::room
