#include "tracer/scene/builtin/courtyard/courtyard.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "tracer/scene/builtin/courtyard/parts.hpp"
#include "tracer/scene/builtin/courtyard/plants.hpp"
#include "tracer/scene/builtin/modelling/budget.hpp"
#include "tracer/scene/builtin/modelling/finish.hpp"

namespace raycache::tracer::courtyard {
namespace {

/// Leaves take all that the others leave.
constexpr std::array<Part, 11> budget{{
    {arcade, 0.08},
    {house, 0.05},
    {gallery, 0.08},
    {roof, 0.10},
    {paving, 0.09},
    {fountain, 0.03},
    {furniture, 0.09},
    {tableware, 0.035},
    {ornament, 0.03},
    {pots, 0.025},
    {tree_wood, 0.035},
}};

}  // namespace

Scene build(std::uint64_t detail) {
    const std::uint64_t wanted = std::clamp(detail == 0 ? default_detail : detail, min_detail, max_detail);

    MeshBuilder b = build_within(wanted, budget, {foliage, leaf_vertices});
    Scene scene;
    scene.name = "courtyard(detail=" + std::to_string(wanted) + ")";
    std::move(b).move_into(scene);
    scene.materials = materials();
    scene.textures = textures();
    scene.cameras = {
        camera("yard", {-9.3F, 1.62F, 8.3F}, {0.3F, 2.35F, -4.0F}, 56),
        camera("gallery", {5.0F, 6.1F, -7.45F}, {-1.9F, 0.9F, 2.6F}, 56),
        camera("table", {-3.75F, 1.22F, 5.2F}, {-3.1F, 0.90F, 3.0F}, 50),
    };
    scene.sky = {0.95F, 1.24F, 1.80F};
    scene.sun = Sun{normalize({-0.44F, 0.95F, -0.36F}), {10.5F, 9.4F, 7.6F}, 0.00465F};
    scene.hash = hash(scene);
    return scene;
}

}  // namespace raycache::tracer::courtyard
