// A file that gets its name only when it is whole. Used for every file the project writes: traces, images, tables.
#pragma once

#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <string_view>

namespace raycache::traces {

class OutputFile {
public:
    explicit OutputFile(std::string path);  ///< opens "PATH.partial"; throws Error (what, where, why) if it cannot
    ~OutputFile();                          ///< removes the partial file unless commit() was reached
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    void write(std::span<const std::uint8_t>);  ///< throws Error when the disk is full
    void write(std::string_view);
    void commit();  ///< flushes, closes, renames; throws Error
    std::uint64_t bytes() const { return bytes_; }

private:
    std::string path_, partial_;
    std::FILE* file_ = nullptr;
    std::uint64_t bytes_ = 0;
};

}  // namespace raycache::traces
