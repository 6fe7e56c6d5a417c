// The content of a file, decompressed on the way: plain, or xz, gzip or zstd, told by its first bytes.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace raycache::traces {

class ByteSource {
public:
    /// Throws Error if the file cannot be read.
    explicit ByteSource(const std::string& path);
    ~ByteSource();
    ByteSource(const ByteSource&) = delete;
    ByteSource& operator=(const ByteSource&) = delete;

    /// Appends a piece of the content; false at its end. Throws Error if compressed data are damaged or cut short, or
    /// if decompressing takes more memory than memory_limit().
    bool read(std::string& out);

    /// "xz", "gzip" or "zstd"; empty: plain.
    const std::string& container() const;

    /// A way of decompression: one of byte_source.cpp.
    class Decompressor;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The first bytes of the content, decompressed: at most `most`, fewer where it is shorter.
std::string first_bytes(const std::string& path, std::size_t most);

}  // namespace raycache::traces
