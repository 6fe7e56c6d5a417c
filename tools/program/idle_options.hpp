// Options that were given and that nothing reads under the other settings. One table says which option is read when;
// for the parameters of sampling the registry of decorrelations says it (DecorrelationEntry::reads_parameter()).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tools/program/command.hpp"
#include "tracer/capture.hpp"

namespace raycache::tools {

/// What a command does with its cases.
struct CaseUse {
    bool launches = true;  ///< traces sample indices in warps: reads the BVH, the thread map and which indices
    std::string without_launches = "no warp is traced here";  ///< why not, where it does not
};

/// A line for each option given that no case reads, such as "--mu has no effect: cranley-patterson does not read it (of
/// the strategies micro-jitter, scrambling-distance do)".
std::vector<std::string> idle_options(const Command& command, std::span<const tracer::CaptureSettings> cases,
                                      const CaseUse& use = {});

/// The same where only the options of `read` (and positional arguments) have an effect, since `reason`.
std::vector<std::string> idle_besides(const Command& command, const std::vector<std::string>& read,
                                      const std::string& reason);

/// The same of --wide where no table is printed.
std::vector<std::string> idle_of_format(const Command& command);

/// The same where a command reads trace files, which hold scene and sampling: every option about these.
std::vector<std::string> idle_on_traces(const Command& command);

/// Warns of idle_options().
void warn_of_idle(const Command& command, std::span<const tracer::CaptureSettings> cases, const CaseUse& use = {});

}  // namespace raycache::tools
