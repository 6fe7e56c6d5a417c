// raycache info: what a trace file says about itself.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "tools/commands.hpp"
#include "tools/console.hpp"
#include "traces/reader.hpp"

#include <CLI/CLI.hpp>

namespace raycache::tools {
namespace {

struct Options {
    std::string path;
    bool json = false;
};

struct Totals {
    std::uint64_t records = 0, lane_accesses = 0, rays = 0;
};

nlohmann::ordered_json describe(const traces::Reader& reader, const Totals& totals) {
    const traces::Header& h = reader.header();
    const traces::Provenance& p = h.provenance;
    nlohmann::ordered_json out;
    out["program"] = p.program;
    out["command"] = p.command;
    out["scene"] = p.scene;
    out["scene hash"] = fmt::format("{:016x}", p.scene_hash);
    out["camera"] = p.camera;
    out["strategy"] = p.decorrelation;
    out["parameters"] = p.parameters;
    out["sequence"] = p.sequence;
    out["N"] = p.spp;
    out["seed"] = p.seed;
    out["resolution"] = fmt::format("{}x{}", p.width, p.height);
    out["bounces"] = p.bounces;
    out["thread map"] = p.thread_map;
    out["layout"] = p.layout;
    if (p.execution != "megakernel") {
        out["execution"] = p.execution;
        out["order"] = p.order;
        out["kernels"] = h.kernels_per_launch;
    }
    out["sample indices"] = h.launches;
    out["warps per launch"] = h.warps_per_launch;
    out["regions"] = nlohmann::ordered_json::array();
    for (const traces::Region& r : h.regions)
        out["regions"].push_back({{"kind", traces::name_of(r.kind)},
                                  {"base", fmt::format("{:#x}", r.base)},
                                  {"element bytes", r.element_size},
                                  {"stride", r.stride},
                                  {"count", r.count}});
    out["rays"] = totals.rays;
    out["records"] = totals.records;
    out["lane accesses"] = totals.lane_accesses;
    out["blocks"] = reader.blocks().size();
    out["file bytes"] = reader.file_bytes();
    out["bytes per ray"] =
        totals.rays == 0
            ? nlohmann::ordered_json(nullptr)
            : nlohmann::ordered_json(static_cast<double>(reader.file_bytes()) / static_cast<double>(totals.rays));
    return out;
}

std::string as_text(const nlohmann::ordered_json& description) {
    std::string out;
    for (const auto& [key, value] : description.items()) {
        if (key == "regions") {
            for (const auto& r : value)
                out += fmt::format("{:<18}{} x {} of {} B, stride {} B, at {}\n", "region",
                                   r["count"].get<std::uint64_t>(), r["kind"].get<std::string>(),
                                   r["element bytes"].get<std::uint32_t>(), r["stride"].get<std::uint32_t>(),
                                   r["base"].get<std::string>());
        } else if (value.is_string()) {
            if (!value.get<std::string>().empty()) out += fmt::format("{:<18}{}\n", key, value.get<std::string>());
        } else if (value.is_array()) {
            std::string list;
            for (const auto& v : value) list += (list.empty() ? "" : " ") + v.dump();
            out += fmt::format("{:<18}{}\n", key, list);
        } else if (value.is_number_float()) {
            out += fmt::format("{:<18}{:.2f}\n", key, value.get<double>());
        } else {
            out += fmt::format("{:<18}{}\n", key, value.is_null() ? "-" : value.dump());
        }
    }
    return out;
}

void run(const Options& o) {
    const traces::Reader reader(o.path);
    Totals totals;
    for (const traces::BlockInfo& block : reader.blocks()) {
        totals.records += block.records;
        totals.lane_accesses += block.lane_accesses;
        totals.rays += block.rays;
    }
    const auto description = describe(reader, totals);
    print(o.json ? description.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n"
                 : as_text(description));
}

}  // namespace

void add_info(CLI::App& app) {
    auto o = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("info", "Show a trace's provenance, counts and bytes per ray");
    command->add_option("TRACE", o->path, "trace file")->required();
    command->add_flag("--json", o->json, "print JSON");
    command->footer("Examples:\n  raycache info mj.rct\n  raycache info mj.rct --json");
    command->callback([o] { run(*o); });
}

}  // namespace raycache::tools
