// A file that gets its name only when it is whole. Used for every file the project writes: traces, images, tables.
//
// A symbolic link stays one: the file that it leads to is replaced. What is no ordinary file (a device, a named pipe)
// cannot be replaced and is written to directly, as is stdout, whose name is "-".
#pragma once

#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <string_view>

namespace raycache::traces {

class OutputFile {
public:
    /// Opens the file's partial_name(), or what is written to directly; throws Error (what, where, why) if it cannot.
    explicit OutputFile(const std::string& path);
    ~OutputFile();  ///< removes the partial file unless commit() was reached
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    void write(std::span<const std::uint8_t>);  ///< throws Error when the disk is full
    void write(std::string_view);
    void commit();  ///< flushes, closes, renames; throws Error
    std::uint64_t bytes() const { return bytes_; }

    /// The file that an OutputFile of this name writes until it is whole: "PATH.partial", links followed. Empty if it
    /// writes to PATH directly.
    static std::string partial_name(const std::string& path);

private:
    const std::string& open_name() const { return partial_.empty() ? path_ : partial_; }

    std::string partial_, path_;  ///< partial_: empty if path_ is written to directly
    std::FILE* file_ = nullptr;
    std::uint64_t bytes_ = 0;
};

}  // namespace raycache::traces
