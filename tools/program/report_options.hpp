// Options of a table over GPUs: how it is cut, in which format it is printed, where it is saved.
#pragma once

#include <string>
#include <vector>

#include "tools/jobs/replay_job.hpp"
#include "tools/program/gpu_options.hpp"
#include "tools/program/json_output.hpp"
#include "tools/program/width_option.hpp"

namespace raycache::tools {

struct ReportOptions {
    GpuOptions gpus;
    bool timed = false, across_gpus = false;
    std::string by = "none", baseline, save, counters;
    JsonOption json;
    WidthOption width;
    bool csv = false;

    void add(Command&, bool with_baseline);

    /// Refuses what cannot be printed together, GPUs that cannot be asked so, and inputs that publish() would
    /// overwrite: all before anything takes time. `inputs`: files that are read beside those of the GPUs.
    std::vector<cachesim::Gpu> load_gpus(const FileNames& inputs) const;
    /// The files that publish() writes.
    FileNames outputs() const;

    /// What is asked of the GPUs; the launches are the command's.
    ReplayJob job() const;
    /// Runs that job, makes the report of its result, prints it in the chosen format, and saves all formats where
    /// asked. `remarks` come behind its notes.
    void run_and_publish(const ReplayJob&, const std::vector<cachesim::Gpu>&, Observer&,
                         const std::vector<std::string>& remarks = {}) const;

private:
    void check() const;
    void publish(const ReplayResult&, const std::vector<std::string>& remarks) const;
};

}  // namespace raycache::tools
