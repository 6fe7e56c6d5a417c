// Options that several subcommands share, declared once: names, help texts, checks. What they fill in is settings of
// jobs.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tools/jobs/sampling_settings.hpp"
#include "tools/jobs/scene_settings.hpp"
#include "tools/program/command.hpp"
#include "tools/program/progress.hpp"

namespace raycache::tools {

/// Which scene, seen how.
struct SceneOptions : SceneSettings {
    void add_name(Command&);  ///< SCENE, or --scene: required
    void add_view(Command&);  ///< everything else
};

/// Paths and samples of one strategy, except its name and N.
struct SamplingOptions : SamplingSettings {
    void add_picture(Command&);                ///< --resolution, and what paths() is made of
    void add_integrator_parameters(Command&);  ///< of add_picture(): --radius …
    void add_strategy(Command&);               ///< --k --s --mu --cycles-… --interleave --share --seed
    void add_launches(Command&);               ///< --trace-samples --thread-map
    void add_execution(Command&);              ///< --execution --order
};

/// --threads, and the limit it sets for the life of the object this returns.
struct ThreadOptions {
    std::uint32_t threads = 0;  ///< 0: as many as there are cores

    void add(Command&);
    std::shared_ptr<void> apply() const;
};

/// Names of decorrelations.
std::vector<std::string> strategy_names();
std::vector<std::string> sequence_names();

/// For Option::check(): that every part of the name is known, of those that it may have.
std::function<void(std::string&)> strategy_name_check(tracer::StrategyParts = {});
/// --strategy, --sequence and --spp where there may be several.
Option* add_strategies(Command&, std::vector<std::string>&, tracer::StrategyParts);
Option* add_sequences(Command&, std::vector<std::string>&);
/// A list of layouts, instead of the one of SceneOptions::add_view().
Option* add_layouts(Command&, std::vector<std::string>&);
Option* add_spps(Command&, std::vector<std::uint64_t>&, const std::string& help);
/// --spp where there is one.
Option* add_spp(Command&, std::uint64_t&, const std::string& help);

}  // namespace raycache::tools
