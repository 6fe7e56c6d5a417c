// What a reader of predicted times must know of who walked the BVH.
#pragma once

#include <string>
#include <vector>

namespace raycache::cachesim {

/// "traversal: software", or "traversal: RT unit (assumed)" and what that means for counts. `units`: names of the GPUs
/// that have RT units walk; `software`: others do not.
std::string traversal_note(const std::vector<std::string>& units, bool software);

}  // namespace raycache::cachesim
