#include "cachesim/gpus/gpu.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "cachesim/gpus/choice.hpp"
#include "cachesim/gpus/gpu_file.hpp"
#include "cachesim/gpus/gpu_name.hpp"
#include "cachesim/gpus/presets.hpp"
#include "traces/did_you_mean.hpp"
#include "traces/error.hpp"
#include "traces/input_pipe.hpp"
#include "traces/regular_file.hpp"

namespace raycache::cachesim {

namespace {

/// Far above any description of a GPU; keeps a wrong path from filling the memory.
constexpr std::size_t most_file_bytes = std::size_t{1} << 20;

std::string read_file(const std::string& path) {
    if (traces::is_pipe(path)) {
        const std::string text = traces::read_pipe(path, most_file_bytes + 1);
        if (text.size() <= most_file_bytes) return text;
        throw Error(fmt::format("{}: expected a .toml file of at most {} bytes, found a longer one; check the path",
                                path, most_file_bytes));
    }
    const auto bytes = read_regular_file(path, "a .toml file that describes a GPU", nullptr, most_file_bytes);
    return {bytes.begin(), bytes.end()};
}

/// A GPU file and what errors call it.
struct GpuText {
    std::string toml, file;
};

GpuText find_text(const std::string& name_or_path) {
    if (is_gpu_file(name_or_path)) return {read_file(name_or_path), name_or_path};
    const std::string name = find_gpu_name(name_or_path);
    const auto& all = preset_texts();
    const auto preset = std::find_if(all.begin(), all.end(), [&](const PresetText& p) { return p.name == name; });
    return {preset->toml, preset->name + ".toml"};
}

/// Letters in lower case, and digits.
std::string letters_and_digits(const std::string& text) {
    std::string out;
    for (const char c : text)
        if (std::isalnum(static_cast<unsigned char>(c)))
            out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return out;
}

}  // namespace

bool is_gpu_file(const std::string& name_or_path) {
    return name_or_path.find('/') != std::string::npos || name_or_path.ends_with(".toml");
}

std::string find_gpu_name(const std::string& name) {
    if (is_gpu_file(name)) return name;
    std::vector<std::string> names;
    for (const PresetText& preset : preset_texts()) {
        if (letters_and_digits(preset.name) == letters_and_digits(name)) return preset.name;
        names.push_back(preset.name);
    }
    throw UsageError(fmt::format("GPU: expected one of {} or the path of a .toml file, found \"{}\"{}",
                                 fmt::join(names, ", "), name, did_you_mean(name, names)));
}

Gpu load_gpu(const std::string& name_or_path, const std::vector<std::string>& changes) {
    const GpuText text = find_text(name_or_path);
    return parse_gpu(text.toml, text.file, changes);
}

std::string no_time_note(const Gpu& gpu) {
    if (!gpu.timing || gpu.timing->not_predicted.empty()) return {};
    const char* const kind = gpu.levels.size() == 3 ? "CPU time" : "time";
    return fmt::format("{}: not predicted for {} ({}; see cachesim/MODEL.md)", kind, gpu.name,
                       gpu.timing->not_predicted);
}

const char* traversal_name(const Gpu& gpu) { return name_of<Traversal>(traversals, gpu.traversal); }

std::vector<GpuValue> gpu_values(const std::string& name_or_path, const std::vector<std::string>& changes) {
    const GpuText text = find_text(name_or_path);
    return parse_gpu_values(text.toml, text.file, changes);
}

std::vector<GpuPreset> gpu_presets() {
    std::vector<GpuPreset> presets;
    for (const PresetText& preset : preset_texts()) {
        const Gpu gpu = parse_gpu(preset.toml, preset.name + ".toml");
        presets.push_back({gpu.name, gpu.description});
    }
    std::sort(presets.begin(), presets.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
    return presets;
}

}  // namespace raycache::cachesim
