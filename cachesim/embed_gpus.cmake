# Compiles every preset of cachesim/gpus into raycache_cachesim, so that the program needs no data folder. A new GPU is
# one new .toml file there and no line anywhere.
file(GLOB gpu_files CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/gpus/*.toml)
set(gpu_texts "")
foreach(gpu_file IN LISTS gpu_files)
  get_filename_component(gpu_name ${gpu_file} NAME_WE)
  file(READ ${gpu_file} gpu_text)
  string(APPEND gpu_texts "    {\"${gpu_name}\", R\"preset(${gpu_text})preset\"},\n")
endforeach()
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${gpu_files})
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/gpu_presets.cpp @ONLY CONTENT
"// Generated from cachesim/gpus/*.toml by cachesim/embed_gpus.cmake.
#include \"cachesim/gpus/presets.hpp\"

namespace raycache::cachesim {

const std::vector<PresetText>& preset_texts() {
    static const std::vector<PresetText> texts{
@gpu_texts@    };
    return texts;
}

}  // namespace raycache::cachesim
")
target_sources(raycache_cachesim PRIVATE ${CMAKE_BINARY_DIR}/generated/gpu_presets.cpp)
