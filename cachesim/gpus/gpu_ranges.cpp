#include "cachesim/gpus/gpu_ranges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "traces/error.hpp"

namespace raycache::cachesim {

namespace {

using ValueTexts = std::map<std::string, std::string>;

std::uint64_t number(const ValueTexts& values, const std::string& key, std::uint64_t otherwise) {
    const auto found = values.find(key);
    return found == values.end() ? otherwise : std::stoull(found->second);
}

bool is_changed(const std::vector<std::string>& changes, const std::string& key) {
    return std::any_of(changes.begin(), changes.end(), [&](const auto& c) { return c.starts_with(key + '='); });
}

/// The ways that keep the capacity of a cache whose sets or slices are other ones, to the nearest way.
void keep_capacity(const std::string& level, const ValueTexts& own, ValueTexts& chosen) {
    const std::string sets = level + ".sets", slices = level + ".slices", ways = level + ".ways";
    if (!chosen.contains(sets) && !chosen.contains(slices)) return;
    const std::uint64_t before = number(own, sets, 1) * number(own, slices, 1);
    const std::uint64_t now =
        number(chosen, sets, number(own, sets, 1)) * number(chosen, slices, number(own, slices, 1));
    const std::uint64_t lines = number(chosen, ways, number(own, ways, 1)) * before;
    chosen[ways] = fmt::format("{}", std::max<std::uint64_t>(1, (lines + now / 2) / now));
}

}  // namespace

std::vector<GpuValue> open_values(const std::string& name_or_path, const std::vector<std::string>& changes) {
    std::vector<GpuValue> open;
    for (GpuValue& value : gpu_values(name_or_path, changes))
        if (value.range && value.range->leaves_open()) open.push_back(std::move(value));
    return open;
}

Gpu load_with(const std::string& name_or_path, const std::vector<std::string>& changes,
              const std::vector<ChosenValue>& chosen) {
    Gpu given = load_gpu(name_or_path, changes);
    if (chosen.empty()) return given;
    ValueTexts own, values(chosen.begin(), chosen.end());
    for (const GpuValue& value : gpu_values(name_or_path, changes)) own[value.key] = value.value;
    for (const char* level : {"l1", "l2", "l3"})
        if (!is_changed(changes, std::string(level) + ".ways")) keep_capacity(level, own, values);
    std::vector<std::string> all = changes;
    for (const auto& [key, value] : values) all.push_back(key + '=' + value);
    Gpu gpu = load_gpu(name_or_path, all);
    gpu.name = given.name;
    gpu.changes = given.changes;
    return gpu;
}

}  // namespace raycache::cachesim
