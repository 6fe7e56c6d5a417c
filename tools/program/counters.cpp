// raycache counters: a profile of Nsight Compute beside the replay of a trace.
#include <fmt/format.h>

#include <algorithm>

#include "cachesim/report/profile_comparison.hpp"
#include "tools/jobs/launch_source.hpp"
#include "tools/jobs/replay_job.hpp"
#include "tools/program/commands.hpp"
#include "tools/program/console.hpp"
#include "tools/program/gpu_options.hpp"
#include "tools/program/json_output.hpp"
#include "tools/program/options.hpp"
#include "tools/program/program.hpp"
#include "traces/error.hpp"
#include "traces/input_pipe.hpp"
#include "traces/reader.hpp"
#include "traces/regular_file.hpp"

namespace raycache::tools {
namespace {

struct CountersArguments {
    std::string trace, against, kernel;
    GpuOptions gpu;
    bool timed = false, csv = false;
    JsonOption json;
    ThreadOptions threads;
};

std::string read_profile_text(const std::string& path) {
    constexpr std::uint64_t most = std::uint64_t{1} << 30;
    if (traces::is_pipe(path)) return traces::read_pipe(path, most);
    const auto bytes = read_regular_file(path, "profile", nullptr, most);
    return {bytes.begin(), bytes.end()};
}

cachesim::NsightProfile read_profile(const CountersArguments& o) {
    cachesim::NsightProfile profile = cachesim::read_nsight_csv(read_profile_text(o.against), o.against);
    if (o.kernel.empty()) return profile;
    const std::string first = profile.launches.front().kernel;
    std::erase_if(profile.launches,
                  [&](const auto& launch) { return launch.kernel.find(o.kernel) == std::string::npos; });
    if (profile.launches.empty())
        throw UsageError(
            fmt::format("--kernel '{}': expected a part of the name of some kernel of {}, found none, such as '{}'",
                        o.kernel, o.against, first));
    return profile;
}

void compare(const CountersArguments& o, const ReplayJob& job, const std::vector<cachesim::Gpu>& gpus) {
    const cachesim::NsightProfile measured = read_profile(o);
    {
        const traces::Reader reader(o.trace);
        if (reader.header().kernels_per_launch > 1)
            throw UsageError(
                fmt::format("{}: trace of a wavefront ({} kernels a launch); expected one of a megakernel: a "
                            "profile has a launch for each kernel, and these are counted together ('replay "
                            "--counters ncu' prints the counts)",
                            o.trace, reader.header().kernels_per_launch));
    }
    const auto limit = o.threads.apply();
    Progress progress("counters");
    const ProfileResult modelled = profile(job, gpus, progress);
    const auto comparison = cachesim::compare_with_profile(modelled.series.front(), measured, o.trace);
    print(o.json  ? o.json.document(to_json(comparison), modelled.subject)
          : o.csv ? to_csv(comparison)
                  : to_text(comparison));
}

Action plan(const std::shared_ptr<const CountersArguments>& o) {
    if (o->json && o->csv) throw UsageError("--json and --csv together; expected one of them");
    ReplayJob job;
    job.launches.traces = {o->trace};
    job.timed = o->timed;
    const std::vector<cachesim::Gpu> gpus{o->gpu.load_one({}, "counters")};
    if (o->timed) o->gpu.check_timed(gpus);
    o->gpu.check_profiled(gpus, o->timed);
    return [o, job, gpus] { compare(*o, job, gpus); };
}

}  // namespace

void add_counters(Program& program) {
    auto o = std::make_shared<CountersArguments>();
    Command* command =
        program.add_subcommand("counters", "Hold a profile of Nsight Compute beside the replay of a trace");
    command->add_option("TRACE", o->trace, "trace file")->required();
    command
        ->add_option("--against", o->against,
                     "what 'ncu --csv' printed: a metric a line, or (--page raw) a launch a line")
        ->type_name("FILE")
        ->required();
    command->add_option("--kernel", o->kernel, "of the profile only launches of kernels whose name has this in it")
        ->type_name("TEXT");
    o->threads.add(*command);
    o->gpu.add_names(*command, "GPU preset or FILE.toml (see 'raycache list gpus')")->count(1)->required();
    o->gpu.add_changes(*command);
    command->group("Report");
    command->add_flag("--timed", o->timed, "predict cycles, too, for rates and shares of peaks");
    o->json.add(*command);
    command->add_flag("--csv", o->csv, "print CSV")->excludes({"--json"});
    command->group("");
    command->examples({"raycache counters mj.rct --gpu rtx-3070 --against profile.csv",
                       "raycache counters mj.rct --gpu rtx-3070 --against profile.csv --kernel trace --timed",
                       "raycache counters mj.rct --gpu rtx-3070 --set l1.ways=128 --against profile.csv --json"});
    command->plan([o] { return plan(o); });
}

}  // namespace raycache::tools
