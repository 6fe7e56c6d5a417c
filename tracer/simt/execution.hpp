// How the work of a launch is cut into kernels.
//   megakernel  one kernel: a warp keeps its 32 paths from the camera to the end, lanes of ended paths idle
//   wavefront   a kernel per vertex and stage, over the rays that are left (tracer/simt/wavefront.hpp)
#pragma once

#include <string>

namespace raycache::tracer {

struct IntegratorEntry;

enum class Execution { megakernel, wavefront };

/// Throws UsageError that lists the valid names.
Execution execution_from(const std::string& name);
const char* to_string(Execution);

struct ExecutionSettings {
    Execution execution = Execution::megakernel;
    std::string order = "none";  ///< of the rays of a wavefront: a name of ray_orders()
};

/// Throws UsageError for an unknown order, for an order of a megakernel's rays, which never meet, and for a wavefront
/// of an integrator that is not cut into stages.
void check_execution(const ExecutionSettings&, const IntegratorEntry&);

}  // namespace raycache::tracer
