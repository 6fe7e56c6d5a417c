// Mean radiance of pictures of small scenes, and PNG files, for tests.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/tracer/gltf_files.hpp"
#include "tracer/image.hpp"
#include "tracer/paths/embree_traversal.hpp"
#include "tracer/paths/integrators/path_integrator.hpp"
#include "tracer/prepared_scene.hpp"

namespace raycache::tracer::test {

/// A PNG of these texels, row after row.
inline std::vector<std::uint8_t> png_of(std::uint32_t width, std::uint32_t height,
                                        const std::vector<std::array<std::uint8_t, 3>>& texels) {
    const TempFolder folder;
    const std::string path = folder.file("texels.png");
    write_screen_image(path, {width, height, texels});
    return bytes_of_file(path);
}

inline json image_of(const std::vector<std::uint8_t>& png) { return {{"uri", "data:image/png;base64," + base64(png)}}; }

/// The picture of `scene` from its first camera, row after row.
inline std::vector<Vec3> picture(Scene scene, std::uint32_t size, std::uint32_t samples, PathSettings paths = {}) {
    const PreparedScene prepared(std::move(scene), {});
    EmbreeTraversal traversal(prepared.embree());
    StrategySettings settings;
    settings.decorrelation = "random";
    settings.samples.spp = samples;
    const SamplingStrategy strategy(settings, path_dimensions(paths.bounces));
    const CameraRays camera(prepared.camera(), size, size);
    PathIntegrator integrator(
        {prepared.scene(), camera, prepared.lights(), prepared.texels(), strategy, paths, traversal});
    std::vector<Vec3> result(std::size_t{size} * size);
    for (std::uint32_t sample = 0; sample < samples; ++sample) {
        const auto base = strategy.base_point(sample);
        for (std::uint32_t pixel = 0; pixel < size * size; ++pixel) {
            std::array<PathLane, PathLanes::count> lanes;
            std::array<Vec3, PathLanes::count> radiance{};
            lanes[0] = {pixel % size, pixel / size, pixel, sample, base.data()};
            integrator.trace(1, lanes, radiance);
            result[pixel] += radiance[0] / static_cast<float>(samples);
        }
    }
    return result;
}

inline Vec3 mean(const std::vector<Vec3>& pixels) {
    double sum[3] = {};
    for (const Vec3 p : pixels)
        for (int k = 0; k < 3; ++k) sum[k] += double{p[k]};
    const auto n = static_cast<double>(pixels.size());
    return {static_cast<float>(sum[0] / n), static_cast<float>(sum[1] / n), static_cast<float>(sum[2] / n)};
}

/// A square from (-1,-1,0) to (1,1,0) that faces a camera at (0,0,3), textured from corner to corner, v downwards.
struct SquareFile : GltfBuilder {
    json primitive;
    int square = 0;

    explicit SquareFile(const json& material, const std::vector<float>& uv = {0, 1, 1, 1, 1, 0, 0, 0}) {
        primitive = {{"attributes",
                      {{"POSITION", floats({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, "VEC3")},
                       {"TEXCOORD_0", floats(uv, "VEC2")}}},
                     {"indices", accessor(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR", 5123)},
                     {"material", add("materials", material)}};
    }
    /// To be called once, after `primitive` is as wanted.
    SquareFile& finish(json node_of_square = json::object()) {
        node_of_square["mesh"] = mesh(primitive);
        square = node(node_of_square);
        add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.6}, {"znear", 0.01}}}});
        node({{"camera", 0}, {"translation", {0, 0, 3}}});
        return *this;
    }
};

inline json grey(double color = 0.5) {
    return {{"doubleSided", true},
            {"pbrMetallicRoughness",
             {{"baseColorFactor", {color, color, color, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}}};
}

/// As the program loads a file, with the sky on, automatic or off.
inline Loaded load_lit(const GltfBuilder& builder, SceneRequest::Sky sky = SceneRequest::Sky::automatic) {
    const TempFolder folder;
    SceneRequest request;
    request.source = folder.write("scene.glb", builder.glb());
    request.sky = sky;
    Loaded result;
    result.scene = load_scene(request, [&](const std::string& warning) { result.warnings.push_back(warning); });
    return result;
}

}  // namespace raycache::tracer::test
