// raycache_coverage: how often intervals of estimates from windows hold the exact value (docs/estimates.md).
#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "tests/folders.hpp"
#include "tools/bench/coverage/interval_coverage.hpp"
#include "tools/bench/measurement.hpp"
#include "tools/jobs/numbers.hpp"

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
    s.sampling.k = std::string("1");
    s.gpu.names = {"rtx-3070"};
    bench::NameValues values;
    values.text("scene", s.scene.source);
    values.text("resolution", s.sampling.resolution);
    values.count("spp", s.spp);
    values.text("timed", [&](const std::string& v) { s.timed = tools::read_whole(v, "timed", {0, 1}) != 0; });
    values.count("estimates", s.estimates);
    values.count("blocks", s.blocks);
    values.count("pool", s.pool);
    values.gpu(s.gpu);
    values.sizes(s.sizes);
    values.read(argc, argv, usage);
    return s;
}

}  // namespace

int main(int argc, char** argv) {
    return bench::measure("raycache_coverage", [&] {
        bench::CoverageSettings settings = read(argc, argv);
        const std::string scene = find_scene(settings.scene.source);
        if (scene.empty()) {
            fmt::print(stderr, "skipped: no {}; {}\n", settings.scene.source, test::scenes_remedy());
            return;
        }
        settings.scene.source = scene;
        bench::Talking observer;
        fmt::print("{:<36}{:>10}{:>8}{:>9}{:>9}{:>9}\n", "figure", "exact", "held", "±", "error", "bias");
        for (const bench::FigureCoverage& f : bench::interval_coverage(settings, observer))
            fmt::print("{:<36}{:>10.4g}{:>6.1f} %{:>7.2f} %{:>7.2f} %{:>+7.2f} %\n", f.figure, f.exact, 100 * f.held,
                       100 * f.half_width, 100 * f.error, 100 * f.bias);
    });
}
