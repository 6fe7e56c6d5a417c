#include "tools/time_left.hpp"

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
        work_done += stage.expected * stage.done;
        seconds += stage.seconds;
    }
    /// Seconds for each second expected.
    double ratio(double believed) const {
        const double belief = std::max(0.0, enough_to_tell * expected - work_done);
        return expected > 0 ? (seconds + belief * believed) / (work_done + belief) : believed;
    }
};

/// Preparing does not say how far it is. Where it has taken longer than expected, it takes half as long again.
double preparing_left(const StageState& stage) {
    if (stage.done >= 1) return 0;
    return stage.running ? std::max(stage.expected - stage.seconds, stage.seconds / 2) : stage.expected;
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
        left += stage.work == Work::prepare
                    ? preparing_left(stage)
                    : stage.expected * (1 - stage.done) * paces[static_cast<std::size_t>(stage.work)].ratio(usual);
    return std::max(0.0, left);
}

}  // namespace raycache::tools
