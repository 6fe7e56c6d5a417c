// A CUDA device and memory on it, with errors as the project reports them.
#pragma once

#include <cuda_runtime.h>

#include <cstdint>
#include <string>
#include <utility>

#include "tools/gpu/device_facts.hpp"
#include "traces/error.hpp"

namespace raycache::gpu {

/// Throws Error "WHAT: expected success, found …".
inline void check(cudaError_t status, const char* what) {
    if (status == cudaSuccess) return;
    throw Error(std::string("CUDA: ") + what + ": expected success, found \"" + cudaGetErrorString(status) + "\" (" +
                cudaGetErrorName(status) + ")");
}

/// Memory of the present device.
class DeviceBuffer {
public:
    DeviceBuffer() = default;
    /// `from`: what it holds at first; nullptr: anything. Throws Error where the device has no room.
    DeviceBuffer(const void* from, std::size_t bytes, const char* what) : bytes_(bytes) {
        if (bytes == 0) return;
        std::size_t free = 0, total = 0;
        check(cudaMemGetInfo(&free, &total), "asking for free memory");
        const cudaError_t status = bytes > free ? cudaErrorMemoryAllocation : cudaMalloc(&data_, bytes);
        if (status == cudaErrorMemoryAllocation) {
            cudaGetLastError();
            throw Error(std::string("device memory for ") + what + ": expected " + std::to_string(bytes) +
                        " bytes, found " + std::to_string(free) +
                        " free; capture at a smaller --resolution, or free the device");
        }
        check(status, what);
        if (from != nullptr) check(cudaMemcpy(data_, from, bytes, cudaMemcpyHostToDevice), what);
    }
    ~DeviceBuffer() { cudaFree(data_); }
    DeviceBuffer(DeviceBuffer&& other) noexcept
        : data_(std::exchange(other.data_, nullptr)), bytes_(std::exchange(other.bytes_, 0)) {}
    DeviceBuffer& operator=(DeviceBuffer&& other) noexcept {
        std::swap(data_, other.data_);
        std::swap(bytes_, other.bytes_);
        return *this;
    }

    void* data() const { return data_; }
    template <class T>
    T* as() const {
        return static_cast<T*>(data_);
    }
    std::size_t bytes() const { return bytes_; }

private:
    void* data_ = nullptr;
    std::size_t bytes_ = 0;
};

/// The device with this number, made the present one.
class CudaDevice {
public:
    /// Throws Error: none, or none of that number.
    explicit CudaDevice(std::uint32_t number) : number_(static_cast<int>(number)) {
        int count = 0;
        const cudaError_t status = cudaGetDeviceCount(&count);
        if (status != cudaSuccess || count == 0)
            throw Error(std::string("no CUDA device: expected one and its driver, found ") +
                        (status == cudaSuccess ? "none" : cudaGetErrorString(status)) +
                        "; without one, gpu_replay_cpu checks packages");
        if (number_ >= count)
            throw Error("CUDA device " + std::to_string(number_) + ": expected 0 to " + std::to_string(count - 1) +
                        "; see nvidia-smi -L");
        check(cudaSetDevice(number_), "choosing the device");
        check(cudaGetDeviceProperties(&properties_, number_), "asking for properties");
    }

    /// Throws Error where this program has no code of the kernel for the device.
    void check_code(const void* kernel) const {
        cudaFuncAttributes attributes;
        const cudaError_t status = cudaFuncGetAttributes(&attributes, kernel);
        if (status == cudaErrorNoKernelImageForDevice || status == cudaErrorInvalidDeviceFunction ||
            status == cudaErrorUnsupportedPtxVersion)
            throw Error(std::string(properties_.name) +
                        ": expected a device that this program has code for, found "
                        "compute capability " +
                        std::to_string(properties_.major) + "." + std::to_string(properties_.minor) +
                        "; build with -DCMAKE_CUDA_ARCHITECTURES=" + std::to_string(properties_.major) +
                        std::to_string(properties_.minor) + ", by a CUDA toolkit that knows it");
        check(status, "asking for a kernel");
    }

    /// Kilohertz; 0: not known.
    double attribute(cudaDeviceAttr which) const {
        int value = 0;
        return cudaDeviceGetAttribute(&value, which, number_) == cudaSuccess ? value : 0;
    }
    std::size_t l2_bytes() const { return static_cast<std::size_t>(properties_.l2CacheSize); }
    const cudaDeviceProp& properties() const { return properties_; }

    DeviceFacts facts() const {
        int driver = 0, runtime = 0;
        cudaDriverGetVersion(&driver);
        cudaRuntimeGetVersion(&runtime);
        const auto version = [](int v) { return std::to_string(v / 1000) + "." + std::to_string(v % 1000 / 10); };
        return {{"name", std::string(properties_.name)},
                {"compute_capability", std::to_string(properties_.major) + "." + std::to_string(properties_.minor)},
                {"cuda_driver", version(driver)},
                {"cuda_runtime", version(runtime)},
                {"sms", static_cast<double>(properties_.multiProcessorCount)},
                {"l2_bytes", static_cast<double>(properties_.l2CacheSize)},
                {"memory_bytes", static_cast<double>(properties_.totalGlobalMem)},
                {"shared_memory_per_sm_bytes", static_cast<double>(properties_.sharedMemPerMultiprocessor)},
                {"registers_per_sm", static_cast<double>(properties_.regsPerMultiprocessor)},
                {"warps_per_sm", static_cast<double>(properties_.maxThreadsPerMultiProcessor / 32)},
                {"highest_sm_clock_khz", attribute(cudaDevAttrClockRate)},
                {"highest_memory_clock_khz", attribute(cudaDevAttrMemoryClockRate)},
                {"memory_bus_bits", attribute(cudaDevAttrGlobalMemoryBusWidth)}};
    }

private:
    int number_;
    cudaDeviceProp properties_{};
};

}  // namespace raycache::gpu
