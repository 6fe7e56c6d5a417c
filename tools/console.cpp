#include "tools/console.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "traces/error.hpp"

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

/// Messages carry names from files: no line break and no control character may reach the terminal.
std::string one_line(std::string text) {
    while (!text.empty() && text.back() == '\n') text.pop_back();
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
    return text;
}

}  // namespace

std::string program_name() { return "raycache " RAYCACHE_VERSION; }

void warn(const std::string& message) { fmt::print(stderr, "raycache: warning: {}\n", one_line(message)); }

int fail(const std::string& message, int exit_code) {
    fmt::print(stderr, "raycache: error: {}\n", one_line(message));
    return exit_code;
}

void print(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
        throw Error(fmt::format("cannot write the result to stdout: {}", std::strerror(errno)));
}

ProgressBar::ProgressBar(std::string label, std::uint64_t total, std::string unit)
    : label_(std::move(label)),
      unit_(std::move(unit)),
      total_(total),
      terminal_(isatty(STDERR_FILENO) != 0),
      start_(std::chrono::steady_clock::now()),
      drawn_(start_) {}

ProgressBar::~ProgressBar() {
    if (terminal_ && drawn_ != start_) fmt::print(stderr, "\r\x1b[K");
}

void ProgressBar::add(std::uint64_t work, std::uint64_t units) {
    if (!terminal_) return;
    const std::lock_guard lock(mutex_);
    done_ += work;
    units_ += units;
    const auto now = std::chrono::steady_clock::now();
    if (now - drawn_ < std::chrono::milliseconds(100)) return;
    drawn_ = now;
    draw(std::chrono::duration<double>(now - start_).count());
}

void ProgressBar::draw(double seconds) const {
    constexpr int width = 24;
    const double share = total_ == 0 ? 1 : std::min(1.0, static_cast<double>(done_) / static_cast<double>(total_));
    const int filled = static_cast<int>(share * width);
    const std::string left = share > 0 ? short_time(seconds / share - seconds) : "?";
    fmt::print(stderr, "\r\x1b[K{} [{:#<{}}{:.<{}}] {:3.0f} %  {}{}/s  {} left", label_, "", filled, "", width - filled,
               100 * share, short_number(static_cast<double>(units_) / seconds), unit_, left);
    std::fflush(stderr);
}

}  // namespace raycache::tools
