#include "tools/program/gpu_details.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cachesim/gpus/choice.hpp"
#include "cachesim/gpus/gpu.hpp"
#include "cachesim/report/table.hpp"

namespace raycache::tools {
namespace {

std::string shape(const cachesim::CacheGeometry& cache) {
    return fmt::format("{}{} x {}", cache.slices > 1 ? fmt::format("{} x ", cache.slices) : "", cache.sets, cache.ways);
}

/// "may be 55 to 62: why", a line below the source; nothing where the file gives no range.
std::string range_line(const cachesim::GpuValue& v, std::size_t indent) {
    if (!v.range) return {};
    const std::string values = v.range->listed ? fmt::format("{}", fmt::join(v.range->values, ", "))
                                               : fmt::format("{} to {}", v.range->values[0], v.range->values[1]);
    return fmt::format("{:{}}may be {}: {}\n", "", indent, values, v.range->source);
}

nlohmann::ordered_json number_or_text(const std::string& value) {
    const bool number = !value.empty() && value.find_first_not_of("0123456789") == std::string::npos;
    return number ? nlohmann::ordered_json(std::stoull(value)) : nlohmann::ordered_json(value);
}

nlohmann::ordered_json entry_json(const cachesim::GpuValue& v) {
    nlohmann::ordered_json given = {{"value", number_or_text(v.value)}, {"source", v.source}};
    if (!v.range) return given;
    nlohmann::ordered_json& list = given[v.range->listed ? "choices" : "range"];
    for (const std::string& value : v.range->values) list.push_back(number_or_text(value));
    given["range_source"] = v.range->source;
    return given;
}

}  // namespace

std::string gpu_details_text(std::size_t width) {
    using Align = cachesim::TextTable::Align;
    cachesim::TextTable table;
    table.column("GPU", Align::left);
    table.column("SMs", Align::right);
    for (const char* title : {"warps/SM", "warps/CTA"}) table.column(title, Align::right, 1);
    for (const char* title : {"L1s/SM", "L1 KiB"}) table.column(title, Align::right);
    table.column("L1 sets x ways", Align::right);
    table.column("L1 index", Align::left, 2);
    table.column("L1 policy", Align::left, 3);
    table.column("L2 MiB", Align::right);
    table.column("L2 sets x ways", Align::right);
    table.column("L2 index", Align::left, 2);
    table.column("L2 policy", Align::left, 3);
    for (const char* title : {"L3 MiB", "line/sector B"}) table.column(title, Align::right);

    std::string values;
    for (const cachesim::GpuPreset& preset : cachesim::gpu_presets()) {
        const cachesim::Gpu gpu = cachesim::load_gpu(preset.name);
        table.row(
            {gpu.name, fmt::format("{}", gpu.sms), fmt::format("{}", gpu.warps_per_sm),
             fmt::format("{}", gpu.warps_per_cta), fmt::format("{}", gpu.l1_per_sm),
             fmt::format("{}", static_cast<double>(gpu.levels[0].bytes()) / 1024), shape(gpu.levels[0]),
             cachesim::name_of<cachesim::SetIndex>(cachesim::set_indices, gpu.levels[0].index), gpu.levels[0].policy,
             fmt::format("{}", static_cast<double>(gpu.levels[1].bytes()) / (1024 * 1024)), shape(gpu.levels[1]),
             cachesim::name_of<cachesim::SetIndex>(cachesim::set_indices, gpu.levels[1].index), gpu.levels[1].policy,
             gpu.levels.size() > 2 ? fmt::format("{}", static_cast<double>(gpu.levels[2].bytes()) / (1024 * 1024))
                                   : "-",
             fmt::format("{}/{}", gpu.levels[0].line_bytes, gpu.levels[0].sector_bytes)});
        values += cachesim::break_lines(fmt::format("\n{}: {}\n", gpu.name, gpu.description), width, 4);
        const auto all = cachesim::gpu_values(preset.name);
        constexpr std::size_t widest_value = 24;  // a longer one has lines of its own
        std::size_t keys = 0, widths = 0;
        for (const auto& v : all) {
            keys = std::max(keys, v.key.size());
            if (v.value.size() <= widest_value) widths = std::max(widths, v.value.size());
        }
        const std::size_t sources = keys + widths + 6;
        for (const auto& v : all) {
            const std::string value = v.value.size() <= widest_value ? fmt::format("{:>{}}  ", v.value, widths)
                                                                     : fmt::format("{}\n{:{}}", v.value, "", sources);
            const std::size_t indent = v.value.size() <= widest_value ? sources : keys + 4;
            values +=
                cachesim::break_lines(fmt::format("  {:<{}}  {}{}\n", v.key, keys, value, v.source), width, indent);
            values += cachesim::break_lines(range_line(v, indent), width, indent);
        }
    }
    return table.text(width) + '\n' +
           cachesim::break_lines(
               "L1 KiB: of one L1; L1s/SM: how many an SM has; sets x ways: of the L2 after its slices where it has "
               "several; L2 MiB: of the whole GPU, or where there is an L3 of one core\n",
               width) +
           values;
}

std::string gpu_details_json() {
    nlohmann::ordered_json gpus = nlohmann::ordered_json::array();
    for (const cachesim::GpuPreset& preset : cachesim::gpu_presets()) {
        const cachesim::Gpu gpu = cachesim::load_gpu(preset.name);
        nlohmann::ordered_json& out = gpus.emplace_back();
        out["name"] = gpu.name;
        out["description"] = gpu.description;
        for (const cachesim::GpuValue& value : cachesim::gpu_values(preset.name)) {
            const std::string& key = value.key;
            const nlohmann::ordered_json given = entry_json(value);
            const auto dot = key.find('.');
            if (dot == std::string::npos) {
                out[key] = given;
                continue;
            }
            const std::string table = key.substr(0, dot);  // "l1", "front_end"
            for (std::size_t level = 0; level < gpu.levels.size(); ++level)
                if (table == fmt::format("l{}", level + 1)) out[table]["bytes"] = gpu.levels[level].bytes();
            out[table][key.substr(dot + 1)] = given;
        }
    }
    return nlohmann::ordered_json{{"gpu_presets", gpus}}.dump(2) + "\n";
}

}  // namespace raycache::tools
