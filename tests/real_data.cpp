#include "tests/real_data.hpp"

#include <filesystem>

#include "tests/folders.hpp"
#include "tests/skip.hpp"

namespace raycache::test {
namespace {

std::optional<std::string> find(const std::filesystem::path& path, const std::string& what, const std::string& remedy) {
    require_tag("[data]");
    if (std::filesystem::is_regular_file(path)) return path.string();
    skip(what + " " + path.filename().string() + " is absent", remedy);
    return std::nullopt;
}

}  // namespace

std::optional<std::string> real_scene(const std::string& file) {
    return find(std::filesystem::path(scenes_folder()) / file, "the scene", scenes_remedy());
}

std::optional<std::string> reference_trace(const std::string& name) {
    return find(std::filesystem::path(reference_folder()) / (name + ".rtw.zst"), "the reference trace",
                reference_remedy());
}

}  // namespace raycache::test
