// A GPU and all the others that its file says it might be.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cachesim/gpus/gpu_ranges.hpp"
#include "tools/jobs/sensitivity/scale_model.hpp"
#include "traces/header.hpp"

namespace raycache::tools {

/// How many points of what hypercube, and on how many SMs.
struct VariationSettings {
    std::uint32_t samples = 32;
    std::uint64_t seed = 1;
    std::uint32_t sms = 0;  ///< of scale models that are asked how values change a speed-up; 0: the whole GPU is
};

class VariedGpu {
public:
    /// What is done to a file, and which of models() it makes.
    struct Point {
        std::vector<cachesim::ChosenValue> values;
        std::size_t model = 0;
    };

    /// Loads the GPU, and each value by itself. Throws as load_with() does.
    VariedGpu(std::string name_or_path, std::vector<std::string> changes);

    /// Makes the points for replays of these regions. Throws UsageError for values that are right one by one and not
    /// together.
    void vary(const std::vector<traces::Region>&, const VariationSettings&);

    const cachesim::Gpu& gpu() const { return gpu_; }
    /// What to replay, each once however many points make it: first the whole GPU with the values of its file.
    const std::vector<ModelledGpu>& models() const { return models_; }
    /// The GPU of the file as changes are measured from: 0 but for a scale model.
    std::size_t reference() const { return reference_; }
    bool is_scaled() const { return reference_ != 0; }
    const std::vector<cachesim::GpuValue>& open() const { return open_; }
    const std::vector<std::string>& unread() const { return unread_; }
    const std::vector<Point>& one_by_one() const { return one_by_one_; }
    const std::vector<Point>& hypercube() const { return hypercube_; }

private:
    Point make_point(const std::vector<cachesim::ChosenValue>&, const std::vector<traces::Region>&, std::uint32_t sms);

    std::string name_;
    std::vector<std::string> changes_;
    cachesim::Gpu gpu_;
    std::vector<cachesim::GpuValue> all_, open_;
    std::vector<std::string> unread_;
    std::vector<ModelledGpu> models_;
    std::vector<cachesim::Gpu> as_replayed_;  ///< of models_
    std::size_t reference_ = 0;
    std::vector<Point> one_by_one_, hypercube_;
};

}  // namespace raycache::tools
