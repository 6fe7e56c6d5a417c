// tinygltf needs these two before its implementation.
#include <fstream>
#include <nlohmann/json.hpp>

#define TINYGLTF_IMPLEMENTATION
#include "tracer/scene/gltf_model.hpp"

namespace raycache::tracer {

tinygltf::Model parse_gltf_model(const std::string& json_text, std::string& problems) {
    tinygltf::TinyGLTF parser;
    tinygltf::Model model;
    std::string warnings;
    const bool parsed =
        parser.LoadASCIIFromString(&model, &problems, &warnings, json_text.data(),
                                   static_cast<unsigned int>(json_text.size()), "", tinygltf::NO_REQUIRE);
    if (!parsed && problems.empty()) problems = "unknown problem";
    return model;
}

}  // namespace raycache::tracer
