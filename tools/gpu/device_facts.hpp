// What a program of tools/gpu/ says of the device it runs on.
#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace raycache::gpu {

/// By name, in order; numbers are exact up to 2^53.
using DeviceFacts = std::vector<std::pair<std::string, std::variant<std::string, double>>>;

}  // namespace raycache::gpu
