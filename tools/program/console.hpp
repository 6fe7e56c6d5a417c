// What a person sees: results on stdout, everything else (warnings, progress, errors) on stderr.
#pragma once

#include <cstdint>
#include <string>

namespace raycache::tools {

/// Prints "raycache: warning: …".
void warn(const std::string& message);

/// Prints "raycache: error: …" on one line and returns the exit code.
int fail(const std::string& message, int exit_code);

/// The same without an exit code: one of several failures.
void say_failure(const std::string& message);

/// Prints "raycache: wrote FILE, SIZE".
void say_written(const std::string& path, std::uint64_t bytes);

/// Prints a report to stdout: text, or JSON, which begins with a brace. Control characters of names in it, all but line
/// feeds, and what is no UTF-8 are replaced, in JSON escaped. Throws Error where that fails (a full disk behind a
/// redirection).
void print(const std::string& text);

/// To stderr as it is, as far as that goes: what it cannot take must not end the work.
void say(const std::string& text);

/// The line at the bottom of the terminal, which everything else that is said goes above; empty: none.
void set_status(const std::string& line);

}  // namespace raycache::tools
