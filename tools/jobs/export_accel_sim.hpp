// raycache export --format accel-sim: one launch as a folder for Accel-Sim, or as its one file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/jobs/observer.hpp"
#include "traces/accelsim/traceg_text.hpp"
#include "traces/reader.hpp"

namespace raycache::tools {

/// `output`: FILE.traceg or FILE.traceg.xz, "-" for stdout, a device or named pipe; anything else is a folder, made if
/// need be, for kernel-1.traceg and kernelslist.g.
void export_accel_sim(const traces::Reader&, std::uint32_t launch, const traces::TracegSettings&,
                      const std::string& output, Observer&);

/// The files that export_accel_sim() writes.
std::vector<std::string> accel_sim_files(const std::string& output);

}  // namespace raycache::tools
