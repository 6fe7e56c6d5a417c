// Command lines: one word a line, as the options of a capture and of its GPUs; then the settings they make. Nothing is
// loaded or run.
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <sstream>

#include "tests/fuzz/fuzz.hpp"
#include "tools/gpu_options.hpp"
#include "tools/options.hpp"

using namespace raycache;

namespace {

/// At most so many dimensions and samples are tried, to keep an input short.
constexpr std::uint64_t most_spp = 4096;

void make_settings(const std::vector<std::string>& words) {
    CLI::App app("fuzz");
    tools::SceneOptions scene;
    tools::SamplingOptions sampling;
    tools::GpuOptions gpus;
    tools::ThreadOptions threads;
    std::string sequence = "sobol", strategy = "micro-jitter";
    std::uint64_t spp = 64;
    scene.add(app, true);
    sampling.add_picture(app);
    sampling.add_strategy(app);
    sampling.add_launches(app);
    sampling.add_execution(app);
    gpus.add_changes(app);
    threads.add(app);
    app.add_option("--gpu", gpus.names)->delimiter(',');
    app.add_option("--sequence", sequence);
    app.add_option("--strategy", strategy);
    app.add_option("--spp", spp);
    try {
        app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
    } catch (const CLI::ParseError&) {
        return;
    }
    fuzz::accepts([&] {
        const tracer::CaptureSettings settings = sampling.capture(scene, sequence, strategy, spp);
        fuzz::require(settings.width > 0 && settings.height > 0, "a picture has pixels");
        fuzz::require(settings.command.find('\n') == std::string::npos, "a command is one line");
        if (spp <= most_spp) tools::settings_warnings(settings);
    });
    for (std::string& name : gpus.names)
        if (cachesim::is_gpu_file(name)) name = "h100";  // no file is opened
    fuzz::accepts([&] { gpus.check_timed(gpus.load({})); });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::istringstream lines(std::string(reinterpret_cast<const char*>(data), size));
    std::vector<std::string> words;
    for (std::string line; words.size() < 64 && std::getline(lines, line);) words.push_back(line);
    make_settings(words);
    return 0;
}
