// Reading what comes through a named pipe, such as `<(command)` of a shell.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace raycache::traces {

bool is_pipe(const std::string& path);

/// Everything that comes until the last writer has closed the pipe, at most `most` bytes. Throws Error where no program
/// opens it for writing within `patience`: opening it as a file would wait for ever, without a word.
std::string read_pipe(const std::string& path, std::size_t most,
                      std::chrono::milliseconds patience = std::chrono::seconds(5));

}  // namespace raycache::traces
