// Tests that need something this machine may not have say so here, so that nobody takes them for passed.
#pragma once

#include <string>

namespace raycache::test {

/// Leaves out the running test case, or a part of it: what this machine lacks ("the scene sponza.glb is absent") and
/// how to get it ("put it into ..."). The caller returns, or goes on with its next part. A test case that left
/// something out and did not fail counts as skipped, not as passed: at its end the line
///     SKIPPED {"missing":"...","remedy":"...","test":"..."}
/// is printed once for each thing missing; tools/test_summary.py counts these. For the thread of the test only.
void skip(const std::string& missing, const std::string& remedy);

/// Fails the running test case unless it carries the tag, "[data]" for instance.
void require_tag(const std::string& tag);

}  // namespace raycache::test
