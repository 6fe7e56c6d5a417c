// Whether the nodes of a package are a tree over its triangles. A walk of anything else might not end, or read beyond.
#pragma once

#include "tools/gpu/package/package.hpp"

namespace raycache::gpu {

struct TreeFacts {
    const char* fault = nullptr;      ///< what was expected and is not so; nullptr: nothing
    std::uint32_t stack_entries = 0;  ///< that a walk can need
};

TreeFacts check_tree(TreeKind, const BvhPart&);

}  // namespace raycache::gpu
