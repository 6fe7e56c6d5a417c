#include "tracer/scene/builtin/modelling/finish.hpp"

#include <xxhash.h>

namespace raycache::tracer::modelling {
namespace {

template <class T>
void hash_bytes(XXH3_state_t* state, const std::vector<T>& values) {
    XXH3_64bits_update(state, values.data(), values.size() * sizeof(T));
}

}  // namespace

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

}  // namespace raycache::tracer::modelling
