#include "tools/program/estimate_options.hpp"

#include <fmt/format.h>

#include "tools/jobs/numbers.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

bool is_given(const Command& command, const char* name) {
    const Option* option = command.find_option(name);
    return option && option->given();
}

}  // namespace

double parse_percentage(const std::string& text, const std::string& what) {
    const auto refuse = [&] {
        return UsageError(fmt::format(
            "{} '{}': expected a percentage above 0 and at most 100 with its sign, such as 2%", what, text));
    };
    std::string number = text;
    if (number.empty() || number.back() != '%') throw refuse();
    number.pop_back();
    while (!number.empty() && number.back() == ' ') number.pop_back();
    double percent = 0;
    try {
        percent = read_real(number, what, {});
    } catch (const UsageError&) {
        throw refuse();
    }
    if (!(percent > 0 && percent <= 100)) throw refuse();
    return percent / 100;
}

void EstimateOptions::add(Command& command, const std::string& when_timed) {
    command.group("Certainty", true);
    command
        .add_option(
            "--target-error", target_error,
            fmt::format("stop when the 95 % interval of every ratio to the baseline is that narrow ({})", when_timed))
        ->check([](std::string& word) { parse_percentage(word, "--target-error"); })
        ->type_name("PERCENT")
        ->excludes({"--windows", "--exact", "--trace-samples"});
    command
        .add_option(
            "--time-budget", time_budget,
            "stop after so many seconds, loading the scene included, whatever the interval; results then depend on "
            "the machine's speed")
        ->range(0.0, 1e9)
        ->type_name("SECONDS")
        ->default_text("")
        ->excludes({"--windows", "--exact", "--trace-samples"});
    command
        .add_option("--windows", windows,
                    "so many windows of each strategy, whatever the interval: runs of neighbouring warps at random "
                    "places of random sample indices")
        ->range(std::uint64_t{2}, std::uint64_t{4096})
        ->default_text("")
        ->excludes({"--exact", "--trace-samples"});
    command.add_flag("--exact", exact,
                     "whole launches instead of windows: --trace-samples of them, each from cold caches to its last "
                     "warp, at 512x512 by default");
    command.group("");
}

EstimateSettings EstimateOptions::settings(const Command& command, LaunchSettings& launches,
                                           std::string& why_exact) const {
    EstimateSettings settings;
    if (launches.of_traces()) {
        for (const char* option : {"--target-error", "--time-budget", "--windows"})
            if (is_given(command, option))
                throw UsageError(fmt::format(
                    "{} beside traces; expected a scene: a trace has whole launches and no windows of other sample "
                    "indices",
                    option));
        return settings;
    }
    if (exact || is_given(command, "--trace-samples")) return settings;
    if (is_given(command, "--counters")) return settings;
    if (is_given(command, "--heatmap")) {
        why_exact =
            "a heat map shows whole launches, so whole launches are replayed, each from cold caches; without --heatmap "
            "the steady state is explained";
        return settings;
    }
    if (!has_windows(launches)) {
        why_exact = "a wavefront has no steady state to take windows from: whole launches are replayed";
        return settings;
    }
    settings.windows = true;
    settings.target_error = parse_percentage(target_error, "--target-error");
    settings.time_budget = time_budget;
    settings.window_count = windows;
    if (!is_given(command, "--resolution")) launches.sampling.resolution = window_resolution;
    settings.check();
    return settings;
}

}  // namespace raycache::tools
