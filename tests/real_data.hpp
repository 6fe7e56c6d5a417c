// Files that are no part of the repository. A test that asks for one carries the tag [data], so that CI can run all
// such tests once more where there are none.
#pragma once

#include <optional>
#include <string>

namespace raycache::test {

/// Path of a real scene, "sponza.glb". Where it is absent the running test case is skipped (tests/skip.hpp) and there
/// is nothing.
std::optional<std::string> real_scene(const std::string& file);

/// Path of a reference trace, "hr_cp" for hr_cp.rtw.zst; else as real_scene().
std::optional<std::string> reference_trace(const std::string& name);

}  // namespace raycache::test
