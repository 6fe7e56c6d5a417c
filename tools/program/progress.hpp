// What a job says, on stderr: warnings, and how far it is, in one line with one time left for all its stages.
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

#include "tools/jobs/observer.hpp"
#include "tools/program/time_left.hpp"

namespace raycache::tools {

class Progress final : public Observer {
public:
    /// `command`: what the line begins with, such as "quality". Where nothing is ever expected nor counted, the
    /// line says how long it has worked.
    explicit Progress(std::string command);
    ~Progress() override;  ///< wipes the line

    void expect(const std::string& stage, Work work, double seconds) override;
    void begin(const std::string& stage, std::uint64_t total, const std::string& unit) override;
    void advance(std::uint64_t work, std::uint64_t units) override;
    void end() override;
    void warn(const std::string& line) override;         ///< as console.hpp does
    void resumable(const std::string& advice) override;  ///< advise_if_interrupted()

private:
    using Clock = std::chrono::steady_clock;
    struct Known {
        std::string name;
        StageState state;
    };
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
