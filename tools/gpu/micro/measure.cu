#include "tools/gpu/cuda_memory.cuh"
#include "tools/gpu/micro/micro.hpp"
#include "tools/gpu/micro/parts.hpp"

namespace raycache::gpu {
namespace {

__global__ void nothing() {}

}  // namespace

MicroResult measure(const MicroOptions& options) {
    const CudaDevice device(options.device);
    device.check_code(reinterpret_cast<const void*>(&nothing));
    MicroResult result{device.facts(), {}};
    const auto add = [&](std::vector<Series> more) {
        for (Series& series : more) result.series.push_back(std::move(series));
    };
    add(measure_latencies(device, options.quick));
    add(measure_bandwidths(device, options.quick));
    add(measure_requests(device));
    return result;
}

}  // namespace raycache::gpu
