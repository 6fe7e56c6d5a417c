// How the glTF reader speaks to the user: every message is one line that begins with the file's path.
#pragma once

#include <string>

#include "tracer/scene/scene.hpp"

namespace raycache::tracer {

/// `text` with every control character replaced, so that a name found in a file cannot break a message into lines.
std::string one_line(std::string text);

class GltfReport {
public:
    GltfReport(std::string path, const Warn& warn) : path_(std::move(path)), warn_(warn) {}

    const std::string& path() const { return path_; }

    /// Throws Error "PATH: WHERE: expected EXPECTED, found FOUND; REMEDY".
    [[noreturn]] void fail(const std::string& where, const std::string& expected, const std::string& found,
                           const std::string& remedy = "the file is damaged, export it again") const;

    void warning(const std::string& text) const;

private:
    std::string path_;
    const Warn& warn_;
};

}  // namespace raycache::tracer
