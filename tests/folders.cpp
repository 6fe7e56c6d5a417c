#include "tests/folders.hpp"

#include <cstdlib>

namespace raycache::test {
namespace {

std::string folder(const char* variable, const char* beside) {
    if (const char* given = std::getenv(variable)) return given;
    return source_folder() + beside;
}

}  // namespace

std::string source_folder() { return RAYCACHE_SOURCE_DIR "/"; }

std::string scenes_folder() { return folder("RAYCACHE_SCENES", "../shared/scenes"); }

std::string reference_folder() { return folder("RAYCACHE_REFERENCE", "../shared/reference"); }

std::string scenes_remedy() {
    return "put the .glb files into " + scenes_folder() + ", or set RAYCACHE_SCENES to their folder";
}

std::string reference_remedy() {
    return "put the .rtw.zst files into " + reference_folder() + ", or set RAYCACHE_REFERENCE to their folder";
}

}  // namespace raycache::test
