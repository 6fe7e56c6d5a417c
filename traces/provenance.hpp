// Provenance as canonical JSON: one object, keys in alphabetical order, no spaces. Internal to traces/.
#pragma once

#include <string>
#include <string_view>

#include "traces/fault.hpp"
#include "traces/header.hpp"

namespace raycache::traces {

std::string provenance_to_json(const Provenance&);
Provenance provenance_from_json(std::string_view, const Origin&);

}  // namespace raycache::traces
