// The lines of a text file, plain or compressed by xz, whatever its name.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace raycache::traces {

class TextLines {
public:
    /// Throws Error if the file cannot be read.
    explicit TextLines(const std::string& path);
    ~TextLines();
    TextLines(const TextLines&) = delete;
    TextLines& operator=(const TextLines&) = delete;

    /// The next line without its end; false after the last. Throws Error if the compressed data are damaged or cut
    /// short, or if a line has more than a million characters. `line` is valid until the next call.
    bool next(std::string_view& line);

    /// Throws Error: "PATH: line N: WHAT: expected …, found …; REMEDY", N being the line that next() gave last.
    [[noreturn]] void refuse(std::string_view what, std::string_view expected, std::string_view found) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace raycache::traces
