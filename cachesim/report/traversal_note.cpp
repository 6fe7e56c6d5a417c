#include "cachesim/report/traversal_note.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace raycache::cachesim {

std::string traversal_note(const std::vector<std::string>& units, bool software) {
    if (units.empty()) return "traversal: software";
    return fmt::format(
        "traversal: RT unit (assumed; cachesim/MODEL.md){}. Counts of caches include what RT units ask for, which "
        "profilers leave out",
        software ? fmt::format(" in {}; software in the others", fmt::join(units, ", ")) : "");
}

}  // namespace raycache::cachesim
