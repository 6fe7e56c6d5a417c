// A scene with everything derived from it once: BVH, lights, texel layout. Shared by all captures and renders of it.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "tracer/bvh/bvh.hpp"
#include "tracer/bvh/embree_scene.hpp"
#include "tracer/bvh/layouts/layout.hpp"
#include "tracer/paths/lights.hpp"
#include "tracer/scene/scene.hpp"
#include "tracer/scene/texel_layout.hpp"

namespace raycache::tracer {

/// Gives the tree that build_bvh() would build.
using BvhSource = std::function<Bvh(const Scene&, const BvhSettings&)>;

class PreparedScene {
public:
    /// `layout`: a name of bvh_layouts(). Throws UsageError for another.
    PreparedScene(Scene scene, const BvhSettings& settings, const std::string& layout = default_layout,
                  BvhSource source = build_bvh)
        : scene_(with_offset_scale(std::move(scene))),
          settings_(settings),
          layout_(bvh_layout_entry(layout)),
          source_(std::move(source)),
          lights_(scene_),
          texels_(scene_) {}
    PreparedScene(const PreparedScene&) = delete;  // its parts point at each other
    PreparedScene& operator=(const PreparedScene&) = delete;

    const Scene& scene() const { return scene_; }
    /// Built when first asked for, as embree() is: a capture needs the one, a render the other. May be called by
    /// several threads.
    const BvhLayout& bvh() const {
        std::call_once(bvh_once_, [this] {
            scene_.charge(scene_.triangle_count() * bvh_bytes, "BVH of its triangles");
            BvhSettings settings = settings_;
            settings.max_leaf_size = std::min(settings.max_leaf_size, layout_.max_leaf_size);
            bvh_ = layout_.make(source_(scene_, settings), scene_);
        });
        return *bvh_;
    }
    const EmbreeScene& embree() const {
        std::call_once(embree_once_, [this] {
            scene_.charge(scene_.triangle_count() * embree_bytes, "Embree's BVH of its triangles");
            embree_.emplace(scene_, texels_);
        });
        return *embree_;
    }
    const std::string& layout() const { return layout_.name; }
    const Lights& lights() const { return lights_; }
    const TexelLayout& texels() const { return texels_; }
    const Camera& camera() const { return scene_.cameras.front(); }

private:
    /// For each triangle, while the tree is built.
    static constexpr std::uint64_t bvh_bytes = 240, embree_bytes = 200;

    static Scene with_offset_scale(Scene scene) {
        scene.offset_scale = Scene::offset_scale_of(scene.bounds());
        return scene;
    }

    Scene scene_;
    BvhSettings settings_;
    const BvhLayoutEntry& layout_;
    BvhSource source_;
    Lights lights_;
    TexelLayout texels_;
    mutable std::once_flag bvh_once_, embree_once_;
    mutable std::unique_ptr<const BvhLayout> bvh_;
    mutable std::optional<EmbreeScene> embree_;
};

}  // namespace raycache::tracer
