// raycache import: traces and addresses of other programs as a trace.
#include <fmt/format.h>

#include <map>

#include "tools/jobs/outputs.hpp"
#include "tools/jobs/version.hpp"
#include "tools/program/commands.hpp"
#include "tools/program/console.hpp"
#include "tools/program/program.hpp"
#include "tools/program/progress.hpp"
#include "traces/accelsim/import.hpp"
#include "traces/accelsim/kernel_list.hpp"
#include "traces/addresses/address_stream.hpp"
#include "traces/addresses/guess.hpp"
#include "traces/error.hpp"
#include "traces/rtwarp/import.hpp"

namespace raycache::tools {
namespace {

using traces::Fuse;
using traces::NullLanes;
using traces::TraceKind;

struct ImportArguments {
    std::string input, output, format = "auto", null_lanes = "drop-loads";
    bool fuse = false, no_fuse = false, stores = false, traversal = false;
    std::optional<std::uint32_t> access_bytes;
};

const std::map<std::string, TraceKind> kinds{{"accel-sim", TraceKind::accel_sim},
                                             {"rtwarp", TraceKind::rtwarp},
                                             {"din", TraceKind::dinero},
                                             {"csv", TraceKind::csv},
                                             {"u64", TraceKind::u64}};
const std::map<std::string, NullLanes> null_lanes{
    {"drop-loads", NullLanes::drop_loads}, {"drop-lanes", NullLanes::drop_lanes}, {"keep", NullLanes::keep}};

template <class Value>
std::vector<std::string> names_of(const std::map<std::string, Value>& values) {
    std::vector<std::string> names;
    for (const auto& [name, value] : values) names.push_back(name);
    return names;
}

/// Every option that shapes the records.
std::string command_of(const ImportArguments& o) {
    std::string text = "raycache import " + o.input;
    if (o.format != "auto") text += " --format " + o.format;
    if (o.fuse) text += " --fuse";
    if (o.no_fuse) text += " --no-fuse";
    if (o.stores) text += " --stores";
    if (o.traversal) text += " --traversal";
    if (o.null_lanes != "drop-loads") text += " --null-lanes " + o.null_lanes;
    if (o.access_bytes) text += fmt::format(" --access-bytes {}", *o.access_bytes);
    return text;
}

/// Of all kernels together.
void warn_of(const ImportArguments& o, const std::vector<traces::ImportedKernel>& kernels) {
    std::map<std::string, std::uint64_t> left_out;
    std::uint64_t loads = 0, bypassing = 0, lanes = 0, null_loads = 0, ctas = 0, empty = 0, without = 0;
    for (const auto& [file, kernel] : kernels) {
        for (const auto& [opcode, count] : kernel.left_out) left_out[opcode] += count;
        loads += kernel.loads;
        bypassing += kernel.bypassing;
        lanes += kernel.null_lanes;
        null_loads += kernel.null_loads;
        ctas += kernel.ctas;
        empty += kernel.empty_ctas;
        without += kernel.loads + kernel.stores == 0;
    }
    std::string list;
    for (const auto& [opcode, count] : left_out)
        list += fmt::format("{}{} {}", list.empty() ? "" : ", ", count, opcode);
    if (!list.empty())
        warn(fmt::format(
            "{}: memory instructions that are no loads{} of global memory (LDG, LDGSTS, LD{}) are left out: {}",
            o.input, o.stores ? " or stores" : "", o.stores ? ", STG, ST" : "", list));
    if (lanes > 0)
        warn(fmt::format("{}: {} lanes of {} loads read address 0, which tracers write where they lost an address: {}",
                         o.input, lanes, null_loads,
                         o.null_lanes == "keep"         ? "they are kept"
                         : o.null_lanes == "drop-lanes" ? "they are left out"
                                                        : "loads of no other address are left out, the others kept as "
                                                          "they are (--null-lanes drop-lanes or keep)"));
    if (empty > 0)
        warn(fmt::format("{}: {} of {} thread blocks have no instructions in the trace; their warps read nothing",
                         o.input, empty, ctas));
    if (without > 0)
        warn(fmt::format("{}: {} of {} kernels load nothing; their launches are empty", o.input, without,
                         kernels.size()));
    if (bypassing > 0)
        warn(fmt::format("{}: {} of {} loads are .STRONG or .BYPASS: a GPU does not look them up in L1, a replay does",
                         o.input, bypassing, loads));
}

void import_addresses(const ImportArguments& o, traces::AddressFormat format) {
    const traces::ImportedAddresses found =
        traces::import_addresses(o.input, o.output, {format, o.access_bytes.value_or(1), program_name, command_of(o)});
    if (found.stream.writes + found.stream.fetches > 0)
        warn(fmt::format("{}: {} writes and {} instruction fetches are left out", o.input, found.stream.writes,
                         found.stream.fetches));
    if (found.warps > 1)
        warn(
            fmt::format("{}: {} reads are {} warps of {}, since one can have no more; replay them one after the other: "
                        "--set sms=1 --set warps_per_cta=1 --warps-per-sm 1",
                        o.input, found.stream.reads, found.warps, traces::most_warp_addresses));
}

void run(const ImportArguments& o) {
    if (o.fuse && o.no_fuse) throw UsageError("--fuse with --no-fuse; expected one of them");
    refuse_overwriting({o.input}, {o.output});
    if (traces::looks_like_kernel_list(o.input)) refuse_overwriting(traces::read_kernel_list(o.input), {o.output});
    check_outputs({o.output}, warn);
    Progress progress("import");
    const Stage stage(progress, "read");
    const TraceKind kind = o.format == "auto" ? traces::guess_trace_kind(o.input) : kinds.at(o.format);
    const bool addresses = kind != TraceKind::accel_sim && kind != TraceKind::rtwarp;
    if (kind != TraceKind::accel_sim &&
        (o.fuse || o.no_fuse || o.stores || o.traversal || o.null_lanes != "drop-loads"))
        throw UsageError(fmt::format(
            "--fuse, --no-fuse, --stores, --traversal or --null-lanes: expected an Accel-Sim trace, found {}",
            addresses ? "addresses" : "an RTWARP01 trace, whose objects are whole"));
    if (!addresses && o.access_bytes) throw UsageError("--access-bytes: expected addresses (din, csv, u64)");
    switch (kind) {
        case TraceKind::rtwarp:
            traces::import_rtwarp(o.input, o.output, program_name, command_of(o));
            return;
        case TraceKind::dinero:
            return import_addresses(o, traces::AddressFormat::dinero);
        case TraceKind::csv:
            return import_addresses(o, traces::AddressFormat::csv);
        case TraceKind::u64:
            return import_addresses(o, traces::AddressFormat::u64);
        case TraceKind::accel_sim:
            break;
    }
    traces::ImportSettings settings;
    settings.fuse = o.fuse ? Fuse::always : o.no_fuse ? Fuse::never : Fuse::independent;
    settings.null_lanes = null_lanes.at(o.null_lanes);
    settings.stores = o.stores;
    settings.traversal = o.traversal;
    settings.program = program_name;
    settings.command = command_of(o);
    warn_of(o, traces::import_traceg(o.input, o.output, settings));
}

}  // namespace

void add_import(Program& program) {
    auto o = std::make_shared<ImportArguments>();
    Command* command = program.add_subcommand(
        "import", "Make a trace of an Accel-Sim (NVBit) trace's global loads, of an RTWARP01 trace, or of addresses");
    command
        ->add_option("FILE", o->input,
                     "a kernel's .traceg or .tracez, a kernelslist.g or its folder (a launch a kernel); an RTWARP01 "
                     "trace; addresses. Plain, xz, gzip or zstd")
        ->required();
    command->add_option("-o,--output", o->output, "trace to write, or - for stdout")->required()->type_name("FILE.rct");
    std::vector<std::string> formats = names_of(kinds);
    formats.insert(formats.begin(), "auto");
    command
        ->add_option(
            "--format", o->format,
            "what FILE is: accel-sim, rtwarp, din (\"0 HEX\" a line), csv (columns address, size), u64 (8 bytes "
            "each, little-endian); auto: as it looks")
        ->choices("format", formats);
    command->group("Accel-Sim");
    command->add_flag("--fuse", o->fuse, "one access for loads of a warp that read on, lane by lane: a split object");
    command->add_flag("--no-fuse", o->no_fuse,
                      "each load by itself. Neither: one access where the loads are of 16 B and their registers show "
                      "that none waits for another");
    command->add_flag("--stores", o->stores, "stores of global memory, too, which write through L1 to the last level");
    command->add_flag(
        "--traversal", o->traversal,
        "loads as visits of a traversal: each waits for the one before, and the GPU file says what a visit "
        "computes. Without it a load waits for what its registers say, and instructions are those of FILE");
    command
        ->add_option("--null-lanes", o->null_lanes,
                     "lanes that read address 0: leave out loads of nothing else (drop-loads), each such lane "
                     "(drop-lanes), or none (keep)")
        ->choices("treatment", names_of(null_lanes));
    command->group("Addresses");
    command->add_option("--access-bytes", o->access_bytes, "bytes of an access where FILE does not say it; default 1")
        ->range(std::uint64_t{1}, std::uint64_t{4096});
    command->group("");
    command->examples({"raycache import kernel-1.traceg.xz -o kernel.rct",
                       "raycache import traces/kernelslist.g -o app.rct",
                       "raycache import mj-trace/kernel-1.traceg --fuse -o mj.rct",
                       "raycache import kernel-1.traceg --stores -o kernel.rct",
                       "raycache import accesses.din --access-bytes 4 -o accesses.rct"});
    command->callback([o] { run(*o); });
}

}  // namespace raycache::tools
