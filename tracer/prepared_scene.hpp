// A scene with everything derived from it once: BVH, lights, texel layout. Shared by all captures and renders of it.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "tracer/bvh/bvh.hpp"
#include "tracer/bvh/embree_scene.hpp"
#include "tracer/bvh/layouts/layout.hpp"
#include "tracer/paths/integrators/integrator.hpp"
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
        : PreparedScene(std::make_shared<Shared>(std::move(scene), settings, std::move(source)), layout) {}
    PreparedScene(const PreparedScene&) = delete;  // captures point at it
    PreparedScene& operator=(const PreparedScene&) = delete;

    /// The same scene, its BVH in another layout; lives as long as this. Throws UsageError for an unknown name. May be
    /// called by several threads.
    const PreparedScene& in_layout(const std::string& layout) const {
        if (layout == layout_.name) return *this;
        const std::lock_guard lock(others_mutex_);
        std::unique_ptr<PreparedScene>& other = others_[layout];
        if (!other) other.reset(new PreparedScene(shared_, layout));
        return *other;
    }

    const Scene& scene() const { return shared_->scene; }
    /// Built when first asked for, as embree() is: a capture needs the one, a render the other. May be called by
    /// several threads.
    const BvhLayout& bvh() const {
        std::call_once(bvh_once_, [this] {
            scene().charge(scene().triangle_count() * bvh_bytes, "BVH of its triangles");
            BvhSettings settings = shared_->settings;
            settings.max_leaf_size = std::min(settings.max_leaf_size, layout_.max_leaf_size);
            bvh_ = layout_.make(shared_->source(scene(), settings), scene());
            if (scene().memory) scene().memory->release(scene().triangle_count() * (bvh_bytes - kept_bytes));
        });
        return *bvh_;
    }
    const EmbreeScene& embree() const {
        std::call_once(shared_->embree_once, [this] {
            scene().charge(scene().triangle_count() * embree_bytes, "Embree's BVH of its triangles");
            shared_->embree.emplace(scene(), texels());
        });
        return *shared_->embree;
    }
    /// What the integrator of these settings prepares for pictures by this camera; null where it prepares nothing. Made
    /// once and kept, as captures of one scene are many. May be called by several threads.
    std::shared_ptr<const IntegratorData> integrator_data(const CameraRays&, const PathSettings&) const;
    const std::string& layout() const { return layout_.name; }
    const Lights& lights() const { return shared_->lights; }
    const TexelLayout& texels() const { return shared_->texels; }
    const Camera& camera() const { return scene().cameras.front(); }

private:
    /// For each triangle, while the tree is built.
    static constexpr std::uint64_t bvh_bytes = 240, embree_bytes = 200;
    /// Of the former once it is built.
    static constexpr std::uint64_t kept_bytes = 112;

    /// What does not depend on the layout.
    struct Shared {
        Shared(Scene s, const BvhSettings& bvh_settings, BvhSource bvh_source)
            : scene(with_giants(std::move(s))),
              settings(bvh_settings),
              source(std::move(bvh_source)),
              lights(scene),
              texels(scene) {}
        Scene scene;
        BvhSettings settings;
        BvhSource source;
        Lights lights;
        TexelLayout texels;
        std::once_flag embree_once;
        std::optional<EmbreeScene> embree;
        std::mutex data_mutex;
        std::map<std::string, std::shared_ptr<const IntegratorData>> data;
    };

    PreparedScene(std::shared_ptr<Shared> shared, const std::string& layout)
        : shared_(std::move(shared)), layout_(bvh_layout_entry(layout)) {}

    static Scene with_giants(Scene scene) {
        scene.giant_above = scene.find_giant_above();
        return scene;
    }

    std::shared_ptr<Shared> shared_;
    const BvhLayoutEntry& layout_;
    mutable std::once_flag bvh_once_;
    mutable std::unique_ptr<const BvhLayout> bvh_;
    mutable std::mutex others_mutex_;
    mutable std::map<std::string, std::unique_ptr<PreparedScene>> others_;
};

}  // namespace raycache::tracer
