// The lines of a text file, plain or compressed by xz, gzip or zstd, whatever its name.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "traces/accelsim/byte_source.hpp"
#include "traces/accelsim/text_place.hpp"

namespace raycache::traces {

class TextLines : public TextPlace {
public:
    /// Throws Error if the file cannot be read.
    explicit TextLines(const std::string& path) : path_(path), source_(path) {}

    /// The next line without its end; false after the last. Throws Error if the compressed data are damaged or cut
    /// short, or if a line has more than a million characters. `line` is valid until the next call.
    bool next(std::string_view& line);

    /// "PATH: line N", N being the line that next() gave last.
    std::string where() const override;

private:
    std::string path_;
    ByteSource source_;
    std::string text_;  ///< not yet given, from `at_` on
    std::size_t at_ = 0;
    std::uint64_t line_ = 0;
};

}  // namespace raycache::traces
