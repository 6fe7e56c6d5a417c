// --fidelity, --cold-launches: at which level of accuracy the steady state is answered, and what stands beside it.
#pragma once

#include <cstdint>
#include <string>

#include "tools/jobs/replay_job.hpp"
#include "tools/program/command.hpp"

namespace raycache::tools {

struct SteadyOptions {
    std::string fidelity;  ///< empty: not asked for
    std::uint64_t cold_launches = 0;

    void add(Command&);

    /// Whether times are predicted although --timed may not be given. Throws UsageError for --timed beside a level
    /// without time.
    bool in_time(bool timed) const;
    /// Throws UsageError where something is asked for that needs a steady state, of traces or wavefronts.
    void apply(ReplayJob&) const;
};

}  // namespace raycache::tools
