// The text of the presets compiled into the program. The definition is generated: cachesim/embed_gpus.cmake.
#pragma once

#include <string>
#include <vector>

namespace raycache::cachesim {

struct PresetText {
    std::string name;  ///< file name without .toml
    std::string toml;  ///< the whole file
};

/// In order of file name.
const std::vector<PresetText>& preset_texts();

}  // namespace raycache::cachesim
