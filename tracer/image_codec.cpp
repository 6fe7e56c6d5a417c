#include "tracer/image_codec.hpp"

#include <dlfcn.h>

#include "traces/error.hpp"

namespace raycache::tracer {

namespace {

constexpr const char* module_name = "libraycache_images.so";

[[noreturn]] void fail() {
    const char* const why = dlerror();
    throw Error(std::string(module_name) + ": cannot load the module that reads and writes images (" +
                (why == nullptr ? "no reason given" : why) + "); build or install raycache again");
}

/// Looks beside the program and where it is installed (the program's RUNPATH, set in CMakeLists.txt).
void* load() {
    void* const module = dlopen(module_name, RTLD_LAZY | RTLD_LOCAL);
    if (module == nullptr) fail();
    return module;
}

}  // namespace

void* image_module_symbol(const char* name) {
    static void* const module = load();
    void* const symbol = dlsym(module, name);
    if (symbol == nullptr) fail();
    return symbol;
}

const ImageCodec& image_codec() {
    static const ImageCodec* const codec =
        reinterpret_cast<const ImageCodec* (*)()>(image_module_symbol("raycache_image_codec"))();
    return *codec;
}

}  // namespace raycache::tracer
