// raycache list gpus --keys: what a GPU file may say.
#pragma once

#include <cstddef>
#include <string>

namespace raycache::tools {

/// A paragraph for each section, a line for each key, broken at `width`.
std::string gpu_keys_text(std::size_t width);

/// {"gpu_keys": [{"sections": ["l1", "l2", "l3"], "name": "ways", …}]}
std::string gpu_keys_json();

}  // namespace raycache::tools
