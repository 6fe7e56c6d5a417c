#include "tools/program/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>

#include "tools/program/console.hpp"
#include "tools/program/interruption.hpp"

namespace raycache::tools {
namespace {

/// 1234567 -> "1.2 M"
std::string short_number(double value) {
    const char* unit = "";
    for (const char* next : {"k", "M", "G"}) {
        if (value < 1000) break;
        value /= 1000;
        unit = next;
    }
    return fmt::format("{:.{}f} {}", value, value < 10 ? 1 : 0, unit);
}

std::string short_time(double seconds) {
    const auto s = std::lround(seconds);
    if (s >= 3600) return fmt::format("{} h {:02} min", s / 3600, s % 3600 / 60);
    return s >= 60 ? fmt::format("{} min {:02} s", s / 60, s % 60) : fmt::format("{} s", s);
}

std::chrono::milliseconds interval_of_lines(bool terminal) {
    if (terminal) return std::chrono::milliseconds(100);
    double seconds = 30;
    if (const char* text = std::getenv("RAYCACHE_PROGRESS_SECONDS"))
        std::from_chars(text, text + std::strlen(text), seconds);
    return std::chrono::milliseconds(std::llround(std::clamp(seconds, 0.0, 1e6) * 1000));
}

}  // namespace

Progress::Progress(std::string command)
    : command_(std::move(command)),
      start_(Clock::now()),
      terminal_(isatty(STDERR_FILENO) != 0),
      interval_(interval_of_lines(terminal_)) {
    if (interval_.count() == 0) return;
    try {
        sayer_ = std::thread([this] { keep_saying(); });
    } catch (const std::system_error&) {  // no more threads: then without
    }
}

Progress::~Progress() {
    {
        const std::lock_guard lock(mutex_);
        over_ = true;
    }
    wake_.notify_all();
    if (sayer_.joinable()) sayer_.join();
    if (terminal_) set_status({});
}

std::size_t Progress::find(const std::string& stage) {
    const auto at = std::find_if(stages_.begin(), stages_.end(), [&](const Known& k) { return k.name == stage; });
    if (at != stages_.end()) return static_cast<std::size_t>(at - stages_.begin());
    stages_.push_back({stage, {}});
    return stages_.size() - 1;
}

void Progress::expect(const std::string& stage, Work work, double seconds) {
    const std::lock_guard lock(mutex_);
    StageState& state = stages_[find(stage)].state;
    state.work = work;
    state.expected = seconds;
}

void Progress::begin(const std::string& stage, std::uint64_t total, const std::string& unit) {
    const std::lock_guard lock(mutex_);
    current_ = find(stage);
    StageState& state = stages_[current_].state;
    state.running = true;
    if (state.expected == 0 && total > 0) state = {Work::trace, 1, 0, 0, true};
    total_ = total;
    done_ = units_ = 0;
    unit_ = unit;
    stage_start_ = Clock::now();
}

void Progress::advance(std::uint64_t work, std::uint64_t units) {
    const std::lock_guard lock(mutex_);
    done_ += work;
    units_ += units;
}

void Progress::end() {
    const std::lock_guard lock(mutex_);
    StageState& state = stages_[current_].state;
    state.running = false;
    state.done = 1;
    state.seconds = std::chrono::duration<double>(Clock::now() - stage_start_).count();
    current_ = none;
}

void Progress::warn(const std::string& line) { tools::warn(line); }

void Progress::resumable(const std::string& advice) { advise_if_interrupted(advice); }

std::string Progress::line(Clock::time_point now) {
    std::vector<StageState> states;
    for (const Known& stage : stages_) states.push_back(stage.state);
    std::string doing;
    if (current_ != none) {
        StageState& state = states[current_];
        state.seconds = std::chrono::duration<double>(now - stage_start_).count();
        if (total_ > 0) state.done = std::min(1.0, static_cast<double>(done_) / static_cast<double>(total_));
        doing = stages_[current_].name;
        if (units_ > 0 && state.seconds > 0)
            doing += fmt::format(", {}{}/s", short_number(static_cast<double>(units_) / state.seconds), unit_);
    }
    const double left = time_left(states), spent = std::chrono::duration<double>(now - start_).count();
    if (std::all_of(states.begin(), states.end(), [](const StageState& s) { return s.expected == 0; }))
        return fmt::format("{}{}: working for {}", terminal_ ? "" : "raycache: ", command_, short_time(spent));
    const double share = spent + left > 0 ? spent / (spent + left) : 1;
    if (!terminal_)
        return fmt::format("raycache: {}: {:.0f} %, {} left{}", command_, 100 * share, short_time(left),
                           doing.empty() ? "" : " (" + doing + ")");
    constexpr int width = 24;
    const int filled = static_cast<int>(share * width);
    return fmt::format("{} [{:#<{}}{:.<{}}] {:3.0f} %  {} left  {}", command_, "", filled, "", width - filled,
                       100 * share, short_time(left), doing);
}

void Progress::keep_saying() {
    std::unique_lock lock(mutex_);
    while (!wake_.wait_for(lock, interval_, [this] { return over_; })) {
        const std::string text = line(Clock::now());
        if (terminal_)
            set_status(text);
        else
            say(text + "\n");
    }
}

}  // namespace raycache::tools
