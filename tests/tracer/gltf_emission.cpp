// Emissive textures: what glows, how much, and what that decides.
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/tracer/pictures.hpp"
#include "tracer/paths/lights.hpp"
#include "tracer/scene/emission.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

using Texel = std::array<std::uint8_t, 3>;
constexpr Texel black{0, 0, 0}, white{255, 255, 255};

/// A black square whose emission is a texture of these texels.
SquareFile glowing(std::uint32_t width, std::uint32_t height, const std::vector<Texel>& texels,
                   const std::vector<float>& uv = {0, 1, 1, 1, 1, 0, 0, 0}) {
    json material = grey(0);
    material["emissiveFactor"] = {1, 1, 1};
    material["emissiveTexture"] = {{"index", 0}};
    SquareFile file(material, uv);
    file.add("textures", {{"source", 0}});
    file.add("images", image_of(png_of(width, height, texels)));
    return file;
}

Scene scene_of(SquareFile file) { return load_lit(file.finish(), SceneRequest::Sky::off).scene; }

/// Counts the texels that an integrator reads.
class TexelCount final : public Traversal {
public:
    explicit TexelCount(const EmbreeScene& scene) : inner_(scene) {}
    void closest(std::uint32_t mask, traces::RayType type, std::uint8_t bounce, const Ray* rays, Hit* hits) override {
        inner_.closest(mask, type, bounce, rays, hits);
    }
    std::uint32_t occluded(std::uint32_t mask, traces::RayType type, std::uint8_t bounce, const Ray* rays) override {
        return inner_.occluded(mask, type, bounce, rays);
    }
    void read_texels(std::uint32_t mask, traces::RayType, std::uint8_t bounce, const std::uint32_t*) override {
        (bounce == 0 ? first : later) += std::popcount(mask);
    }
    int first = 0, later = 0;

private:
    EmbreeTraversal inner_;
};

/// Texels read by one path through the middle of the picture.
TexelCount texels_of_path(Scene scene, const PathSettings& paths) {
    const PreparedScene prepared(std::move(scene), {});
    TexelCount count(prepared.embree());
    StrategySettings settings;
    settings.samples.spp = 1;
    const SamplingStrategy strategy(settings, path_dimensions(paths.bounces));
    const CameraRays camera(prepared.camera(), 16, 16);
    PathIntegrator integrator({prepared.scene(), camera, prepared.lights(), prepared.texels(), strategy, paths, count});
    const auto base = strategy.base_point(0);
    std::array<PathLane, PathLanes::count> lanes;
    std::array<Vec3, PathLanes::count> radiance{};
    lanes[0] = {8, 8, 8 * 16 + 8, 0, base.data()};
    integrator.trace(1, lanes, radiance);
    return count;
}

/// Of the texture coordinates given: its share by a grid of points in each triangle.
double mean_by_points(const Scene& scene, std::uint32_t triangle, int side) {
    const TexelLayout texels(scene);
    double sum = 0;
    int count = 0;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            float u = (static_cast<float>(i) + 0.5F) / static_cast<float>(side);
            float v = (static_cast<float>(j) + 0.5F) / static_cast<float>(side);
            if (u + v > 1) u = 1 - u, v = 1 - v;
            const Material& m = scene.materials[0];
            const auto texel = texels.fetch(m.emission_texture, texcoord_at(scene, triangle, u, v), m.emission_lookup);
            sum += double{luminance(texel.color * m.emission)};
            ++count;
        }
    return sum / count;
}

}  // namespace

TEST_CASE("emission: a black texture makes no light, and the file gets a sky and a sun as one without light") {
    const auto [scene, warnings] = load_lit(glowing(2, 2, {black, black, black, black}).finish());
    CHECK(luminance(scene.sky) > 0);
    CHECK(scene.sun);
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].find("has no light") != std::string::npos);
    CHECK(Lights(scene_of(glowing(1, 1, {black}))).empty());
    CHECK(mean(picture(scene_of(glowing(1, 1, {black})), 8, 4)) == Vec3{0, 0, 0});
}

TEST_CASE("emission: a factor of 0 keeps a texture dark, and reads nothing of it") {
    SquareFile file = glowing(1, 1, {white});
    file.doc["materials"][0]["emissiveFactor"] = {0, 0, 0};
    const Scene scene = load(file.finish()).scene;
    CHECK(scene.textures.empty());
    CHECK_FALSE(emits_light(scene));
}

TEST_CASE("emission: the camera sees factor times texel, the left black and the right as bright as the factor") {
    SquareFile file = glowing(2, 1, {black, white});
    file.doc["materials"][0]["emissiveFactor"] = {1, 0.5, 0.25};
    const auto pixels = picture(scene_of(file), 16, 4);
    for (std::uint32_t y = 0; y < 16; ++y) {
        CHECK(pixels[y * 16 + 3] == Vec3{0, 0, 0});
        CHECK(pixels[y * 16 + 12] == Vec3{1, 0.5F, 0.25F});
    }
}

TEST_CASE("emission: triangles on black texels are no lights, those partly on it are by what they send out") {
    // The diagonal cuts 4 x 4 texels; one texel of the lower right half glows.
    std::vector<Texel> texels(16, black);
    texels[15] = white;
    const Scene scene = scene_of(glowing(4, 4, texels));
    const MeanEmission of(scene, scene.materials[0]);
    const float lower = of.of(0), upper = of.of(1);
    CHECK(lower + upper == Approx(2.0 / 16).epsilon(1e-5));
    const Scene right = scene_of(glowing(2, 1, {black, white}, {0.6F, 0, 0.9F, 0, 0.9F, 0.5F, 0.6F, 0.5F}));
    const Scene left = scene_of(glowing(2, 1, {black, white}, {0.1F, 0, 0.4F, 0, 0.4F, 0.5F, 0.1F, 0.5F}));
    CHECK_FALSE(Lights(right).empty());
    CHECK(Lights(left).empty());
    CHECK_FALSE(emits_light(left));
}

TEST_CASE("emission: the mean over a triangle is that of points on it, for every wrap mode and size") {
    std::vector<Texel> texels;
    for (int i = 0; i < 7 * 5; ++i) {
        const auto level = static_cast<std::uint8_t>(i * 41 % 256);
        texels.push_back({level, static_cast<std::uint8_t>(255 - level), static_cast<std::uint8_t>(i * 7)});
    }
    const std::vector<std::vector<float>> coordinates{{0, 1, 1, 1, 1, 0, 0, 0},
                                                      {-1.3F, 0.2F, 2.9F, -0.7F, 1.1F, 3.3F, 0.4F, 0.6F},
                                                      {0.31F, 0.3F, 0.33F, 0.31F, 0.36F, 0.4F, 0.3F, 0.5F},
                                                      {5, 5, 5.001F, 5, 5.001F, 5.001F, 5, 5.001F}};
    for (const auto& uv : coordinates)
        for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror}) {
            Scene scene = scene_of(glowing(7, 5, texels, uv));
            scene.materials[0].emission_lookup.s = wrap;
            scene.materials[0].emission_lookup.t = wrap == Wrap::clamp ? Wrap::mirror : wrap;
            const MeanEmission of(scene, scene.materials[0]);
            for (std::uint32_t t = 0; t < 2; ++t)
                CHECK(double{of.of(t)} == Approx(mean_by_points(scene, t, 700)).epsilon(0.01).margin(1e-4));
        }
}

TEST_CASE("emission: a triangle that is a line or a point on the texture, or covers too many texels, still glows") {
    const std::vector<Texel> half{black, white};
    for (const auto& uv : std::vector<std::vector<float>>{{0.7F, 0, 0.7F, 0, 0.7F, 0, 0.7F, 0},
                                                          {0.1F, 0, 0.9F, 0, 0.9F, 0, 0.1F, 0},
                                                          {0, 0, 1e6F, 0, 1e6F, 1e6F, 0, 1e6F}}) {
        const Scene scene = scene_of(glowing(2, 1, half, uv));
        const MeanEmission of(scene, scene.materials[0]);
        CHECK(of.of(0) > 0);
        CHECK(of.of(0) <= 1);
    }
}

TEST_CASE("emission: every way to find lights gives the same light on a wall", "[slow]") {
    // A floor below a textured lamp, one spot of which glows.
    std::vector<Texel> texels(64, black);
    texels[9] = texels[10] = white;
    texels[60] = {255, 128, 0};
    SquareFile file = glowing(8, 8, texels);
    json wall = grey(0.8);
    json floor = file.primitive;
    floor["material"] = file.add("materials", wall);
    file.finish({{"translation", {0, 1.5, 0}}, {"rotation", {0.7071068, 0, 0, 0.7071068}}});
    file.node({{"mesh", file.mesh(floor)},
               {"rotation", {-0.7071068, 0, 0, 0.7071068}},
               {"translation", {0, -0.5, 0}},
               {"scale", {2, 2, 2}}});
    Scene scene = load_lit(file, SceneRequest::Sky::off).scene;
    scene.cameras[0].eye = {0, 0.5F, 6};
    PathSettings paths;
    paths.bounces = 2;
    std::vector<Vec3> found;
    for (const LightSampling lights : {LightSampling::bsdf, LightSampling::nee, LightSampling::mis}) {
        paths.lights = lights;
        Scene copy = scene;
        found.push_back(mean(picture(std::move(copy), 24, lights == LightSampling::bsdf ? 1600 : 400, paths)));
    }
    CHECK(found[1].x > 0.001F);
    for (int k = 0; k < 2; ++k) {
        CHECK(found[0][k] == Approx(found[1][k]).epsilon(0.05));
        CHECK(found[2][k] == Approx(found[1][k]).epsilon(0.03));
    }
}

TEST_CASE("emission: a texture of its own coordinates and transform is looked up by them") {
    SquareFile file = glowing(2, 1, {black, white});
    file.doc["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    file.doc["materials"][0]["emissiveTexture"]["extensions"]["KHR_texture_transform"] = {{"offset", {0.5, 0}}};
    const auto pixels = picture(scene_of(file), 16, 1);
    CHECK(pixels[8 * 16 + 3] == Vec3{1, 1, 1});
    CHECK(pixels[8 * 16 + 12].x < 0.5F);
}

TEST_CASE("emission: its texels are read where they count as light, and none where no texture says how much") {
    PathSettings paths;
    paths.bounces = 0;
    const Scene lamp = scene_of(glowing(1, 1, {white}));
    CHECK(texels_of_path(lamp, paths).first == 1);  // the camera meets the lamp, whose black body ends the path
    Scene plain = lamp;
    plain.materials[0].emission_texture = -1;
    CHECK(texels_of_path(plain, paths).first == 0);
    // A grey square before the lamp: its shadow ray aims at a point of the lamp.
    SquareFile file = glowing(1, 1, {white});
    json wall = file.primitive;
    wall["material"] = file.add("materials", grey());
    file.finish({{"translation", {0, 0, 9}}});
    file.node({{"mesh", file.mesh(wall)}});
    const Scene lit = load_lit(file, SceneRequest::Sky::off).scene;
    CHECK(texels_of_path(lit, paths).first == 1);
    paths.lights = LightSampling::bsdf;
    CHECK(texels_of_path(lit, paths).first == 0);
}
