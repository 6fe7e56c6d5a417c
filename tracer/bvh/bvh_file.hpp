// A built tree on disk, so that the next command on the same triangles need not build it again. Kept by tools/jobs
// (bvh_cache.hpp); not a format for other programs.
//
// Bytes: the magic "rcbvh\r\n\0"; the key (length in 4 bytes, text); the numbers of nodes and of leaf entries (8 bytes
// each); whether boxes follow (1 byte); one zstd frame; the XXH3-64 of everything before it (8 bytes). All little-
// endian. The frame holds the count of every node (1 byte each), the triangle of every leaf entry (4 bytes each), then,
// unless they are what the triangles make them, the boxes (24 bytes each). Links and boxes follow from the rest.
#pragma once

#include <string>

#include "tracer/bvh/bvh.hpp"

namespace raycache::tracer {

/// Everything the tree depends on, in words, the triangles by their hash. Equal keys, equal trees.
std::string bvh_key(const Scene&, const BvhSettings&);

/// Under which the tree of that key is kept in a folder of many: "HASH.bvh".
std::string bvh_file_name(const std::string& key);

/// `bvh`: what build_bvh() gave. Throws Error where the file cannot be written; none stays behind then.
void write_bvh(const std::string& path, const Bvh& bvh, const Scene&, const std::string& key);

/// What build_bvh() would give. Throws Error where the file cannot be read, is not whole, was written by something else
/// or for another key, or holds no tree over the triangles of the scene. Takes no more memory than build_bvh() does,
/// whatever the file says.
Bvh read_bvh(const std::string& path, const Scene&, const BvhSettings&, const std::string& key);

}  // namespace raycache::tracer
