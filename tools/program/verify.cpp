// raycache verify: check every record of a trace; save what is whole of a damaged one.
#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "cachesim/report/table.hpp"
#include "tools/jobs/costs.hpp"
#include "tools/jobs/outputs.hpp"
#include "tools/program/commands.hpp"
#include "tools/program/console.hpp"
#include "tools/program/json_output.hpp"
#include "tools/program/program.hpp"
#include "tools/program/progress.hpp"
#include "traces/printable.hpp"
#include "traces/verify.hpp"

namespace raycache::tools {
namespace {

struct VerifyArguments {
    std::string path, recovered;
    JsonOption json;
};

void run(const VerifyArguments& o) {
    refuse_overwriting({o.path}, {o.recovered});
    refuse_stdout("--recover", o.recovered);
    check_outputs({o.recovered}, warn);
    std::error_code unknown;
    const std::uintmax_t bytes = std::filesystem::file_size(o.path, unknown);
    Progress progress("verify");
    if (!unknown) progress.expect("read", Work::prepare, read_cost(bytes));
    const Stage stage(progress, "read");
    nlohmann::ordered_json out;
    std::string text;
    if (o.recovered.empty()) {
        const traces::VerifyResult r = traces::verify(o.path);
        out = {{"blocks", r.blocks},
               {"warps", r.warps},
               {"records", r.records},
               {"lane_accesses", r.lane_accesses},
               {"rays", r.rays}};
        text = fmt::format("{}: whole: {} blocks, {} warps, {} records, {} lane accesses, {} rays\n",
                           printable_line(o.path), r.blocks, r.warps, r.records, r.lane_accesses, r.rays);
    } else {
        const traces::RecoverResult r = traces::recover(o.path, o.recovered);
        out = {{"launches_kept", r.launches_kept},
               {"launches_lost", r.launches_lost},
               {"blocks_kept", r.blocks_kept},
               {"blocks_lost", r.blocks_lost}};
        text = fmt::format("{}: kept {} of {} launches ({} blocks)\n", printable_line(o.recovered), r.launches_kept,
                           r.launches_kept + r.launches_lost, r.blocks_kept);
    }
    print(o.json ? o.json.document(json_text(out)) : cachesim::break_lines(text, cachesim::text_width, 2));
}

}  // namespace

void add_verify(Program& program) {
    auto o = std::make_shared<VerifyArguments>();
    Command* command = program.add_subcommand("verify", "Check every checksum and record of a trace");
    command->add_option("TRACE", o->path, "trace file")->required();
    command->add_option("--recover", o->recovered, "write the launches that are whole to this new trace")
        ->type_name("FILE.rct");
    o->json.add(*command);
    command->examples({"raycache verify mj.rct", "raycache verify damaged.rct --recover rest.rct"});
    command->callback([o] { run(*o); });
}

}  // namespace raycache::tools
