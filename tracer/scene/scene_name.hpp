// Whether a word names a scene, before anything is loaded.
#pragma once

#include <string>

namespace raycache::tracer {

/// Throws UsageError unless it names a built-in scene or a file that exists; says which was probably meant.
void check_scene_name(const std::string& source);

}  // namespace raycache::tracer
