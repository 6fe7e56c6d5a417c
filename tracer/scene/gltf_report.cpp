#include "tracer/scene/gltf_report.hpp"

#include <fmt/format.h>

#include "traces/error.hpp"
#include "traces/printable.hpp"

namespace raycache::tracer {

void GltfReport::fail(const std::string& where, const std::string& expected, const std::string& found,
                      const std::string& remedy) const {
    throw Error(
        printable_line(fmt::format("{}: {}: expected {}, found {}; {}", path_, where, expected, found, remedy)));
}

void GltfReport::warning(const std::string& text) const {
    if (warn_) warn_(printable_line(fmt::format("{}: {}", path_, text)));
}

void GltfReport::charge(std::uint64_t bytes, const std::string& what) const {
    memory_->charge(bytes, printable_line(path_), printable_line(what));
}

}  // namespace raycache::tracer
