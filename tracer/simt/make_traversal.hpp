// The warp traversal of whatever layout a scene's BVH has.
#pragma once

#include <memory>

#include "tracer/paths/traversal.hpp"
#include "tracer/prepared_scene.hpp"
#include "tracer/simt/hole_recorder.hpp"
#include "tracer/simt/recorder.hpp"

namespace raycache::tracer {

/// `Recorder` is WarpRecorder, NullRecorder or HoleRecorder. Both arguments must outlive what is made. `own_regions`: index of the
/// first region of the integrator's own.
template <class Recorder>
std::unique_ptr<Traversal> make_traversal(const PreparedScene&, Recorder&, std::uint8_t own_regions = 0);

extern template std::unique_ptr<Traversal> make_traversal(const PreparedScene&, WarpRecorder&, std::uint8_t);
extern template std::unique_ptr<Traversal> make_traversal(const PreparedScene&, NullRecorder&, std::uint8_t);
extern template std::unique_ptr<Traversal> make_traversal(const PreparedScene&, HoleRecorder&, std::uint8_t);

}  // namespace raycache::tracer
