// raycache replay: one trace through one or more GPUs.
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include "tools/report_options.hpp"

namespace raycache::tools {
namespace {

struct Options {
    std::string path;
    ReportOptions report;
    ThreadOptions threads;
};

void run(const Options& o) {
    const auto gpus = o.report.load_gpus({o.path});
    const auto limit = o.threads.apply();
    Progress progress("replay");
    const TraceFiles files({o.path});
    o.report.replay_and_publish(files.sources, {o.path}, gpus, progress);
}

}  // namespace

void add_replay(CLI::App& app) {
    auto o = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("replay", "Replay a trace through a GPU's caches");
    command->add_option("TRACE", o->path, "trace file")->required();
    o->report.add(*command, false);
    o->threads.add(*command);
    command->footer(
        "Examples:\n"
        "  raycache replay mj.rct --gpu gtx-980-ti\n"
        "  raycache replay mj.rct --gpu gtx-980-ti --gpu h100 --by bounce --json\n"
        "  raycache replay mj.rct --gpu rtx-3070 --set l1.ways=128 --timed\n"
        "  raycache replay mj.rct --gpu rtx-3070 --counters ncu\n"
        "  raycache replay mj.rct --gpu rtx-3070 --counters ncu --by bounce --csv");
    command->callback([o] { run(*o); });
}

}  // namespace raycache::tools
