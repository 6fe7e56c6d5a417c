// The list of layouts. To add one: write NAME.hpp in this folder with a type that has
//   name, description          as the command line and `list layouts` show them
//   max_leaf_size              triangles of a leaf of the tree that it is made of, at most
//   make(const Bvh&, const Scene&)   unique_ptr to a Tree
//   Tree                       what the traversal walks, a WalkableBvh: a type of its own, or that of another layout
// and add it here. Only registry.cpp, memory.cpp and the traversal's factory include this file.
#pragma once

#include "tracer/bvh/layouts/bvh2.hpp"
#include "tracer/bvh/layouts/bvh2_breadth_first.hpp"
#include "tracer/bvh/layouts/bvh2_treelets.hpp"
#include "tracer/bvh/layouts/bvh2_van_emde_boas.hpp"
#include "tracer/bvh/layouts/bvh4.hpp"
#include "tracer/bvh/layouts/cwbvh8.hpp"

namespace raycache::tracer {

template <class... Layouts>
struct LayoutList {};

using BvhLayouts = LayoutList<Bvh2, Bvh2BreadthFirst, Bvh2VanEmdeBoas, Bvh2Treelets, Bvh4, Cwbvh8>;

}  // namespace raycache::tracer
