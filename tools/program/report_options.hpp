// Options of a table over GPUs: how it is cut, in which format it is printed, where it is saved.
#pragma once

#include <string>
#include <vector>

#include "cachesim/report/report.hpp"
#include "cachesim/report/timed_report.hpp"
#include "tools/jobs/launch_source.hpp"
#include "tools/jobs/outputs.hpp"
#include "tools/program/gpu_options.hpp"
#include "tools/program/json_output.hpp"
#include "tools/program/progress.hpp"
#include "tools/program/width_option.hpp"

namespace raycache::tools {

struct ReportOptions {
    GpuOptions gpus;
    bool timed = false;
    std::string by = "none", baseline, save, counters;
    JsonOption json;
    WidthOption width;
    bool csv = false;

    void add(Command&, bool with_baseline);

    /// Refuses what cannot be printed together, GPUs that cannot be asked so, and inputs that replay_and_publish()
    /// would overwrite: all before anything takes time. `inputs`: files that are read beside those of the GPUs.
    std::vector<cachesim::Gpu> load_gpus(const FileNames& inputs) const;
    /// The files that replay_and_publish() writes.
    FileNames outputs() const;

    /// Replays all sources on all GPUs, makes the report, prints it in the chosen format, and saves all formats where
    /// asked. `files`: the names of the sources, empty for captures.
    void replay_and_publish(const std::vector<LaunchSource>& sources, const FileNames& files,
                            const std::vector<cachesim::Gpu>&, Progress&) const;

private:
    void check() const;
};

}  // namespace raycache::tools
