// Jobs that take a moment, and what listens to them.
#pragma once

#include <string>
#include <vector>

#include "tools/jobs/job_text.hpp"

namespace raycache::test {

/// The built-in scene at its coarsest, 32 x 24 pixels, 2 of 4 sample indices.
tools::LaunchSettings small_launches(const std::vector<std::string>& strategies);

/// Remembers what a job says.
class Listener : public tools::Observer {
public:
    std::vector<std::string> begun, warnings;
    int running = 0;
    bool ended_well = true;  ///< never two stages at once

    void begin(const std::string& stage, std::uint64_t, const std::string&) override {
        begun.push_back(stage);
        ended_well = ended_well && ++running == 1;
    }
    void end() override { --running; }
    void warn(const std::string& line) override { warnings.push_back(line); }
};

/// What reading that text as a job is answered with; empty if it reads well.
std::string refusal_of_job(const std::string& text);

}  // namespace raycache::test
