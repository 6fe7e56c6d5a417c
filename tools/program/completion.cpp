// raycache completion: prints a script that completes raycache's command lines. Hidden: packages and users' start-up
// files call it; `cmake --install` does.
#include "tools/program/completion.hpp"

#include <fmt/format.h>

#include <map>

#include "cachesim/gpus/gpu.hpp"
#include "cachesim/gpus/gpu_keys.hpp"
#include "tools/jobs/samples_tables.hpp"
#include "tools/program/commands.hpp"
#include "tools/program/console.hpp"
#include "tools/program/program.hpp"
#include "tracer/sampling/decorrelation.hpp"
#include "tracer/sampling/sequence.hpp"
#include "tracer/scene/scene.hpp"
#include "tracer/simt/orders/ray_order.hpp"
#include "tracer/simt/thread_map.hpp"
#include "tracer/strategy_groups.hpp"

namespace raycache::tools {
namespace {

template <class List>
std::vector<std::string> listed_names(const List& list) {
    std::vector<std::string> names;
    for (const auto& item : list) names.push_back(item.name);
    return names;
}

/// Every key of GPU files, as --set takes it.
std::vector<std::string> gpu_keys() {
    std::vector<std::string> keys = cachesim::gpu_key_names();
    for (std::string& key : keys) key += '=';
    return keys;
}

/// What options and positional arguments of these names take, in every command.
const std::map<std::string, Candidates>& known() {
    static const std::map<std::string, Candidates> table = [] {
        const std::vector<std::string> strategies = listed_names(tracer::decorrelations()),
                                       scenes = listed_names(tracer::builtin_scenes());
        const Candidates any_file{{}, {"*"}}, traces{{}, {"rct"}}, scene{scenes, {"glb", "gltf"}},
            trace_or_scene{scenes, {"rct", "glb", "gltf"}}, strategy{strategies, {}};
        std::vector<std::string> with_groups = strategies;
        for (const std::string& group : listed_names(tracer::strategy_groups())) with_groups.push_back(group);
        return std::map<std::string, Candidates>{
            {"--strategy", {with_groups, {}}},
            {"--baseline", strategy},
            {"--swept", strategy},
            {"--reference-strategy", strategy},
            {"--sequence", {listed_names(tracer::sequences()), {}}},
            {"--order", {listed_names(tracer::ray_orders()), {}}},
            {"--gpu", {listed_names(cachesim::gpu_presets()), {"toml"}}},
            {"--set", {gpu_keys(), {}}},
            {"--scene", scene},
            {"SCENE", scene},
            {"TRACE", traces},
            {"TRACES", traces},
            {"INPUTS", trace_or_scene},
            {"FILE", any_file},
            {"--sky", {{"auto", "on", "off"}, {}}},
            {"--lights", {{"auto", "bsdf", "nee", "mis"}, {}}},
            {"--execution", {{"megakernel", "wavefront"}, {}}},
            {"--thread-map", {listed_names(tracer::thread_maps()), {}}},
            {"--by", {{"none", "bounce", "ray", "object"}, {}}},
            {"--format", {{"dinero", "u64", "csv", "accel-sim"}, {}}},
            {"--level", {{"l1", "l2", "l3"}, {}}},
            {"--table", {samples_table_names(), {}}},
            {"TOPIC",
             {{"strategies", "groups", "sequences", "gpus", "layouts", "integrators", "thread-maps", "orders",
               "scenes"},
              {}}},
            {"--output", any_file},
            {"--gpu-package", any_file},
            {"--save", any_file},
            {"--recover", traces},
            {"--reference", {{}, {"exr"}}},
            {"--heatmap", {{}, {"exr"}}},
            {"--picture", {{}, {"png"}}},
            {"--figure2", {{}, {"png"}}},
            {"--csv", {{}, {"csv"}}},
        };
    }();
    return table;
}

struct CompletionArguments {
    std::string shell;
};

void run(const CompletionArguments& o, const Program& program) {
    const std::vector<CommandView> commands = views_of_commands(program);
    if (o.shell == "bash") return print(bash_completion(commands));
    if (o.shell == "zsh") return print(zsh_completion(commands));
    std::string text;  // for man pages: what there is to describe
    for (const CommandView& command : commands) text += fmt::format("{} {}\n", command.name, command.description);
    print(text);
}

}  // namespace

Candidates candidates_of(const OptionView& option) {
    if (!option.choices.empty()) return {option.choices, {}};
    const auto at = known().find(option.names.empty() ? option.title : "--" + option.title);
    return at == known().end() ? Candidates{} : at->second;
}

void add_completion(Program& program) {
    auto o = std::make_shared<CompletionArguments>();
    Command* command = program.add_subcommand("completion", "Print a script that completes raycache's command lines");
    command->hide();
    command->add_option("SHELL", o->shell, "bash or zsh; or commands: every subcommand and what it does")
        ->required()
        ->choices("shell", {"bash", "zsh", "commands"});
    command->examples({"source <(raycache completion bash)",
                       "raycache completion zsh > ~/.zfunc/_raycache      # a folder of $fpath"});
    command->callback([o, &program] { run(*o, program); });
}

}  // namespace raycache::tools
