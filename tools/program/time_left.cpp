#include "tools/program/time_left.hpp"

#include <algorithm>
#include <array>

namespace raycache::tools {
namespace {

/// Until so much of what is expected is done, what was believed before makes up for the rest.
constexpr double enough_to_tell = 0.02;

struct Pace {
    double expected = 0, work_done = 0, seconds = 0;

    void add(const StageState& stage) {
        expected += stage.expected;
        if (stage.done == 0) return;  // nothing to see yet
        work_done += stage.expected * stage.done;
        seconds += stage.seconds;
    }
    /// Seconds for each second expected.
    double ratio(double believed) const {
        const double belief = std::max(0.0, enough_to_tell * expected - work_done);
        return expected > 0 ? (seconds + belief * believed) / (work_done + belief) : believed;
    }
};

double left_of(const StageState& stage, double pace) {
    const double left = stage.expected * (1 - stage.done) * pace;
    // One that does not say how far it is takes half as long again where it has taken longer than expected.
    return stage.running && stage.done == 0 ? std::max(left - stage.seconds, stage.seconds / 2) : left;
}

}  // namespace

double time_left(std::span<const StageState> stages) {
    std::array<Pace, 5> paces;
    Pace all;
    for (const StageState& stage : stages) {
        if (stage.work == Work::prepare) continue;
        paces[static_cast<std::size_t>(stage.work)].add(stage);
        all.add(stage);
    }
    const double usual = all.ratio(1);
    double left = 0;
    for (const StageState& stage : stages)
        left +=
            left_of(stage, stage.work == Work::prepare ? 1 : paces[static_cast<std::size_t>(stage.work)].ratio(usual));
    return std::max(0.0, left);
}

}  // namespace raycache::tools
