#include "tools/jobs/sensitivity/varied_gpu.hpp"

#include <algorithm>
#include <utility>

#include "cachesim/analysis/latin_hypercube.hpp"
#include "tools/jobs/sensitivity/read_values.hpp"

namespace raycache::tools {

using cachesim::ChosenValue;
using cachesim::GpuValue;

VariedGpu::VariedGpu(std::string name_or_path, std::vector<std::string> changes)
    : name_(std::move(name_or_path)),
      changes_(std::move(changes)),
      gpu_(cachesim::load_gpu(name_, changes_)),
      all_(cachesim::open_values(name_, changes_)) {
    for (const GpuValue& value : all_)
        for (const std::string& other : value.range->values) cachesim::load_with(name_, changes_, {{value.key, other}});
}

VariedGpu::Point VariedGpu::make_point(const std::vector<ChosenValue>& values,
                                       const std::vector<traces::Region>& regions, std::uint32_t sms) {
    const cachesim::Gpu gpu = cachesim::load_with(name_, changes_, values);
    ModelledGpu model = sms == 0 ? whole_gpu(gpu) : scale_model(gpu, sms);
    cachesim::Gpu read = as_replayed(model.gpu, regions);
    const auto same = std::find(as_replayed_.begin(), as_replayed_.end(), read);
    const auto place = static_cast<std::size_t>(same - as_replayed_.begin());
    if (same == as_replayed_.end()) {
        models_.push_back(std::move(model));
        as_replayed_.push_back(std::move(read));
    }
    return {values, place};
}

void VariedGpu::vary(const std::vector<traces::Region>& regions, const VariationSettings& settings) {
    models_.clear();
    as_replayed_.clear();
    open_.clear();
    unread_.clear();
    one_by_one_.clear();
    hypercube_.clear();
    make_point({}, regions, 0);
    reference_ = make_point({}, regions, settings.sms).model;
    for (const GpuValue& value : all_) {
        std::vector<Point> points;
        for (const std::string& other : value.range->values)
            if (other != value.value) points.push_back(make_point({{value.key, other}}, regions, settings.sms));
        const bool read =
            std::any_of(points.begin(), points.end(), [&](const Point& p) { return p.model != reference_; });
        if (!read) {
            unread_.push_back(value.key);
            continue;
        }
        open_.push_back(value);
        one_by_one_.insert(one_by_one_.end(), points.begin(), points.end());
    }
    if (open_.empty()) return;
    for (const auto& x : cachesim::latin_hypercube(settings.samples, open_.size(), settings.seed)) {
        std::vector<ChosenValue> values;
        for (std::size_t d = 0; d < open_.size(); ++d)
            values.emplace_back(open_[d].key, cachesim::value_at(*open_[d].range, x[d]));
        hypercube_.push_back(make_point(values, regions, settings.sms));
    }
}

}  // namespace raycache::tools
