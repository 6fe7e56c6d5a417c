// Built trees kept in a folder (--bvh-cache), for the next command on the same triangles.
#pragma once

#include <string>

#include "tools/jobs/observer.hpp"
#include "tracer/bvh/bvh.hpp"

namespace raycache::tools {

/// Throws UsageError where something other than a folder has that name. None there yet is fine.
void check_bvh_cache(const std::string& folder);

/// The tree that build_bvh() would build: from the folder, or built and then kept there; the folder is made if need be.
/// What cannot be read is built again, what cannot be kept is not, and `warn` is told.
tracer::Bvh cached_bvh(const std::string& folder, const tracer::Scene&, const tracer::BvhSettings&, const Say& warn);

}  // namespace raycache::tools
