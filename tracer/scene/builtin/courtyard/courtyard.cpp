#include "tracer/scene/builtin/courtyard/courtyard.hpp"

#include <xxhash.h>

#include <algorithm>
#include <array>
#include <utility>

#include "tracer/scene/builtin/courtyard/parts.hpp"
#include "tracer/scene/builtin/courtyard/plants.hpp"

namespace raycache::tracer::courtyard {
namespace {

using Part = void (*)(MeshBuilder&, Fineness);

/// What each part may use of the wanted triangles. Leaves take all that the others leave.
constexpr std::array<std::pair<Part, double>, 11> budget{{
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

struct Size {
    std::size_t vertices, triangles;
};

Size size_of(Part part, Fineness fine) {
    MeshBuilder counter = MeshBuilder::counter();
    part(counter, fine);
    return {counter.vertices(), counter.triangles()};
}

/// The greatest fineness, to one per cent, at which `part` stays within `triangles`; the least where none does.
Fineness fit(Part part, double triangles) {
    double low = 0.2, high = 24;
    while (high > 1.01 * low) {
        const double middle = std::sqrt(low * high);
        (static_cast<double>(size_of(part, {middle}).triangles) <= triangles ? low : high) = middle;
    }
    return {low};
}

Camera camera(const char* name, Vec3 eye, Vec3 look_at, float vertical_fov) {
    Camera c;
    c.name = name;
    c.eye = eye;
    c.forward = normalize(look_at - eye);
    const Vec3 right = normalize(cross(c.forward, {0, 1, 0}));
    c.up = cross(right, c.forward);
    c.vertical_fov = vertical_fov;
    return c;
}

template <class T>
void hash_bytes(XXH3_state_t* state, const std::vector<T>& values) {
    XXH3_64bits_update(state, values.data(), values.size() * sizeof(T));
}

std::uint64_t hash(const Scene& scene) {
    XXH3_state_t* state = XXH3_createState();
    XXH3_64bits_reset(state);
    hash_bytes(state, scene.positions);
    hash_bytes(state, scene.indices);
    hash_bytes(state, scene.material_of);
    hash_bytes(state, scene.texcoords);
    for (const Material& m : scene.materials) XXH3_64bits_update(state, &m.base_color, sizeof m.base_color);
    for (const Texture& t : scene.textures) hash_bytes(state, t.rgba);
    const std::uint64_t value = XXH3_64bits_digest(state);
    XXH3_freeState(state);
    return value;
}

}  // namespace

Scene build(std::uint64_t detail) {
    const std::uint64_t wanted = std::clamp(detail == 0 ? default_detail : detail, min_detail, max_detail);

    std::array<Fineness, budget.size()> fineness;
    Size built{0, 0};
    for (std::size_t i = 0; i < budget.size(); ++i) {
        const auto [part, share] = budget[i];
        fineness[i] = fit(part, share * static_cast<double>(wanted));
        const Size size = size_of(part, fineness[i]);
        built.vertices += size.vertices;
        built.triangles += size.triangles;
    }
    const std::size_t for_leaves = wanted > built.triangles ? wanted - built.triangles : 0;

    MeshBuilder b;
    b.reserve(built.vertices + leaf_vertices(for_leaves), wanted);
    for (std::size_t i = 0; i < budget.size(); ++i) budget[i].first(b, fineness[i]);
    foliage(b, for_leaves);

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
