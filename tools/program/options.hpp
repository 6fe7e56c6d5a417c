// Options that several subcommands share, declared once: names, help texts, checks, and the settings they make.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/jobs/outputs.hpp"
#include "tools/program/command.hpp"
#include "tools/program/progress.hpp"
#include "tracer/capture.hpp"
#include "tracer/prepared_scene.hpp"

namespace raycache::tools {

/// Which scene, seen how.
struct SceneOptions {
    std::string source, camera, eye, look_at, sky = "auto";
    std::uint64_t detail = 0;
    float fov = 0;
    bool spatial_splits = false;

    void add_name(Command&);  ///< SCENE, or --scene: required
    void add_view(Command&);  ///< everything else
    /// Loads the scene and builds everything on it; warnings go to stderr. Throws UsageError if one of `outputs`, which
    /// the caller is going to write, is a file that the scene is read from.
    std::unique_ptr<tracer::PreparedScene> prepare(const FileNames& outputs, Progress&) const;
    /// The options as they would be typed, for a trace's provenance.
    std::string command() const;
};

/// Paths and samples of one strategy, except its name and N.
struct SamplingOptions {
    std::string resolution = "512x512", mu, k = "2.5", s = "2";
    std::string thread_map;  ///< empty: the strategy's own
    std::uint32_t bounces = 3;
    std::optional<std::uint32_t> bounces_diffuse, bounces_transmission;
    std::string lights = "auto";
    bool russian_roulette = false;
    unsigned interleave = 8;
    std::uint64_t seed = 1, trace_samples = 8;
    double cycles_multiplier = 1;
    std::uint64_t cycles_min_samples = 0;
    std::string cycles_noise_threshold = "0.01";
    std::string execution = "megakernel", order = "none";

    void add_picture(Command&);    ///< --resolution, and what paths() is made of
    void add_strategy(Command&);   ///< --k --s --mu --cycles-… --interleave --seed
    void add_launches(Command&);   ///< --trace-samples --thread-map
    void add_execution(Command&);  ///< --execution --order

    /// Throws UsageError for values out of range.
    tracer::PathSettings paths() const;
    tracer::StrategySettings strategy(const std::string& sequence, const std::string& decorrelation,
                                      std::uint64_t spp) const;
    /// `strategy` is a decorrelation, or DECORRELATION+ORDER or DECORRELATION+wavefront: executed so whatever
    /// --execution and --order say.
    tracer::CaptureSettings capture(const SceneOptions&, const std::string& sequence, const std::string& strategy,
                                    std::uint64_t spp) const;

private:
    std::string path_command() const;
    std::string parameter_command(const tracer::CaptureSettings&) const;
};

/// --threads, and the limit it sets for the life of the object this returns.
struct ThreadOptions {
    std::uint32_t threads = 0;  ///< 0: as many as there are cores

    void add(Command&);
    std::shared_ptr<void> apply() const;
};

/// A decorrelation of this name; with `execution` also NAME+wavefront and NAME+ORDER. For Option::check(); throws
/// UsageError, with the closest name.
void check_strategy_name(const std::string&, bool execution);
std::vector<std::string> strategy_names();
std::vector<std::string> sequence_names();

/// --strategy, --sequence and --spp where there may be several. `execution`: see check_strategy_name().
Option* add_strategies(Command&, std::vector<std::string>&, bool execution);
Option* add_sequences(Command&, std::vector<std::string>&);
Option* add_spps(Command&, std::vector<std::uint64_t>&, const std::string& help);
/// --spp where there is one.
Option* add_spp(Command&, std::uint64_t&, const std::string& help);

/// What the strategy has to say about its settings, such as "mu 1.58 clamped to 1 …" (SamplingStrategy::warnings()).
std::vector<std::string> settings_warnings(const tracer::CaptureSettings&);

struct Resolution {
    std::uint32_t width, height;
};
/// "512x512". Throws UsageError.
Resolution parse_resolution(const std::string&);

}  // namespace raycache::tools
