// Which program it is: for provenances, JSON documents and --version.
#pragma once

namespace raycache::tools {

inline constexpr const char* program_name = "raycache " RAYCACHE_VERSION;  ///< "raycache 0.2.0"

}  // namespace raycache::tools
