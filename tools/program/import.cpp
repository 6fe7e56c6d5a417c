// raycache import: a trace of another tool -> trace file.
#include <fmt/format.h>

#include "tools/jobs/outputs.hpp"
#include "tools/jobs/version.hpp"
#include "tools/program/commands.hpp"
#include "tools/program/console.hpp"
#include "tools/program/program.hpp"
#include "tools/program/progress.hpp"
#include "traces/accelsim/import.hpp"
#include "traces/error.hpp"
#include "traces/rtwarp/import.hpp"

namespace raycache::tools {
namespace {

struct ImportArguments {
    std::string input, output;
    bool fuse = false;
};

void run(const ImportArguments& o) {
    refuse_overwriting({o.input}, {o.output});
    check_outputs({o.output}, warn);
    Progress progress("import");
    const Stage stage(progress, "read");
    if (traces::looks_like_rtwarp(o.input)) {
        if (o.fuse)
            throw UsageError("--fuse: expected an Accel-Sim trace, found an RTWARP01 trace, whose objects are whole");
        traces::import_rtwarp(o.input, o.output, program_name, fmt::format("raycache import {}", o.input));
        return;
    }
    traces::ImportSettings settings;
    settings.fuse = o.fuse;
    settings.program = program_name;
    settings.command = fmt::format("raycache import {}{}", o.input, o.fuse ? " --fuse" : "");
    const traces::TracegKernel kernel = traces::import_traceg(o.input, o.output, settings);
    if (!kernel.left_out.empty()) {
        std::string list;
        for (const auto& [opcode, count] : kernel.left_out)
            list += fmt::format("{}{} {}", list.empty() ? "" : ", ", count, opcode);
        warn(fmt::format("{}: memory instructions that are no global loads (LDG) are left out: {}", o.input, list));
    }
    if (kernel.bypassing > 0)
        warn(fmt::format("{}: {} of {} loads are .STRONG: a GPU does not look them up in L1, a replay does", o.input,
                         kernel.bypassing, kernel.loads));
}

}  // namespace

void add_import(Program& program) {
    auto o = std::make_shared<ImportArguments>();
    Command* command = program.add_subcommand(
        "import", "Make a trace of an Accel-Sim (NVBit) trace's global loads, or of an RTWARP01 trace");
    command->add_option("FILE", o->input, "a kernel's .traceg, plain or xz; or an RTWARP01 trace, plain or zstd")
        ->required();
    command->add_option("-o,--output", o->output, "trace to write, or - for stdout")->required()->type_name("FILE.rct");
    command->add_flag("--fuse", o->fuse, "one access for loads of a warp that read on, lane by lane: a split object");
    command->examples({"raycache import kernel-1.traceg.xz -o kernel.rct",
                       "raycache import mj-trace/kernel-1.traceg --fuse -o mj.rct"});
    command->callback([o] { run(*o); });
}

}  // namespace raycache::tools
