// Files that a command is about to write: never over what it reads, and known to be possible before the work begins.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/jobs/observer.hpp"

namespace raycache::tools {

using FileNames = std::vector<std::string>;

/// Throws UsageError if an output is the file of an input, under whatever name or link. Empty names and files that do
/// not exist are passed over.
void refuse_overwriting(const FileNames& inputs, const FileNames& outputs);

/// Throws UsageError if two outputs are one file, under whatever names or links. What is no ordinary file, such as
/// /dev/null, may be named twice.
void refuse_same_outputs(const FileNames& outputs);

/// Throws UsageError if `path` is "-", where stdout is for something else.
void refuse_stdout(const char* option, const std::string& path);

/// Before the work: refuse_same_outputs(), throws Error if one of the outputs cannot be written (a folder that is
/// missing or read-only, a named pipe that nobody reads, a closed stdout), and calls warn_of_unfinished(). Once a
/// process; named pipes stay open to its end.
void check_outputs(const FileNames& outputs, const Say& warn);

/// Warns of files of that name that a killed run left unfinished.
void warn_of_unfinished(const std::string& path, const Say& warn);

/// Things that are written one after the other. One that fails does not prevent the others.
class Deliveries {
public:
    /// Calls `deliver`; keeps the message of the Error it throws.
    void attempt(const std::function<void()>& deliver);
    /// Throws Error if something failed: the last failure, after `say` was called with each of the others.
    void finish(const Say& say);

private:
    FileNames failures_;
};

/// A file with this text.
void write_text(const std::string& path, const std::string& text);

}  // namespace raycache::tools
