// What a built-in scene needs beside its triangles.
#pragma once

#include <cstdint>

#include "tracer/scene/scene.hpp"

namespace raycache::tracer::modelling {

/// Upright.
Camera camera(const char* name, Vec3 eye, Vec3 look_at, float vertical_fov);

/// XXH3-64 of geometry, base colours and textures, for Scene::hash.
std::uint64_t hash(const Scene&);

}  // namespace raycache::tracer::modelling
