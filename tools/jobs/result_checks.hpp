// What must hold of a result beyond its keys and types, for reports to be made of it.
#pragma once

#include <string>

#include "tools/jobs/job_text.hpp"

namespace raycache::tools {

/// Throws Error "SOURCE: …" where parts of the result contradict each other, as in a damaged file.
void check_result(const AnyResult&, const std::string& source);

}  // namespace raycache::tools
