// Options of a table over GPUs: how it is cut, in which format it is printed, where it is saved.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "cachesim/report/report.hpp"
#include "cachesim/report/timed_report.hpp"
#include "tools/gpu_options.hpp"
#include "tools/outputs.hpp"

namespace raycache::tools {

struct ReportOptions {
    GpuOptions gpus;
    bool timed = false;
    std::string by = "none", baseline, save, counters;
    bool json = false, csv = false;

    void add(CLI::App&, bool with_baseline);

    /// Refuses what cannot be printed together, GPUs that cannot be asked so, and inputs that publish() would
    /// overwrite: all before anything takes time. `inputs`: files that are read beside those of the GPUs.
    std::vector<cachesim::Gpu> load_gpus(const FileNames& inputs) const;
    /// The files that publish() writes.
    FileNames outputs() const;

    /// Makes the report of `series`, prints it in the chosen format, and saves all formats where asked.
    void publish(const std::vector<cachesim::Series>& series) const;
    void publish(const std::vector<cachesim::TimedSeries>& series) const;

private:
    void check() const;
};

}  // namespace raycache::tools
