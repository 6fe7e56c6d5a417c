// How far a command is: one line on stderr, with one time left for all its stages.
//
// On a terminal the line is drawn over itself, ten times a second. Elsewhere a new one comes every 30 seconds, or every
// $RAYCACHE_PROGRESS_SECONDS; none if that is 0.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "tools/program/time_left.hpp"

namespace raycache::tools {

class Progress {
public:
    /// `command`: what the line begins with, such as "quality". Where nothing is ever expected nor counted, the
    /// line says how long it has worked.
    explicit Progress(std::string command);
    ~Progress();  ///< wipes the line
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// A stage is to come, or will take another time than was said before: `seconds`, by costs.hpp.
    void expect(const std::string& stage, Work work, double seconds);

    /// What runs now; over when the object goes. One at a time.
    class Stage {
    public:
        ~Stage() { progress_.end(); }
        Stage(const Stage&) = delete;
        Stage& operator=(const Stage&) = delete;
        /// Thread-safe. `units`: of what the rate counts.
        void add(std::uint64_t work, std::uint64_t units) const { progress_.add(work, units); }

    private:
        friend class Progress;
        explicit Stage(Progress& progress) : progress_(progress) {}
        Progress& progress_;
    };
    /// `total` in units of work, 0 where none is counted; `unit` names what the rate counts, such as "rays".
    [[nodiscard]] Stage begin(const std::string& stage, std::uint64_t total = 0, std::string unit = {});

private:
    using Clock = std::chrono::steady_clock;
    struct Known {
        std::string name;
        StageState state;
    };
    void add(std::uint64_t work, std::uint64_t units);
    void end();
    std::size_t find(const std::string& stage);
    std::string line(Clock::time_point now);
    void keep_saying();

    std::string command_, unit_;
    std::vector<Known> stages_;
    std::size_t current_ = none;
    std::uint64_t total_ = 0, done_ = 0, units_ = 0;
    Clock::time_point start_, stage_start_;
    bool terminal_, over_ = false;
    std::chrono::milliseconds interval_;
    std::mutex mutex_;
    std::condition_variable wake_;
    std::thread sayer_;
    static constexpr std::size_t none = ~std::size_t{0};
};

}  // namespace raycache::tools
