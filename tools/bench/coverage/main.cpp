// raycache_coverage: how often intervals of estimates from windows hold the exact value (docs/estimates.md).
#include <fmt/format.h>

#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "tests/folders.hpp"
#include "tools/bench/coverage/interval_coverage.hpp"
#include "tools/jobs/numbers.hpp"
#include "traces/error.hpp"

using namespace raycache;

namespace {

constexpr const char* usage =
    "Usage: raycache_coverage [NAME=VALUE]...\n"
    "  scene=courtyard      built in, or a file, looked for among the real scenes\n"
    "  resolution=96x64 spp=64 gpu=rtx-3070 set=KEY=VALUE (any number) l2-kib=KIB timed=0\n"
    "  estimates=200        how many\n"
    "  blocks=8             of each estimate\n"
    "  pool=16              drawings of places of each block, shared by the estimates\n"
    "  indices= work-groups= sm-windows= windows= timed-windows= fill-waves=    of a block; else as the program's\n";

class Talking : public tools::Observer {
public:
    void begin(const std::string& stage, std::uint64_t, const std::string&) override {
        fmt::print(stderr, "==> {}\n", stage);
    }
    void warn(const std::string& line) override { fmt::print(stderr, "{}\n", line); }
};

/// Empty where the file is not there.
std::string find_scene(const std::string& scene) {
    if (!scene.ends_with(".glb") || std::filesystem::exists(scene)) return scene;
    const std::string path = test::scenes_folder() + "/" + scene;
    return std::filesystem::exists(path) ? path : "";
}

bench::CoverageSettings read(int argc, char** argv) {
    bench::CoverageSettings s;
    s.scene.source = "courtyard";
    s.sampling.resolution = "96x64";
    s.sampling.k = "1";
    s.gpu.names = {"rtx-3070"};
    std::map<std::string, std::function<void(const std::string&)>> options{
        {"scene", [&](const std::string& v) { s.scene.source = v; }},
        {"resolution", [&](const std::string& v) { s.sampling.resolution = v; }},
        {"gpu", [&](const std::string& v) { s.gpu.names = {v}; }},
        {"set", [&](const std::string& v) { s.gpu.changes.push_back(v); }},
        {"l2-kib",
         [&](const std::string& v) {
             s.gpu.l2_kib = {tools::read_whole(v, "l2-kib", {1, 1U << 20})};
         }},
        {"spp",
         [&](const std::string& v) {
             s.spp = tools::read_whole(v, "spp", {1, 1U << 20});
         }},
        {"timed", [&](const std::string& v) {
             s.timed = tools::read_whole(v, "timed", {0, 1}) != 0;
         }}};
    const auto count = [&](const std::string& name, std::uint32_t& of) {
        options[name] = [&of, name](const std::string& v) {
            of = static_cast<std::uint32_t>(tools::read_whole(v, name, {1, 1U << 20}));
        };
    };
    count("estimates", s.estimates);
    count("blocks", s.blocks);
    count("pool", s.pool);
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
    return s;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        bench::CoverageSettings settings = read(argc, argv);
        const std::string scene = find_scene(settings.scene.source);
        if (scene.empty()) {
            fmt::print(stderr, "skipped: no {}; {}\n", settings.scene.source, test::scenes_remedy());
            return 0;
        }
        settings.scene.source = scene;
        Talking observer;
        fmt::print("{:<36}{:>10}{:>8}{:>9}{:>9}{:>9}\n", "figure", "exact", "held", "±", "error", "bias");
        for (const bench::FigureCoverage& f : bench::interval_coverage(settings, observer))
            fmt::print("{:<36}{:>10.4g}{:>6.1f} %{:>7.2f} %{:>7.2f} %{:>+7.2f} %\n", f.figure, f.exact, 100 * f.held,
                       100 * f.half_width, 100 * f.error, 100 * f.bias);
    } catch (const UsageError& e) {
        fmt::print(stderr, "raycache_coverage: error: {}\n", e.what());
        return 2;
    } catch (const std::exception& e) {
        fmt::print(stderr, "raycache_coverage: error: {}\n", e.what());
        return 1;
    }
    return 0;
}
