// A file read at any offset from any thread. Internal to traces/.
#pragma once

#include <cstdint>
#include <string>

#include "traces/bytes.hpp"
#include "traces/fault.hpp"

namespace raycache::traces {

class InputFile {
public:
    explicit InputFile(std::string path);  ///< throws Error if it cannot be read or is no ordinary file
    ~InputFile();
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;

    std::uint64_t bytes() const { return bytes_; }
    Origin at(std::uint64_t offset) const { return {path_, offset}; }
    /// Replaces `out` by `count` bytes; the caller has bounded offset + count by bytes().
    void read(std::uint64_t offset, std::size_t count, Bytes& out) const;

private:
    std::string path_;
    int descriptor_ = -1;
    std::uint64_t bytes_ = 0;
};

}  // namespace raycache::traces
