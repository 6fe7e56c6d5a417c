// raycache replay: one trace through one or more GPUs.
#include "tools/jobs/replay_job.hpp"
#include "tools/program/commands.hpp"
#include "tools/program/console.hpp"
#include "tools/program/options.hpp"
#include "tools/program/program.hpp"
#include "tools/program/report_options.hpp"

namespace raycache::tools {
namespace {

struct ReplayArguments {
    std::string path;
    ReportOptions report;
    ThreadOptions threads;
};

Action plan(const std::shared_ptr<const ReplayArguments>& o) {
    ReplayJob job = o->report.job();
    job.launches.traces = {o->path};
    const auto gpus = o->report.load_gpus({o->path});
    return [o, job, gpus] {
        const FileNames outputs = o->report.outputs();
        check_outputs(outputs, warn);
        const auto limit = o->threads.apply();
        Progress progress("replay");
        o->report.run_and_publish(job, gpus, progress);
    };
}

}  // namespace

void add_replay(Program& program) {
    auto o = std::make_shared<ReplayArguments>();
    Command* command = program.add_subcommand("replay", "Replay a trace through a GPU's caches");
    command->add_option("TRACE", o->path, "trace file")->required();
    o->threads.add(*command);
    o->report.add(*command, false);
    command->examples({"raycache replay mj.rct --gpu gtx-980-ti",
                       "raycache replay mj.rct --gpu gtx-980-ti --gpu h100 --by bounce --json",
                       "raycache replay mj.rct --gpu rtx-3070 --set l1.ways=128 --timed",
                       "raycache replay mj.rct --gpu rtx-3070 --counters ncu --timed",
                       "raycache replay mj.rct --gpu rtx-3070 --counters ncu --by bounce --csv"});
    command->plan([o] { return plan(o); });
}

}  // namespace raycache::tools
