// raycache export: a trace, or what a cache is asked during its replay, for other tools.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cachesim/export/dram_stream.hpp"
#include "cachesim/export/sector_stream.hpp"
#include "cachesim/replay/replay.hpp"
#include "cachesim/replay/timed/timed_replay.hpp"
#include "tools/jobs/export_accel_sim.hpp"
#include "tools/jobs/launch_source.hpp"
#include "tools/jobs/outputs.hpp"
#include "tools/program/commands.hpp"
#include "tools/program/console.hpp"
#include "tools/program/gpu_options.hpp"
#include "tools/program/program.hpp"
#include "tools/program/progress.hpp"
#include "traces/error.hpp"
#include "traces/output_file.hpp"
#include "traces/read_launch.hpp"

namespace raycache::tools {
namespace {

struct ExportArguments {
    std::string trace, format, level = "l1", output;
    GpuOptions gpu;
    std::optional<std::uint32_t> sm, l1, launch;
    std::optional<double> cycle_mhz;
    traces::TracegSettings traceg;
};

template <class Format>
const Format* find_format(const std::vector<Format>& formats, const std::string& name) {
    const auto found = std::find_if(formats.begin(), formats.end(), [&](const Format& f) { return f.name == name; });
    return found == formats.end() ? nullptr : &*found;
}

template <class Format>
void append_names(const std::vector<Format>& formats, std::vector<std::string>& names) {
    for (const Format& format : formats) names.push_back(format.name);
}

std::vector<std::string> dram_format_names() {
    std::vector<std::string> names;
    append_names(cachesim::dram_formats(), names);
    return names;
}

std::vector<std::string> format_names() {
    std::vector<std::string> names;
    append_names(cachesim::sector_formats(), names);
    append_names(cachesim::dram_formats(), names);
    names.emplace_back("accel-sim");
    return names;
}

std::uint32_t choose_launch(const ExportArguments& o, const traces::Header& header) {
    const std::size_t launches = header.launches.size();
    const std::uint32_t launch = o.launch.value_or(0);
    if (launch >= launches)
        throw UsageError(
            fmt::format("--launch {}; expected 0 to {}, the launches of {}", launch, launches - 1, o.trace));
    return launch;
}

/// A file holds one launch. Says so where others were left out and none was asked for.
void warn_of_others(const ExportArguments& o, const traces::Header& header) {
    const std::size_t launches = header.launches.size();
    if (o.launch || launches == 1) return;
    warn(fmt::format("{}: only launch 0 of {} is exported, sample index {}; choose with --launch 0 to {}", o.trace,
                     launches, header.launches.front(), launches - 1));
}

/// Which cache, or UsageError.
cachesim::SectorStream::Choice choose_cache(const ExportArguments& o, const cachesim::Gpu& gpu,
                                            const cachesim::SectorFormat& format) {
    const std::size_t levels = gpu.levels.size();
    std::size_t level = 0;
    while (level < levels && o.level != fmt::format("l{}", level + 1)) ++level;
    if (level == levels)
        throw UsageError(
            fmt::format("--level '{}'; expected one of: l1, l2{} for {}", o.level, levels > 2 ? ", l3" : "", gpu.name));
    if (o.cycle_mhz) throw UsageError(fmt::format("--cycle-mhz with --level {}; expected --level dram", o.level));
    if (level + 1 == levels) {
        if (o.sm || o.l1)
            throw UsageError(fmt::format("--sm or --l1 with --level {}; expected neither: all SMs of {} share it",
                                         o.level, gpu.name));
        return {level, 0, {}};
    }
    if (!o.sm) throw UsageError(fmt::format("--sm is missing; expected 0 to {} for {}", gpu.sms - 1, gpu.name));
    if (*o.sm >= gpu.sms)
        throw UsageError(fmt::format("--sm {}; expected 0 to {} for {}", *o.sm, gpu.sms - 1, gpu.name));
    if (level > 0 && o.l1) throw UsageError(fmt::format("--l1 with --level {}; expected none: an SM has one", o.level));
    if (level > 0) return {level, *o.sm, {}};
    if (o.l1 && *o.l1 >= gpu.l1_per_sm)
        throw UsageError(fmt::format("--l1 {}; expected 0 to {} for {}", *o.l1, gpu.l1_per_sm - 1, gpu.name));
    if (!o.l1 && gpu.l1_per_sm > 1 && !format.names_cache)
        throw UsageError(
            fmt::format("--l1 is missing; expected 0 to {}: an SM of {} has {} L1s, and --format {} cannot tell them "
                        "apart (csv can)",
                        gpu.l1_per_sm - 1, gpu.name, gpu.l1_per_sm, format.name));
    return {level, *o.sm, o.l1};
}

void export_sectors(const ExportArguments& o, const cachesim::Gpu& gpu, const cachesim::SectorFormat& format,
                    const cachesim::SectorStream::Choice& choice) {
    const traces::Reader reader(o.trace);
    const traces::Header& header = reader.header();
    refuse_wavefront(header, o.trace, "export");
    const std::uint32_t launch = choose_launch(o, header);

    check_outputs({o.output}, warn);
    traces::OutputFile file(o.output);
    cachesim::SectorStream stream(choice, format, gpu.l1().sector_bytes,
                                  [&](std::string_view piece) { file.write(piece); });
    cachesim::Replay replay(gpu, header.regions, header.launches[launch]);
    replay.observe(stream);
    Progress progress("export");
    const Stage stage(progress, "replay", header.warps_per_launch, "warps");
    traces::read_launch(reader, launch, [&](traces::WarpTrace&& warp) {
        replay.push(std::make_shared<const traces::WarpTrace>(std::move(warp)));
        stage.add(1, 1);
    });
    replay.finish();
    stream.flush();
    file.commit();
    warn_of_others(o, header);
}

/// What DRAM is asked for, kernel after kernel of a launch.
void export_dram(const ExportArguments& o, const cachesim::Gpu& gpu, const cachesim::DramFormat& format) {
    const traces::Reader reader(o.trace);
    const traces::Header& header = reader.header();
    const std::uint32_t launch = choose_launch(o, header);

    check_outputs({o.output}, warn);
    traces::OutputFile file(o.output);
    cachesim::DramStream stream(format, o.cycle_mhz ? *o.cycle_mhz / gpu.timing->clock_mhz : 1,
                                [&](std::string_view piece) { file.write(piece); });
    cachesim::TimedReplay replay(gpu, header.regions, header.launches[launch]);
    replay.observe(stream);
    Progress progress("export");
    const Stage stage(progress, "replay", header.warps_per_launch, "warps");
    traces::read_launch(reader, launch, [&](traces::WarpTrace&& warp) {
        if (warp.warp != 0 && warp.warp % header.warps_per_kernel() == 0) replay.end_kernel();
        replay.push(std::make_shared<const traces::WarpTrace>(std::move(warp)));
        stage.add(1, 1);
    });
    replay.finish();
    stream.flush();
    file.commit();
    if (stream.sorted() > 0)
        warn(fmt::format(
            "{}: {} sectors that sorts move are left out of {} others: the trace does not say where they are "
            "read and written",
            o.trace, stream.sorted(), stream.reads() + stream.writes()));
    warn_of_others(o, header);
}

Action plan_dram(const std::shared_ptr<const ExportArguments>& o, const cachesim::Gpu& gpu) {
    if (o->sm || o->l1)
        throw UsageError(
            fmt::format("--sm or --l1 with --level dram; expected neither: all SMs of {} share it", gpu.name));
    const cachesim::DramFormat* format = find_format(cachesim::dram_formats(), o->format);
    if (!format)
        throw UsageError(fmt::format("--format {} with --level dram; expected one of: {}", o->format,
                                     fmt::join(dram_format_names(), ", ")));
    if (o->cycle_mhz && !format->has_cycles)
        throw UsageError(
            fmt::format("--cycle-mhz with --format {}; expected a format that has cycles: dramsim3", format->name));
    o->gpu.check_timed({gpu});
    if (const std::string note = cachesim::no_time_note(gpu); !note.empty())
        throw UsageError(
            fmt::format("--level dram with --gpu {}; expected a GPU whose time is predicted: {}", gpu.name, note));
    return [o, gpu, format] { export_dram(*o, gpu, *format); };
}

void export_instructions(const ExportArguments& o) {
    const traces::Reader reader(o.trace);
    refuse_wavefront(reader.header(), o.trace, "export");
    Progress progress("export");
    export_accel_sim(reader, choose_launch(o, reader.header()), o.traceg, o.output, progress);
    warn_of_others(o, reader.header());
}

Action plan(const std::shared_ptr<const ExportArguments>& o, const Command& command) {
    if (o->format != "accel-sim")
        for (const char* name : {"--warps-per-cta", "--binary-version"})
            if (command.find_option(name)->given())
                throw UsageError(fmt::format("{} with --format {}; expected --format accel-sim", name, o->format));
    if (o->format == "accel-sim") {
        if (!o->gpu.names.empty() || o->gpu.is_changed() || o->sm || o->l1 || o->cycle_mhz || o->level != "l1")
            throw UsageError(
                "--format accel-sim with --gpu, --set, --l1-kib, --l2-kib, --warps-per-sm, --level, --cycle-mhz, --sm "
                "or --l1; expected none: it holds a whole launch");
        refuse_overwriting({o->trace}, accel_sim_files(o->output));
        return [o] { export_instructions(*o); };
    }
    if (o->gpu.names.empty())
        throw UsageError("--gpu is missing; expected a preset or FILE.toml (see 'raycache list gpus')");
    refuse_overwriting({o->trace}, {o->output});
    const cachesim::Gpu gpu = o->gpu.load_one({o->output}, "export");
    if (o->level == "dram") return plan_dram(o, gpu);
    const cachesim::SectorFormat* format = find_format(cachesim::sector_formats(), o->format);
    if (!format)
        throw UsageError(
            fmt::format("--format {} with --level {}; expected --level dram: it holds what DRAM is asked for",
                        o->format, o->level));
    const auto choice = choose_cache(*o, gpu, *format);
    return [o, gpu, format, choice] { export_sectors(*o, gpu, *format, choice); };
}

}  // namespace

void add_export(Program& program) {
    auto o = std::make_shared<ExportArguments>();
    Command* command =
        program.add_subcommand("export", "Write a trace, or what a cache is asked during its replay, for other tools");
    command->add_option("TRACE", o->trace, "trace file")->required();
    command
        ->add_option("--format", o->format,
                     "dinero (\"0 HEX\" a line), u64 (8 bytes a sector), csv; of --level dram ramulator, ramulator2, "
                     "dramsim3; or accel-sim (warp instructions)")
        ->choices("format", format_names())
        ->required();
    command
        ->add_option("-o,--output", o->output,
                     "file to write, or - for stdout; accel-sim: FILE.traceg, FILE.traceg.xz, -, or a folder")
        ->type_name("FILE")
        ->required();
    command->add_option("--launch", o->launch,
                        "which launch of the trace, from 0; each begins with empty caches. Default: the first, with a "
                        "warning where there are more");
    o->gpu.add_names(*command, "GPU preset or FILE.toml (see 'raycache list gpus')")->count(1);
    o->gpu.add_changes(*command);
    command->group("GPU");
    command
        ->add_option("--level", o->level,
                     "l1, l2 or l3: of one SM, or the last, which all SMs share; dram: below all, in time")
        ->choices("level", {"l1", "l2", "l3", "dram"});
    command->add_option("--sm", o->sm, "the SM whose cache is meant, from 0");
    command->add_option("--l1", o->l1, "which of its L1s, where an SM has several");
    command
        ->add_option(
            "--cycle-mhz", o->cycle_mhz,
            "dramsim3: the clock whose cycles are written, that of the simulated DRAM. Default: that of the SMs")
        ->range(1.0, 1e6);
    command->group("Accel-Sim");
    command->add_option("--warps-per-cta", o->traceg.warps_per_cta, "consecutive warps that form a CTA")
        ->range(std::uint64_t{1}, std::uint64_t{32});
    command
        ->add_option(
            "--binary-version", o->traceg.binary_version,
            "compute capability: 60 to 62 Pascal, 70 Volta, 75 Turing, 80 to 87 Ampere, 89 Ada, 90 Hopper, 100 "
            "to 120 Blackwell")
        ->range(std::uint64_t{60}, std::uint64_t{120});
    command->group("");
    command->examples(
        {"raycache export mj.rct --gpu h100 --sm 0 --format csv -o sm0.csv",
         "raycache export mj.rct --gpu gtx-980-ti --sm 3 --l1 0 --format dinero -o sm3.din",
         "raycache export mj.rct --gpu h100 --level l2 --format u64 -o l2.u64",
         "raycache export mj.rct --gpu rtx-3070 --level dram --format dramsim3 --cycle-mhz 1750 -o mj.trc",
         "raycache export mj.rct --gpu rtx-3070 --level dram --format ramulator2 -o mj.trace",
         "raycache export mj.rct --launch 1 --gpu h100 --set l1.ways=8 --sm 0 --format dinero -o - | less",
         "raycache export mj.rct --format accel-sim --warps-per-cta 8 -o mj-trace",
         "raycache export mj.rct --format accel-sim -o mj.traceg.xz"});
    command->plan([o, command] { return plan(o, *command); });
}

}  // namespace raycache::tools
