#include "tools/bench/workload.hpp"

#include <fmt/format.h>

#include <ctime>

namespace raycache::bench {
namespace {

std::string& chosen() {
    static std::string source = "courtyard";
    return source;
}

}  // namespace

void choose_scene(const std::string& source) { chosen() = source; }
const std::string& scene_name() { return chosen(); }

const tracer::PreparedScene& scene() {
    static const tracer::PreparedScene prepared = [] {
        tracer::SceneRequest request;
        request.source = chosen();
        return tracer::PreparedScene(
            tracer::load_scene(request, [](const std::string& w) { fmt::print(stderr, "warning: {}\n", w); }), {});
    }();
    return prepared;
}

std::unique_ptr<tracer::Capture> make_capture(const std::string& strategy) {
    tracer::CaptureSettings settings;
    settings.trace_samples = 1;
    settings.strategy.decorrelation = strategy;
    settings.strategy.samples.spp = 1024;
    settings.strategy.parameters.set("k", 1);
    settings.strategy.samples.seed = 1;
    return std::make_unique<tracer::Capture>(scene(), settings);
}

double thread_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace raycache::bench
