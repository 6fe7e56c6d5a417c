// An explanation of the steady state, from windows: the same blocks and places for both strategies.
#pragma once

#include "tools/jobs/explain_job.hpp"

namespace raycache::tools {

/// The part of run(ExplainJob) for settings that ask for windows; the job has been checked. Throws as begin_explanation()
/// and SceneSettings::prepare() do.
ExplainResult explain_windows(const ExplainJob&, const cachesim::Gpu&, Observer&, const FileNames& outputs);

}  // namespace raycache::tools
