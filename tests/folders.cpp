#include "tests/folders.hpp"

#include <cstdlib>

namespace raycache::test {

std::string source_folder() { return RAYCACHE_SOURCE_DIR "/"; }

std::string scenes_folder() {
    if (const char* given = std::getenv("RAYCACHE_SCENES")) return given;
    return source_folder() + "../shared/scenes";
}

}  // namespace raycache::test
