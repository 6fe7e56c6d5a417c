// raycache capture --gpu-package: the rays of a capture, its BVH, and where every ray ends, as a folder for the
// programs of tools/gpu/ (docs/gpu_package.md).
#pragma once

#include <cstdint>
#include <string>

#include "tools/jobs/observer.hpp"
#include "tools/jobs/subject.hpp"
#include "tracer/capture.hpp"

namespace raycache::tools {

/// What a capture of these settings cannot be made into: throws UsageError for an integrator that walks no BVH.
void check_gpu_package(const tracer::CaptureSettings&);

/// The folder of a package, as it is filled: the files of gpu::package_files() (tools/gpu/package/package.hpp).
class GpuPackageFolder {
public:
    explicit GpuPackageFolder(std::string folder);  ///< made if need be. Throws Error where it cannot be
    ~GpuPackageFolder();                            ///< removes a new one in which nothing was written
    GpuPackageFolder(const GpuPackageFolder&) = delete;
    GpuPackageFolder& operator=(const GpuPackageFolder&) = delete;

    /// The file that is written last, for check_outputs().
    std::string last_file() const;
    /// `trace`: trace_json() of the capture. Returns the number of rays. Throws Error.
    std::uint64_t write(const tracer::Capture&, const Json& trace, const Stage&);

private:
    std::string folder_;
    bool made_ = false, filled_ = false;
};

}  // namespace raycache::tools
