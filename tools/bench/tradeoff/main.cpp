// raycache_tradeoff: error against CPU seconds of every way to answer a question (tools/tradeoff).
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tools/bench/measurement.hpp"
#include "tools/bench/tradeoff/ladder.hpp"
#include "traces/error.hpp"

using namespace raycache;

namespace {

constexpr const char* usage =
    "Usage: raycache_tradeoff scene=SCENE [NAME=VALUE]...\n"
    "  strategy=NAME (any number; the first is the baseline) mu= spp=64 resolution=128x96\n"
    "  gpu=rtx-3070 set=KEY=VALUE (any number) l2-kib=KIB\n"
    "  drawings=3 most-blocks=64\n"
    "  indices= work-groups= sm-windows= windows= timed-windows= fill-waves=    of a block; else as the program's\n"
    "Prints JSON.\n";

bench::LadderSettings read(int argc, char** argv) {
    bench::LadderSettings s;
    tools::SamplingSettings& sampling = s.launches.sampling;
    sampling.resolution = "128x96";
    s.gpu.names = {"rtx-3070"};
    std::vector<std::string> strategies;
    std::uint64_t spp = 64;
    bench::NameValues values;
    values.text("scene", s.launches.scene.source);
    values.text("strategy", [&](const std::string& v) { strategies.push_back(v); });
    values.text("mu", sampling.mu);
    values.text("resolution", sampling.resolution);
    values.count("spp", spp);
    values.count("drawings", s.drawings);
    values.count("most-blocks", s.most_blocks);
    values.gpu(s.gpu);
    values.sizes(s.sizes);
    values.read(argc, argv, usage);
    if (s.launches.scene.source.empty() || strategies.size() < 2)
        throw UsageError(fmt::format("a scene and two strategies at least are expected\n{}", usage));
    for (const std::string& strategy : strategies)
        s.launches.cases.push_back({tracer::parse_strategy_name(strategy), "sobol", spp, {}, {}});
    return s;
}

nlohmann::ordered_json to_json(const bench::Ladder& ladder) {
    nlohmann::ordered_json out{{"gpu", ladder.gpu},
                               {"strategies", ladder.strategies},
                               {"warps_per_launch", ladder.warps},
                               {"warps_per_wave", ladder.wave},
                               {"prepare_seconds", ladder.prepare_seconds},
                               {"trace_seconds", ladder.trace_seconds},
                               {"warp_instructions", ladder.warp_instructions},
                               {"issue_busy", ladder.issue_busy},
                               {"levels", nlohmann::ordered_json::array()}};
    for (const bench::LevelResult& level : ladder.levels) {
        nlohmann::ordered_json row{{"level", level.level},     {"target", level.target},
                                   {"drawing", level.drawing}, {"blocks", level.blocks},
                                   {"seconds", level.seconds}, {"answers", nlohmann::ordered_json::array()}};
        for (const bench::Answer& a : level.answers)
            row["answers"].push_back({{"l1_hit_rate", a.l1_hit_rate},
                                      {"l2_hit_rate", a.l2_hit_rate},
                                      {"l2_bytes_per_ray", a.l2_bytes_per_ray},
                                      {"dram_bytes_per_ray", a.dram_bytes_per_ray},
                                      {"cycles_per_ray", a.cycles_per_ray}});
        out["levels"].push_back(row);
    }
    return out;
}

}  // namespace

int main(int argc, char** argv) {
    return bench::measure("raycache_tradeoff", [&] {
        const bench::LadderSettings settings = read(argc, argv);
        bench::Talking observer;
        fmt::print("{}\n", to_json(bench::climb(settings, observer)).dump(2));
    });
}
