#include "tracer/simt/execution.hpp"

#include <fmt/format.h>

#include "tracer/paths/integrators/integrator.hpp"
#include "tracer/simt/orders/ray_order.hpp"
#include "traces/error.hpp"

namespace raycache::tracer {

Execution execution_from(const std::string& name) {
    if (name == "megakernel") return Execution::megakernel;
    if (name == "wavefront") return Execution::wavefront;
    throw UsageError(fmt::format("unknown execution '{}'; expected one of: megakernel, wavefront", name));
}

const char* to_string(Execution execution) { return execution == Execution::megakernel ? "megakernel" : "wavefront"; }

void check_execution(const ExecutionSettings& settings, const IntegratorEntry& integrator) {
    ray_order_entry(settings.order);
    if (settings.execution == Execution::megakernel && settings.order != "none")
        throw UsageError(
            fmt::format("ray order {} with execution megakernel; expected execution wavefront: a warp of a megakernel "
                        "keeps its paths to the end, so there are no rays in memory to be sorted",
                        settings.order));
    if (settings.execution == Execution::wavefront && integrator.stages == nullptr)
        throw UsageError(
            fmt::format("execution wavefront with integrator {}; expected execution megakernel: it is not cut into the "
                        "stages that a wavefront runs as kernels",
                        integrator.name));
}

}  // namespace raycache::tracer
