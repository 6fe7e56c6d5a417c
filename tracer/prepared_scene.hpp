// A scene with everything derived from it once: BVH, lights, texel layout. Shared by all captures and renders of it.
#pragma once

#include "tracer/bvh/bvh.hpp"
#include "tracer/bvh/layouts/bvh2.hpp"
#include "tracer/paths/lights.hpp"
#include "tracer/scene/scene.hpp"
#include "tracer/scene/texel_layout.hpp"

namespace raycache::tracer {

class PreparedScene {
public:
    PreparedScene(Scene scene, const BvhSettings& settings)
        : scene_(with_offset_scale(std::move(scene))),
          bvh_(make_bvh2(build_bvh(scene_, settings), scene_)),
          lights_(scene_),
          texels_(scene_) {}
    PreparedScene(const PreparedScene&) = delete;  // its parts point at each other
    PreparedScene& operator=(const PreparedScene&) = delete;

    const Scene& scene() const { return scene_; }
    const Bvh2& bvh() const { return bvh_; }
    const Lights& lights() const { return lights_; }
    const TexelLayout& texels() const { return texels_; }
    const Camera& camera() const { return scene_.cameras.front(); }

private:
    static Scene with_offset_scale(Scene scene) {
        scene.offset_scale = Scene::offset_scale_of(scene.bounds());
        return scene;
    }

    Scene scene_;
    Bvh2 bvh_;
    Lights lights_;
    TexelLayout texels_;
};

}  // namespace raycache::tracer
