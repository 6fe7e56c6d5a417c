// raycache_tradeoff: error against CPU seconds of every way to answer a question (tools/tradeoff).
#include <fmt/format.h>

#include <exception>
#include <functional>
#include <map>
#include <string>

#include <nlohmann/json.hpp>
#include "tools/bench/tradeoff/ladder.hpp"
#include "tools/jobs/numbers.hpp"
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

class Talking : public tools::Observer {
public:
    void begin(const std::string& stage, std::uint64_t, const std::string&) override {
        fmt::print(stderr, "==> {}\n", stage);
    }
    void warn(const std::string& line) override { fmt::print(stderr, "{}\n", line); }
};

bench::LadderSettings read(int argc, char** argv) {
    bench::LadderSettings s;
    tools::SamplingSettings& sampling = s.launches.sampling;
    sampling.resolution = "128x96";
    s.gpu.names = {"rtx-3070"};
    std::vector<std::string> strategies;
    std::uint64_t spp = 64;
    std::map<std::string, std::function<void(const std::string&)>> options{
        {"scene", [&](const std::string& v) { s.launches.scene.source = v; }},
        {"strategy", [&](const std::string& v) { strategies.push_back(v); }},
        {"mu", [&](const std::string& v) { sampling.mu = v; }},
        {"resolution", [&](const std::string& v) { sampling.resolution = v; }},
        {"gpu", [&](const std::string& v) { s.gpu.names = {v}; }},
        {"set", [&](const std::string& v) { s.gpu.changes.push_back(v); }},
        {"l2-kib",
         [&](const std::string& v) {
             s.gpu.l2_kib = {tools::read_whole(v, "l2-kib", {1, 1U << 20})};
         }},
        {"spp", [&](const std::string& v) {
             spp = tools::read_whole(v, "spp", {1, 1U << 20});
         }}};
    const auto count = [&](const std::string& name, std::uint32_t& of) {
        options[name] = [&of, name](const std::string& v) {
            of = static_cast<std::uint32_t>(tools::read_whole(v, name, {1, 1U << 20}));
        };
    };
    count("drawings", s.drawings);
    count("most-blocks", s.most_blocks);
    count("indices", s.sizes.indices);
    count("work-groups", s.sizes.work_groups);
    count("sm-windows", s.sizes.sm_windows);
    count("windows", s.sizes.windows);
    count("timed-windows", s.sizes.timed_windows);
    count("fill-waves", s.sizes.fill_waves);
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        const std::size_t at = std::min(argument.find('='), argument.size());
        const auto option = options.find(argument.substr(0, at));
        if (option == options.end() || at == argument.size())
            throw UsageError(fmt::format("'{}'; expected NAME=VALUE\n{}", argument, usage));
        option->second(argument.substr(at + 1));
    }
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
    try {
        const bench::LadderSettings settings = read(argc, argv);
        Talking observer;
        fmt::print("{}\n", to_json(bench::climb(settings, observer)).dump(2));
    } catch (const UsageError& e) {
        fmt::print(stderr, "raycache_tradeoff: error: {}\n", e.what());
        return 2;
    } catch (const std::exception& e) {
        fmt::print(stderr, "raycache_tradeoff: error: {}\n", e.what());
        return 1;
    }
    return 0;
}
