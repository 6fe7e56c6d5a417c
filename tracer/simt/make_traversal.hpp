// The warp traversal of whatever layout a scene's BVH has.
#pragma once

#include <memory>

#include "tracer/paths/traversal.hpp"
#include "tracer/prepared_scene.hpp"
#include "tracer/simt/recorder.hpp"

namespace raycache::tracer {

/// `Recorder` is WarpRecorder or NullRecorder. Both arguments must outlive what is made.
template <class Recorder>
std::unique_ptr<Traversal> make_traversal(const PreparedScene&, Recorder&);

extern template std::unique_ptr<Traversal> make_traversal(const PreparedScene&, WarpRecorder&);
extern template std::unique_ptr<Traversal> make_traversal(const PreparedScene&, NullRecorder&);

}  // namespace raycache::tracer
