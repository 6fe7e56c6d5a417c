// Where tests find their files.
#pragma once

#include <string>

namespace raycache::test {

/// The source folder, with a slash at its end.
std::string source_folder();

/// Where the real scenes lie: RAYCACHE_SCENES, or ../shared/scenes beside the source folder. They are no part of the
/// repository, so the folder may not exist.
std::string scenes_folder();

}  // namespace raycache::test
