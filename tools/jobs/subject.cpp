#include "tools/jobs/subject.hpp"

#include <fmt/format.h>

#include <sstream>

#include "cachesim/report/json_key.hpp"

namespace raycache::tools {

using cachesim::snake_case;

Json value_json(const std::string& text) {
    if (!text.empty() && text.find_first_not_of("+-.0123456789eE") == std::string::npos) {
        Json number = Json::parse(text, nullptr, false);
        if (number.is_number()) return number;
    }
    return text;
}

Json gpu_json(const cachesim::Gpu& gpu) {
    Json out{{"name", gpu.name}, {"description", gpu.description}, {"changes", Json::array()}};
    for (const auto& [key, value] : gpu.changes) out["changes"].push_back({{"key", key}, {"value", value_json(value)}});
    out.update({{"sms", gpu.sms}, {"warps_per_sm", gpu.warps_per_sm}});
    for (std::size_t i = 0; i < gpu.levels.size(); ++i) out[fmt::format("l{}_bytes", i + 1)] = gpu.levels[i].bytes();
    out.update({{"line_bytes", gpu.l1().line_bytes}, {"sector_bytes", gpu.l1().sector_bytes}});
    return out;
}

Json trace_json(const traces::Header& header, const std::string& file) {
    const traces::Provenance& p = header.provenance;
    Json out{{"file", file.empty() ? Json(nullptr) : Json(file)},
             {"program", p.program},
             {"command_line", p.command},
             {"scene", p.scene},
             {"scene_hash", fmt::format("{:016x}", p.scene_hash)},
             {"camera", p.camera},
             {"strategy", p.decorrelation},
             {"sequence", p.sequence},
             {"spp", p.spp},
             {"parameters", p.parameters}};
    // "K=2.5 s=2 mu=0.3125": each number also under a key of its own.
    std::istringstream words(p.parameters);
    for (std::string part; words >> part;) {
        const std::size_t sign = part.find('=');
        if (sign == std::string::npos || sign == 0) continue;
        const Json value = value_json(part.substr(sign + 1));
        if (const std::string key = snake_case(part.substr(0, sign)); value.is_number() && !out.contains(key))
            out[key] = value;
    }
    out.update({{"seed", p.seed},
                {"resolution", fmt::format("{}x{}", p.width, p.height)},
                {"bounces", p.bounces},
                {"thread_map", p.thread_map},
                {"layout", p.layout},
                {"execution", p.execution},
                {"order", p.order},
                {"kernels_per_launch", header.kernels_per_launch},
                {"warps_per_launch", header.warps_per_launch},
                {"samples", header.launches}});
    return out;
}

std::string json_text(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n'; }

}  // namespace raycache::tools
