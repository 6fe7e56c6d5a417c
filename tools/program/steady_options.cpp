#include "tools/program/steady_options.hpp"

#include <fmt/format.h>

#include "traces/error.hpp"

namespace raycache::tools {
namespace {

void check_steady(const LaunchSettings& launches, const std::string& option, bool windows) {
    if (launches.of_traces())
        throw UsageError(fmt::format(
            "{} beside traces; expected a scene: every launch of a trace is replayed from cold caches, and has no "
            "steady state",
            option));
    if (!windows)
        throw UsageError(fmt::format(
            "{} of a wavefront; expected --execution megakernel: a wavefront is replayed in whole launches from cold "
            "caches, and has no steady state",
            option));
}

}  // namespace

void SteadyOptions::add(Command& command) {
    command.group("Certainty", true);
    command
        .add_option("--fidelity", fidelity,
                    "functional: bytes, without time; timed: as --timed; exact: all of the picture in time, sample "
                    "after sample, for small ones; auto: whatever a pilot finds to predict every speed-up to "
                    "--target-error in the fewest seconds")
        ->choices("level", {"functional", "timed", "exact", "auto"})
        ->type_name("LEVEL")
        ->default_text("")
        ->excludes({"--exact", "--trace-samples", "--counters", "--by"});
    command
        .add_option("--cold-launches", cold_launches,
                    "beside the steady state so many whole launches of the same sample indices, each from cold caches: "
                    "how much longer they take, and by what; takes as long as --exact --trace-samples")
        ->range(std::uint64_t{1}, std::uint64_t{4096})
        ->type_name("LAUNCHES")
        ->default_text("")
        ->excludes({"--exact", "--trace-samples", "--counters", "--by", "--time-budget"});
    command.group("");
}

bool SteadyOptions::in_time(bool timed) const {
    if (timed && fidelity == "functional")
        throw UsageError("--timed beside --fidelity functional; expected one of them: that level has no time");
    return timed || (!fidelity.empty() && fidelity != "functional");
}

void SteadyOptions::apply(ReplayJob& job) const {
    const bool windows = job.estimate.windows;
    if (!fidelity.empty()) check_steady(job.launches, "--fidelity", windows);
    if (cold_launches > 0) check_steady(job.launches, "--cold-launches", windows);
    job.estimate.cold_launches = cold_launches;
    if (fidelity == "auto") job.estimate.fidelity = Fidelity::automatic;
    if (fidelity == "exact") job.estimate.fidelity = Fidelity::exact;
    if (windows) check_windows(job.launches, job.estimate);
}

}  // namespace raycache::tools
