// raycache info: what a trace file says about itself.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "cachesim/report/table.hpp"
#include "tools/program/commands.hpp"
#include "tools/program/console.hpp"
#include "tools/program/json_output.hpp"
#include "tools/program/program.hpp"
#include "traces/printable.hpp"
#include "traces/reader.hpp"

namespace raycache::tools {
namespace {

struct InfoArguments {
    std::string path;
    JsonOption json;
};

struct Totals {
    std::uint64_t records = 0, lane_accesses = 0, rays = 0;

    double bytes_per_ray(std::uint64_t file_bytes) const {
        return static_cast<double>(file_bytes) / static_cast<double>(rays);
    }
};

nlohmann::ordered_json as_json(const traces::Reader& reader, const Totals& totals) {
    nlohmann::ordered_json out;
    out["regions"] = nlohmann::ordered_json::array();
    for (const traces::Region& r : reader.header().regions)
        out["regions"].push_back({{"kind", traces::name_of(r.kind)},
                                  {"base", fmt::format("{:#x}", r.base)},
                                  {"element_bytes", r.element_size},
                                  {"stride", r.stride},
                                  {"count", r.count}});
    for (std::size_t i = 0; i < out["regions"].size(); ++i)
        if (const auto& pages = reader.header().regions[i].pages; !pages.empty())
            out["regions"][i]["pages"] = pages.count();
    out["issue"] = reader.header().issue;
    out["rays"] = totals.rays;
    out["records"] = totals.records;
    out["lane_accesses"] = totals.lane_accesses;
    out["blocks"] = reader.blocks().size();
    out["file_bytes"] = reader.file_bytes();
    out["bytes_per_ray"] = totals.rays == 0 ? nlohmann::ordered_json(nullptr)
                                            : nlohmann::ordered_json(totals.bytes_per_ray(reader.file_bytes()));
    return out;
}

std::string as_text(const traces::Reader& reader, const Totals& totals) {
    const traces::Header& h = reader.header();
    const traces::Provenance& p = h.provenance;
    std::string out;
    const auto line = [&](const char* name, const std::string& value) {
        constexpr std::size_t title = 18;
        if (!value.empty())
            out += cachesim::break_lines(fmt::format("{:<{}}{}\n", name, title, printable_line(value)),
                                         cachesim::text_width, title);
    };
    const auto count = [&](const char* name, std::uint64_t value) { line(name, fmt::format("{}", value)); };
    line("program", p.program);
    line("command", p.command);
    line("scene", p.scene);
    line("scene hash", fmt::format("{:016x}", p.scene_hash));
    line("camera", p.camera);
    line("strategy", p.decorrelation);
    line("parameters", p.parameters);
    line("sequence", p.sequence);
    count("N", p.spp);
    count("seed", p.seed);
    line("resolution", fmt::format("{}x{}", p.width, p.height));
    count("bounces", p.bounces);
    line("thread map", p.thread_map);
    line("layout", p.layout);
    if (p.execution != traces::Provenance{}.execution) {
        line("execution", p.execution);
        line("order", p.order);
        count("kernels", h.kernels_per_launch);
    }
    line("waits", h.issue ? "by registers; instructions of the program" : "");
    line("sample indices", fmt::format("{}", fmt::join(h.launches, " ")));
    count("warps per launch", h.warps_per_launch);
    for (const traces::Region& r : h.regions)
        line("region",
             fmt::format("{} x {} of {} B, stride {} B, {}", r.count, traces::name_of(r.kind), r.element_size, r.stride,
                         r.pages.empty()
                             ? fmt::format("at {:#x}", r.base)
                             : fmt::format("in {} pages of {} B", r.pages.count(), traces::PageTable::page_bytes)));
    count("rays", totals.rays);
    count("records", totals.records);
    count("lane accesses", totals.lane_accesses);
    count("blocks", reader.blocks().size());
    count("file bytes", reader.file_bytes());
    line("bytes per ray", totals.rays == 0 ? "-" : fmt::format("{:.2f}", totals.bytes_per_ray(reader.file_bytes())));
    return out;
}

void run(const InfoArguments& o) {
    const traces::Reader reader(o.path);
    Totals totals;
    for (const traces::BlockInfo& block : reader.blocks()) {
        totals.records += block.records;
        totals.lane_accesses += block.lane_accesses;
        totals.rays += block.rays;
    }
    if (!o.json) return print(as_text(reader, totals));
    print(o.json.document(json_text(as_json(reader, totals)), {{}, {trace_json(reader.header(), o.path)}}));
}

}  // namespace

void add_info(Program& program) {
    auto o = std::make_shared<InfoArguments>();
    Command* command = program.add_subcommand("info", "Show a trace's provenance, counts and bytes per ray");
    command->add_option("TRACE", o->path, "trace file")->required();
    o->json.add(*command);
    command->examples({"raycache info mj.rct", "raycache info mj.rct --json"});
    command->callback([o] { run(*o); });
}

}  // namespace raycache::tools
