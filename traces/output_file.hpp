// A file that gets its name only when it is whole. Used for every file the project writes: traces, images, tables.
//
// Until then its bytes go to a partial file of its own (partial_file.hpp), so that of two processes that write one file
// each writes a whole one, and the last wins. A symbolic link stays one: the file that it leads to is replaced. What is
// no ordinary file (a device, a named pipe) cannot be replaced and is written to directly, as is stdout, whose name is
// "-".
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "traces/partial_file.hpp"

namespace raycache::traces {

class OutputFile {
public:
    /// Opens a partial file, or what is written to directly; waits a few seconds for a named pipe's reader. Throws
    /// Error (what, where, why) if it cannot.
    explicit OutputFile(const std::string& path);
    ~OutputFile();  ///< removes the partial file unless commit() was reached
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    void write(std::span<const std::uint8_t>);  ///< throws Error when the disk is full
    void write(std::string_view);
    void commit();  ///< flushes to the disk, gives the name, closes; throws Error
    std::uint64_t bytes() const { return bytes_; }

    /// Whether a file of this name is written to directly: stdout, a device, a pipe.
    static bool is_direct(const std::string& path);

private:
    std::string path_;
    std::unique_ptr<PartialFile> partial_;  ///< none if path_ is written to directly
    std::FILE* file_ = nullptr;
    std::uint64_t bytes_ = 0;
};

/// Opens a named pipe for writing; throws Error where no program opens it for reading within that time. The caller
/// closes it.
int open_pipe_for_writing(const std::string& path, std::chrono::milliseconds patience = std::chrono::seconds(5));

}  // namespace raycache::traces
