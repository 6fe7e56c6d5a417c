// Where tests and benchmarks find their files.
#pragma once

#include <string>

namespace raycache::test {

/// The source folder, with a slash at its end.
std::string source_folder();

/// Where the real scenes lie: RAYCACHE_SCENES, or ../shared/scenes beside the source folder. They are no part of the
/// repository, so the folder may not exist.
std::string scenes_folder();

/// Where the RTWARP01 traces of a cycle-level simulator lie: RAYCACHE_REFERENCE, or ../shared/reference beside the
/// source folder. No part of the repository either.
std::string reference_folder();

/// How a person gets real scenes, or reference traces, to where they are looked for.
std::string scenes_remedy();
std::string reference_remedy();

}  // namespace raycache::test
