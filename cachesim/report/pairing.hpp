// Which two traces a ratio per ray may compare.
#pragma once

#include <string_view>

namespace raycache::cachesim {

/// Whether launches made with these thread maps (Provenance::thread_map) hold the same pixels and sample indices, so
/// that launch by launch they can be paired: "tile" and "classes:M" both trace one sample index of every pixel and
/// differ only in which pixels share a warp, which is part of the strategy.
inline bool same_work_per_launch(std::string_view a, std::string_view b) {
    const auto one_sample = [](std::string_view map) { return map == "tile" || map.starts_with("classes"); };
    return a == b || (one_sample(a) && one_sample(b));
}

}  // namespace raycache::cachesim
