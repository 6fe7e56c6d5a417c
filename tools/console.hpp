// What a person sees: results on stdout, everything else (warnings, progress, errors) on stderr.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

namespace raycache::tools {

/// "raycache 0.1.0"
std::string program_name();

/// Prints "raycache: warning: …".
void warn(const std::string& message);

/// Prints "raycache: error: …" on one line and returns the exit code.
int fail(const std::string& message, int exit_code);

/// Prints to stdout. Throws Error where that fails (a full disk behind a redirection).
void print(const std::string& text);

/// A progress line on stderr with rate and time left. Shown only on a terminal, at most ten times a second.
class ProgressBar {
public:
    /// `total` in units of work; `unit` names what the rate counts, such as "rays".
    ProgressBar(std::string label, std::uint64_t total, std::string unit);
    ~ProgressBar();  ///< wipes the line
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// Thread-safe.
    void add(std::uint64_t work, std::uint64_t units);

private:
    void draw(double seconds) const;

    std::string label_, unit_;
    std::uint64_t total_, done_ = 0, units_ = 0;
    bool terminal_;
    std::mutex mutex_;
    std::chrono::steady_clock::time_point start_, drawn_;
};

}  // namespace raycache::tools
