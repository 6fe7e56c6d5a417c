#include "tools/jobs/windows/fidelity.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "cachesim/analysis/double_sampling.hpp"
#include "tools/jobs/baseline.hpp"
#include "tools/jobs/windows/estimator.hpp"
#include "tools/jobs/windows/steady_replay.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

using Level = cachesim::FidelityChoice::Level;
using cachesim::TwoPhaseSpeedUp;

constexpr std::uint32_t pilot_blocks = 4;
constexpr double error_of_all_looks = 0.05;  ///< of a 95 % interval

/// A comparison of two series.
struct Pair {
    std::size_t base = 0, own = 0;
    TwoPhaseSpeedUp now;
};

class FidelityPilot {
public:
    FidelityPilot(const tracer::PreparedScene& scene, const std::vector<WindowedStrategy>& strategies,
                  const EstimateSettings& settings, const std::vector<cachesim::Gpu>& gpus, Observer& observer,
                  const WindowSizes& sizes)
        : scene_(scene),
          strategies_(strategies),
          settings_(settings),
          gpus_(gpus),
          observer_(observer),
          sizes_(sizes),
          estimator_(scene, strategies, settings, gpus, {cachesim::Idealised{}}, false, observer, {sizes, 0}) {
        find_pairs();
        choice_.target = settings.target_error;
        exact_ = {"exact", 0, 0, steady_cost(strategies, gpus), true};
    }

    Estimated run() {
        choice_.pilot_seconds = pilot_blocks * estimator_.block_cost();
        if (exact_.seconds <= choice_.pilot_seconds) {
            choice_.levels = {exact_};
            choice_.reason = fmt::format(
                "all of the picture, every sample index, is replayed in {:.3g} CPU s, no more than a pilot of {} "
                "blocks "
                "of windows takes ({:.3g})",
                exact_.seconds, pilot_blocks, choice_.pilot_seconds);
            return run_exact();
        }
        choice_.pilot_blocks = pilot_blocks;
        estimator_.warn_of_pictures();
        run_blocks(pilot_blocks, pilot_blocks);
        note_pilot();
        Level level = weigh();
        choice_.reason = reason(level);
        while (!reached()) {
            if (level.blocks == 0) return run_exact();
            if (timed_ == level.timed_blocks && traced() == level.blocks) break;
            choice_.picked = level.name;
            run_blocks(level.timed_blocks, level.blocks);
            if (!reached() && timed_ < most_blocks) level = next_level(level);
        }
        if (choice_.picked.empty()) choice_.picked = level.name;
        if (!reached())
            observer_.warn(fmt::format("no more than {} blocks are replayed: ±{:.1f} %; the target was ±{:.2g} %",
                                       most_blocks, 100 * worst(), 100 * settings_.target_error));
        return result();
    }

private:
    void find_pairs();
    void run_blocks(std::uint32_t timed, std::uint32_t blocks);
    void measure();
    void note_pilot();
    Level weigh();
    Level next_level(const Level& last);
    Level cheapest(const char* name, std::uint32_t least_timed, std::uint32_t most_timed, bool more_work) const;
    std::string reason(const Level&) const;
    Estimated run_exact();
    Estimated result();

    std::uint32_t traced() const { return static_cast<std::uint32_t>(work_.front().size()); }
    double worst() const {
        double error = 0;
        for (const Pair& pair : pairs_) error = std::max(error, relative(pair.now.value));
        return error;
    }
    bool reached() const { return worst() <= settings_.target_error; }
    static double relative(const cachesim::Estimate& e) {
        const double error = e.half_width ? *e.half_width / std::fabs(e.mean) : std::nan("");
        return std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
    }
    /// By how much time may differ from work, the interval included.
    double most_difference() const {
        double most = 0;
        for (const Pair& pair : pairs_)
            most = std::max(most, pair.now.difference.half_width
                                      ? std::fabs(pair.now.difference.mean - 1) + *pair.now.difference.half_width
                                      : std::numeric_limits<double>::infinity());
        return most;
    }
    double widening_at(unsigned look, std::uint32_t timed) const {
        return timed < 2 ? 1 : cachesim::widening(timed - 1, error_of_all_looks / std::exp2(look));
    }
    /// At the next look.
    bool is_expected_to_reach(std::uint32_t timed, std::uint32_t blocks) const {
        return std::all_of(pairs_.begin(), pairs_.end(), [&](const Pair& pair) {
            return cachesim::expected_error(pair.now, timed, blocks, widening_at(looks_ + 1, timed)) <=
                   settings_.target_error;
        });
    }
    double seconds(std::uint32_t timed, std::uint32_t blocks) const {
        const std::uint32_t known = std::max(timed, traced());
        return (timed - timed_) * estimator_.block_cost() + (std::max(blocks, known) - known) * estimator_.work_cost();
    }

    const tracer::PreparedScene& scene_;
    const std::vector<WindowedStrategy>& strategies_;
    const EstimateSettings& settings_;
    const std::vector<cachesim::Gpu>& gpus_;
    Observer& observer_;
    WindowSizes sizes_;
    Estimator estimator_;
    std::string baseline_;
    std::vector<Pair> pairs_;
    std::vector<std::vector<double>> work_;  ///< of each series, block by block
    std::uint32_t timed_ = 0;                ///< blocks
    unsigned looks_ = 0;
    bool follows_ = false;  ///< the pilot: time differs from work by no more than the target
    Level exact_;
    cachesim::FidelityChoice choice_;
};

void FidelityPilot::find_pairs() {
    std::vector<cachesim::TimedSeries> series;
    for (const Estimator::Case& c : estimator_.cases())
        for (std::size_t g = 0; g < gpus_.size(); ++g)
            static_cast<cachesim::Origin&>(series.emplace_back()) = estimator_.origin(c, g);
    const cachesim::Baseline baseline = baseline_of(series, settings_.baseline, settings_.across_gpus);
    check_baseline(series, baseline);
    baseline_ = baseline.strategy;
    for (std::size_t i = 0; i < series.size(); ++i) {
        const auto* const base =
            find_baseline(series, series[i], baseline, [](const cachesim::TimedSeries&) { return true; });
        if (base && !baseline.is(series[i])) pairs_.push_back({static_cast<std::size_t>(base - series.data()), i, {}});
    }
    work_.resize(series.size());
    if (pairs_.empty())
        throw UsageError(
            "a level of accuracy to be chosen for one strategy; expected a baseline and another: what is chosen for is "
            "the predicted speed-up");
}

/// So many in time, so many more of work alone: a look.
void FidelityPilot::run_blocks(std::uint32_t timed, std::uint32_t blocks) {
    if (timed > timed_) {
        if (timed_ > 0) estimator_.expect(timed_, timed);
        estimator_.look(timed, baseline_);
    }
    const std::uint32_t begin = std::max(timed, traced()), end = std::max(blocks, begin);
    const auto& cases = estimator_.cases();
    for (std::size_t s = 0; s < work_.size(); ++s)
        for (std::size_t b = work_[s].size(); b < begin; ++b)
            work_[s].push_back(cases[s / gpus_.size()].blocks[b][s % gpus_.size()].issue_cycles);
    for (auto& of_series : work_) of_series.resize(end);
    timed_ = timed;
    if (end > begin) {
        const std::string name = fmt::format("work of {} blocks", end);
        observer_.expect(name, Work::trace, (end - begin) * estimator_.work_cost());
        const Stage stage(observer_, name, (end - begin) * cases.size(), "blocks");
        tbb::parallel_for(
            std::size_t{0}, (end - begin) * cases.size(),
            [&](std::size_t task) {
                const Estimator::Case& c = cases[task % cases.size()];
                const std::size_t block = begin + task / cases.size();
                const std::vector<double> cycles = count_issue_cycles(
                    *c.capture, c.first_launch(block), c.plan, c.plan.block(block, c.first[block]), sizes_, gpus_);
                for (std::size_t g = 0; g < gpus_.size(); ++g)
                    work_[task % cases.size() * gpus_.size() + g][block] = cycles[g];
                stage.add(1, 1);
            },
            tbb::simple_partitioner());
    }
    ++looks_;
    measure();
}

void FidelityPilot::measure() {
    const auto phases = [&](std::size_t series) {
        cachesim::TwoPhases p;
        p.work = work_[series];
        const Estimator::Case& c = estimator_.cases()[series / gpus_.size()];
        for (std::uint32_t b = 0; b < timed_; ++b)
            p.cycles.push_back(static_cast<double>(c.blocks[b][series % gpus_.size()].times.front().cycles));
        return p;
    };
    for (Pair& pair : pairs_)
        pair.now = cachesim::two_phase_speed_up(phases(pair.base), phases(pair.own), widening_at(looks_, timed_));
}

void FidelityPilot::note_pilot() {
    follows_ = most_difference() <= settings_.target_error;
    for (const Pair& pair : pairs_) {
        const Estimator::Case& c = estimator_.cases()[pair.own / gpus_.size()];
        const cachesim::Origin o = estimator_.origin(c, pair.own % gpus_.size());
        choice_.pilots.push_back({o.strategy, o.gpu, o.spp, pair.now.by_work, pair.now.by_time, pair.now.difference});
    }
}

/// The fewest seconds that are expected to reach the target; where none are, the most blocks.
Level FidelityPilot::cheapest(const char* name, std::uint32_t least_timed, std::uint32_t most_timed,
                              bool more_work) const {
    Level best{name, 0, 0, std::numeric_limits<double>::infinity(), false};
    const auto take = [&](std::uint32_t timed, std::uint32_t blocks) {
        const double cost = seconds(timed, blocks);
        if (cost < best.seconds && is_expected_to_reach(timed, blocks)) best = {name, timed, blocks, cost, true};
    };
    for (std::uint32_t timed = least_timed; timed <= most_timed; timed *= 2) {
        if (!more_work && timed >= traced()) take(timed, timed);
        for (std::uint32_t blocks = 2 * std::max(timed, traced()); more_work && blocks <= most_blocks; blocks *= 2)
            take(timed, blocks);
        // Work that is known costs nothing.
        if (more_work && traced() > timed) take(timed, traced());
    }
    if (best.suffices) return best;
    const std::uint32_t timed = most_timed;
    return {name, timed, most_blocks, seconds(timed, most_blocks), false};
}

/// All levels, for the report; returns the one to run.
Level FidelityPilot::weigh() {
    if (reached()) {
        choice_.levels = {{"timed", timed_, timed_, 0, true}};
        return choice_.levels.front();
    }
    Level functional = cheapest("functional", timed_, timed_, true);
    functional.suffices &= follows_;
    const Level two_phase = cheapest("two-phase", follows_ ? 2 * timed_ : timed_, most_blocks, true);
    const Level timed = cheapest("timed", 2 * timed_, most_blocks, false);
    choice_.levels = {functional, two_phase, timed, exact_};
    const Level* best = nullptr;
    for (const Level& level : choice_.levels)
        if (level.suffices && (!best || level.seconds < best->seconds)) best = &level;
    // All of a large picture always suffices, and takes days: only where windows would take longer.
    if (best == &choice_.levels.back() && exact_.seconds > timed.seconds) best = &choice_.levels[2];
    return *best;
}

/// It fell short: what it takes from here, in the same way or, with the most blocks, in time.
Level FidelityPilot::next_level(const Level& last) {
    Level two_phase = cheapest(last.name == "timed" ? "two-phase" : last.name.c_str(), timed_, most_blocks, true);
    if (two_phase.timed_blocks > timed_ && last.name == "functional") two_phase.name = "two-phase";
    Level timed = cheapest("timed", std::max(timed_, std::bit_ceil(traced())), most_blocks, false);
    Level next = two_phase.suffices && (!timed.suffices || two_phase.seconds < timed.seconds) ? two_phase : timed;
    if (exact_.seconds < next.seconds) next = exact_;
    choice_.reason += fmt::format("; that came to ±{:.2g} %, so {} takes over", 100 * worst(),
                                  next.blocks == 0 ? std::string("exact replay")
                                                   : fmt::format("{} with {} blocks in time and {} of work", next.name,
                                                                 next.timed_blocks, next.blocks));
    return next;
}

std::string FidelityPilot::reason(const Level& level) const {
    if (reached())
        return fmt::format("the pilot itself, {} blocks in time, is certain to ±{:.2g} %", timed_, 100 * worst());
    const Pair* widest = &pairs_.front();
    for (const Pair& pair : pairs_)
        if (std::fabs(pair.now.difference.mean - 1) > std::fabs(widest->now.difference.mean - 1)) widest = &pair;
    const std::string measured = fmt::format(
        "time differs from work by up to {:.2g} %, by at most {:.2g} % with its interval: {} the target of {:.2g} %",
        100 * std::fabs(widest->now.difference.mean - 1), 100 * most_difference(), follows_ ? "within" : "more than",
        100 * settings_.target_error);
    if (level.blocks == 0) return measured + "; replaying all of the picture is expected to take the fewest seconds";
    if (!level.suffices)
        return fmt::format("{}; no level is expected to reach it in {} blocks, so as many are replayed in time",
                           measured, most_blocks);
    return fmt::format("{}; of what is expected to reach it, {} takes the fewest seconds", measured, level.name);
}

Estimated FidelityPilot::run_exact() {
    choice_.picked = "exact";
    expect_steady(strategies_, gpus_, observer_);
    SteadyState steady = replay_steady(scene_, strategies_, gpus_, observer_);
    Estimated out;
    out.subject.traces = std::move(steady.traces);
    out.result = std::move(steady.result);
    out.fidelity = choice_;
    return out;
}

Estimated FidelityPilot::result() {
    Estimated out;
    out.subject.traces = estimator_.subject();
    out.result = estimator_.result();
    const double widening = widening_at(looks_, timed_);
    for (cachesim::Series& s : out.result.traffic) s.windows->widening = widening;
    for (cachesim::TimedSeries& s : out.result.times) s.windows->widening = widening;
    for (const Pair& pair : pairs_) out.result.times[pair.own].speed_up = pair.now.value;
    out.fidelity = choice_;
    return out;
}

}  // namespace

void check_fidelity(const EstimateSettings& settings, const std::vector<cachesim::Gpu>& gpus, bool timed) {
    if (settings.fidelity == Fidelity::windows) return;
    const char* const level = settings.fidelity == Fidelity::automatic ? "auto" : "exact";
    if (!timed)
        throw UsageError(
            fmt::format("fidelity {} without time; expected timed: it is about predicted speed-ups", level));
    if (settings.time_budget > 0 || settings.window_count > 0)
        throw UsageError(fmt::format(
            "fidelity {} beside a time budget or a number of windows; expected a target error alone", level));
    for (const cachesim::Gpu& gpu : gpus)
        if (const std::string why = cachesim::no_time_note(gpu); !why.empty())
            throw UsageError(fmt::format("fidelity {}: {}; expected GPUs with a predicted time", level, why));
}

Estimated estimate_at_fidelity(const tracer::PreparedScene& scene, const std::vector<WindowedStrategy>& strategies,
                               const EstimateSettings& settings, const std::vector<cachesim::Gpu>& gpus,
                               Observer& observer, const WindowSizes& sizes) {
    if (settings.fidelity == Fidelity::exact) {
        expect_steady(strategies, gpus, observer);
        SteadyState steady = replay_steady(scene, strategies, gpus, observer);
        Estimated out;
        out.subject.traces = std::move(steady.traces);
        out.result = std::move(steady.result);
        return out;
    }
    return FidelityPilot(scene, strategies, settings, gpus, observer, sizes).run();
}

}  // namespace raycache::tools
