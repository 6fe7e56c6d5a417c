// Provenance as canonical JSON: one object, keys in alphabetical order, no spaces. Internal to traces/.
#pragma once

#include <string>
#include <string_view>

#include "traces/fault.hpp"
#include "traces/header.hpp"

namespace raycache::traces {

/// Version 1 has no execution and order: they are those of a megakernel.
std::string provenance_to_json(const Provenance&, std::uint32_t version);
Provenance provenance_from_json(std::string_view, std::uint32_t version, const Origin&);

}  // namespace raycache::traces
