// The parts of the micro-benchmarks; each in a file of its own.
#pragma once

#include "tools/gpu/micro/micro.hpp"

namespace raycache::gpu {

class CudaDevice;

std::vector<Series> measure_latencies(const CudaDevice&, bool quick);
std::vector<Series> measure_bandwidths(const CudaDevice&, bool quick);
std::vector<Series> measure_requests(const CudaDevice&);

}  // namespace raycache::gpu
