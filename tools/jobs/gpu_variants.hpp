// GPUs with other values than their files say: one for each combination of what --set lists.
#pragma once

#include <string>
#include <vector>

#include "cachesim/gpus/gpu.hpp"

namespace raycache::tools {

/// As many GPUs as one command may make of its lists.
inline constexpr std::size_t max_gpu_variants = 256;

/// "l1.ways=64,128" -> "l1.ways=64", "l1.ways=128". A comma within brackets, braces or quotes separates nothing.
/// Decimal numbers lose leading zeros; a byte count, of a key with the unit bytes or ".size", may have a unit: 28KiB.
/// Throws UsageError for a value given twice, for a number in another base, and for what is no size.
std::vector<std::string> listed_changes(const std::string& assignment);

/// The variants of one preset or file: every combination of one change of each list, the last list changing fastest.
/// Changes are those of load_gpu(), and "l1.size=BYTES" (l2, l3): the capacity of a cache, without a carve-out. Its
/// lines, slices and sets stay and its ways change; where that gives no whole number, or ways are changed as well, its
/// ways stay and its sets change. Throws UsageError where neither is whole, naming the nearest sizes, and for more than
/// max_gpu_variants combinations; else as load_gpu() does. Changes stand in the name: "rtx-3070 (l1=64 KiB)".
std::vector<cachesim::Gpu> load_gpu_variants(const std::string& name_or_path,
                                             const std::vector<std::vector<std::string>>& lists);

}  // namespace raycache::tools
