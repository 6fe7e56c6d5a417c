// Small glTF files for tests: built in memory, written to a folder that vanishes with the test.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tracer/scene/scene.hpp"
#include "traces/error.hpp"

namespace raycache::tracer::test {

using nlohmann::json;

class TempFolder {
public:
    TempFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "raycache_XXXXXX").string();
        if (!mkdtemp(pattern.data())) throw std::runtime_error("cannot make a temporary folder");
        path_ = pattern;
    }
    ~TempFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TempFolder(const TempFolder&) = delete;
    TempFolder& operator=(const TempFolder&) = delete;

    std::string file(const std::string& name) const { return (path_ / name).string(); }
    std::string write(const std::string& name, const std::vector<std::uint8_t>& bytes) const {
        std::ofstream(file(name), std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        return file(name);
    }
    std::string write(const std::string& name, const std::string& text) const {
        return write(name, std::vector<std::uint8_t>(text.begin(), text.end()));
    }
    std::size_t entries() const {
        return static_cast<std::size_t>(
            std::distance(std::filesystem::directory_iterator(path_), std::filesystem::directory_iterator()));
    }

private:
    std::filesystem::path path_;
};

inline std::vector<std::uint8_t> bytes_of_file(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

inline std::string base64(const std::vector<std::uint8_t>& bytes) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const auto at = [&](std::size_t k) { return k < bytes.size() ? std::uint32_t{bytes[k]} : 0U; };
        const std::uint32_t bits = at(i) << 16 | at(i + 1) << 8 | at(i + 2);
        for (int k = 0; k < 4; ++k)
            text += i + static_cast<std::size_t>(k) <= bytes.size() ? digits[bits >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

/// Collects a glTF description and its one binary buffer.
struct GltfBuilder {
    json doc = {{"asset", {{"version", "2.0"}}},
                {"bufferViews", json::array()},
                {"accessors", json::array()},
                {"meshes", json::array()},
                {"nodes", json::array()}};
    std::vector<std::uint8_t> bin;

    int view(const void* data, std::size_t size, int stride = 0) {
        while (bin.size() % 4 != 0) bin.push_back(0);
        json v = {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", size}};
        if (stride != 0) v["byteStride"] = stride;
        const auto* bytes = static_cast<const std::uint8_t*>(data);
        bin.insert(bin.end(), bytes, bytes + size);
        doc["bufferViews"].push_back(v);
        return static_cast<int>(doc["bufferViews"].size()) - 1;
    }
    template <class T>
    int accessor(const std::vector<T>& numbers, const std::string& type, int component_type, bool normalized = false) {
        const std::size_t components = type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : 4;
        json a = {{"bufferView", view(numbers.data(), numbers.size() * sizeof(T))},
                  {"componentType", component_type},
                  {"count", numbers.size() / components},
                  {"type", type}};
        if (normalized) a["normalized"] = true;
        return add("accessors", a);
    }
    int floats(const std::vector<float>& numbers, const std::string& type) { return accessor(numbers, type, 5126); }
    int add(const char* section, const json& item) {
        doc[section].push_back(item);
        return static_cast<int>(doc[section].size()) - 1;
    }
    int mesh(const json& primitive) { return add("meshes", {{"primitives", {primitive}}}); }
    int node(const json& description) { return add("nodes", description); }
    /// A mesh of `primitive` at the origin.
    void place(const json& primitive) { node({{"mesh", mesh(primitive)}}); }

    /// One triangle in the plane z = 0, corners (0,0) (1,0) (0,1).
    int triangle_positions() { return floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3"); }
    void place_triangle() { place({{"attributes", {{"POSITION", triangle_positions()}}}}); }

    json finished(const std::string& uri = "") const {
        json result = doc;
        for (const char* section : {"bufferViews", "accessors", "meshes", "nodes"})
            if (result[section].empty()) result.erase(section);
        if (!bin.empty()) {
            result["buffers"] = {{{"byteLength", bin.size()}}};
            if (!uri.empty()) result["buffers"][0]["uri"] = uri;
        }
        return result;
    }
    std::vector<std::uint8_t> glb() const { return glb(finished().dump()); }
    std::vector<std::uint8_t> glb(std::string text) const {
        while (text.size() % 4 != 0) text += ' ';
        std::vector<std::uint8_t> content = bin;
        while (content.size() % 4 != 0) content.push_back(0);
        std::vector<std::uint8_t> result;
        const auto word = [&](std::uint32_t w) {
            for (int i = 0; i < 4; ++i) result.push_back(static_cast<std::uint8_t>(w >> (8 * i)));
        };
        word(0x46546C67);
        word(2);
        word(static_cast<std::uint32_t>(12 + 8 + text.size() + (content.empty() ? 0 : 8 + content.size())));
        word(static_cast<std::uint32_t>(text.size()));
        word(0x4E4F534A);
        result.insert(result.end(), text.begin(), text.end());
        if (content.empty()) return result;
        word(static_cast<std::uint32_t>(content.size()));
        word(0x004E4942);
        result.insert(result.end(), content.begin(), content.end());
        return result;
    }
    /// A .gltf with its buffer in a data: URI.
    std::string gltf() const { return finished("data:application/octet-stream;base64," + base64(bin)).dump(); }
};

struct Loaded {
    Scene scene;
    std::vector<std::string> warnings;
};

inline Loaded load_file(const std::string& path) {
    Loaded result;
    result.scene = load_gltf(path, [&](const std::string& warning) { result.warnings.push_back(warning); });
    return result;
}

inline Loaded load(const GltfBuilder& builder) {
    const TempFolder folder;
    return load_file(folder.write("scene.glb", builder.glb()));
}

/// The message of the Error that loading ends with; fails the assertion that uses it if there is none.
inline std::string error_of(const std::string& path) {
    try {
        load_file(path);
    } catch (const Error& e) {
        return e.what();
    }
    return "(no error)";
}

inline std::string error_of(const GltfBuilder& builder) {
    const TempFolder folder;
    return error_of(folder.write("scene.glb", builder.glb()));
}

/// Corner `k` of triangle `t`.
inline Vec3 corner(const Scene& scene, std::size_t t, std::size_t k) {
    return scene.positions[scene.indices[3 * t + k]];
}

inline Vec3 face_normal(const Scene& scene, std::size_t t) {
    const Vec3 a = corner(scene, t, 0);
    return normalize(cross(corner(scene, t, 1) - a, corner(scene, t, 2) - a));
}

/// 2 x 2, rows top to bottom: (255,0,0,255) (0,255,0,128) / (0,0,255,0) (200,100,50,64).
inline const std::vector<std::uint8_t> png_rgba{
    137, 80,  78,  71, 13,  10,  26,  10,  0,  0,   0,   13, 73, 72,  68,  82,  0,  0,  0,  2,
    0,   0,   0,   2,  8,   6,   0,   0,   0,  114, 182, 13, 36, 0,   0,   0,   22, 73, 68, 65,
    84,  120, 156, 99, 248, 207, 192, 240, 31, 8,   27,  24, 64, 244, 137, 20,  35, 7,  0,  58,
    209, 6,   27,  96, 158, 32,  137, 0,   0,  0,   0,   73, 69, 78,  68,  174, 66, 96, 130};

/// 2 x 1: 10, 200.
inline const std::vector<std::uint8_t> png_grey{
    137, 80, 78, 71,  13, 10,  26,  10, 0,   0,  0, 13, 73, 72, 68, 82, 0,  0,  0,   2,   0,  0,   0,
    1,   8,  0,  0,   0,  0,   209, 73, 32,  86, 0, 0,  0,  11, 73, 68, 65, 84, 120, 156, 99, 224, 58,
    1,   0,  0,  223, 0,  211, 75,  33, 165, 73, 0, 0,  0,  0,  73, 69, 78, 68, 174, 66,  96, 130};

/// 1 x 2: grey 10 alpha 20 / grey 200 alpha 0.
inline const std::vector<std::uint8_t> png_grey_alpha{
    137, 80, 78, 71, 13, 10, 26,  10,  0,   0,   0,   13, 73, 72, 68, 82, 0,  0,   0,   1,   0,   0,  0,  2,
    8,   4,  0,  0,  0,  51, 136, 126, 172, 0,   0,   0,  14, 73, 68, 65, 84, 120, 156, 99,  224, 18, 97, 56,
    193, 0,  0,  2,  24, 0,  231, 114, 99,  220, 134, 0,  0,  0,  0,  73, 69, 78,  68,  174, 66,  96, 130};

/// 1 x 1: (1,2,3).
inline const std::vector<std::uint8_t> png_rgb{
    137, 80, 78, 71, 13, 10, 26,  10,  0,   0,   0,   13, 73, 72, 68, 82, 0,  0,  0,   1,   0,  0,  0,
    1,   8,  2,  0,  0,  0,  144, 119, 83,  222, 0,   0,  0,  12, 73, 68, 65, 84, 120, 156, 99, 96, 100,
    98,  6,  0,  0,  14, 0,  7,   215, 111, 228, 120, 0,  0,  0,  0,  73, 69, 78, 68,  174, 66, 96, 130};

/// Claims 60000 x 60000 in a few bytes.
inline const std::vector<std::uint8_t> png_huge{
    137, 80, 78, 71, 13, 10, 26, 10,  0,   0,   0,  13, 73, 72, 68, 82, 0,  0,  234, 96,  0,   0,
    234, 96, 8,  6,  0,  0,  0,  128, 210, 117, 66, 0,  0,  0,  9,  73, 68, 65, 84,  120, 156, 99,
    0,   0,  0,  1,  0,  1,  94, 255, 125, 249, 0,  0,  0,  0,  73, 69, 78, 68, 174, 66,  96,  130};

}  // namespace raycache::tracer::test
