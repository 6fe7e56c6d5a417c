#include "tools/program/console.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <mutex>

#include "traces/error.hpp"
#include "traces/printable.hpp"

namespace raycache::tools {
namespace {

/// Messages carry names from files: no line break and no control character may reach the terminal.
std::string message_line(std::string_view text) {
    while (text.ends_with('\n')) text.remove_suffix(1);
    return printable_line(text);
}

/// "1234 bytes", "1.2 MiB"
std::string short_size(std::uint64_t bytes) {
    constexpr std::uint64_t kib = 1024;
    if (bytes < 10 * kib) return fmt::format("{} bytes", bytes);
    double size = static_cast<double>(bytes) / kib;
    const char* unit = "KiB";
    for (const char* next : {"MiB", "GiB", "TiB"}) {
        if (size < kib) break;
        size /= kib;
        unit = next;
    }
    return fmt::format("{:.{}f} {}", size, size < 10 ? 1 : 0, unit);
}

struct Status {
    std::mutex mutex;
    std::string line;
};
Status& status() {
    static Status& only = *new Status;  // never destroyed: threads may still speak
    return only;
}

constexpr const char* wipe = "\r\x1b[K";

}  // namespace

void warn(const std::string& message) { say(fmt::format("raycache: warning: {}\n", message_line(message))); }

void say_failure(const std::string& message) { say(fmt::format("raycache: error: {}\n", message_line(message))); }

int fail(const std::string& message, int exit_code) {
    say_failure(message);
    return exit_code;
}

void say_written(const std::string& path, std::uint64_t bytes) {
    say(fmt::format("raycache: wrote {}, {}\n", message_line(path), short_size(bytes)));
}

void print(const std::string& report) {
    set_status({});  // both may be the same terminal
    const std::string text = report.starts_with('{') ? printable_json(report) : printable_text(report);
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
        throw Error(fmt::format("cannot write the result to stdout: {}", std::strerror(errno)));
}

void say(const std::string& text) {
    const std::lock_guard lock(status().mutex);
    const bool drawn = !status().line.empty();
    std::fputs(((drawn ? wipe : "") + text + (drawn ? status().line : "")).c_str(), stderr);
}

void set_status(const std::string& line) {
    const std::lock_guard lock(status().mutex);
    if (line.empty() && status().line.empty()) return;
    status().line = line;
    std::fputs((wipe + line).c_str(), stderr);
}

}  // namespace raycache::tools
