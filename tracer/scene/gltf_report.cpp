#include "tracer/scene/gltf_report.hpp"

#include <fmt/format.h>

#include "traces/error.hpp"

namespace raycache::tracer {

std::string one_line(std::string text) {
    for (char& c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte == 0x7F) c = ' ';
    }
    return text;
}

void GltfReport::fail(const std::string& where, const std::string& expected, const std::string& found,
                      const std::string& remedy) const {
    throw Error(one_line(fmt::format("{}: {}: expected {}, found {}; {}", path_, where, expected, found, remedy)));
}

void GltfReport::warning(const std::string& text) const {
    if (warn_) warn_(one_line(fmt::format("{}: {}", path_, text)));
}

}  // namespace raycache::tracer
