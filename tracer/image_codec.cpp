#include "tracer/image_codec.hpp"

#include <dlfcn.h>

#include "traces/error.hpp"

namespace raycache::tracer {

namespace {

constexpr const char* module_name = "libraycache_images.so";

/// Looks beside the program and where it is installed (the program's RUNPATH, set in CMakeLists.txt).
const ImageCodec* load() {
    const auto fail = [] {
        const char* const why = dlerror();
        throw Error(std::string(module_name) + ": cannot load the module that reads and writes images (" +
                    (why == nullptr ? "no reason given" : why) + "); build or install raycache again");
    };
    void* const module = dlopen(module_name, RTLD_LAZY | RTLD_LOCAL);
    if (module == nullptr) fail();
    using Codec = const ImageCodec* (*)();
    const auto codec = reinterpret_cast<Codec>(dlsym(module, "raycache_image_codec"));
    if (codec == nullptr) fail();
    return codec();
}

}  // namespace

const ImageCodec& image_codec() {
    static const ImageCodec* const codec = load();
    return *codec;
}

}  // namespace raycache::tracer
