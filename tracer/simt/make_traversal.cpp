#include "tracer/simt/make_traversal.hpp"

#include <fmt/format.h>

#include "tracer/bvh/layouts/list.hpp"
#include "tracer/simt/warp_traversal.hpp"
#include "traces/error.hpp"

namespace raycache::tracer {
namespace {

/// Makes the traversal of the first layout in the list whose tree this is.
template <class Recorder, class... Layouts>
std::unique_ptr<Traversal> make(const PreparedScene& scene, Recorder& recorder, std::uint8_t own_regions,
                                LayoutList<Layouts...>) {
    std::unique_ptr<Traversal> made;
    const auto try_one = [&]<class Tree>(const Tree* tree) {
        if (tree != nullptr)
            made = std::make_unique<WarpTraversal<Tree, Recorder>>(scene.scene(), *tree, scene.texels(), recorder,
                                                                   own_regions);
        return tree != nullptr;
    };
    if (!(try_one(dynamic_cast<const typename Layouts::Tree*>(&scene.bvh())) || ...))
        throw Error("a BVH in a layout that tracer/bvh/layouts/list.hpp lacks");
    return made;
}

}  // namespace

template <class Recorder>
std::unique_ptr<Traversal> make_traversal(const PreparedScene& scene, Recorder& recorder, std::uint8_t own_regions) {
    return make(scene, recorder, own_regions, BvhLayouts{});
}

template std::unique_ptr<Traversal> make_traversal(const PreparedScene&, WarpRecorder&, std::uint8_t);
template std::unique_ptr<Traversal> make_traversal(const PreparedScene&, NullRecorder&, std::uint8_t);
template std::unique_ptr<Traversal> make_traversal(const PreparedScene&, HoleRecorder&, std::uint8_t);

}  // namespace raycache::tracer
