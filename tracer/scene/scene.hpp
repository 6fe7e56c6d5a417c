// A scene as the rest of the tracer sees it: one flat list of triangles in one space, the world's but for its frame.
// Instances are already expanded. Metres, Y up, right-handed; colours are linear Rec. 709.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tracer/image.hpp"
#include "tracer/scene/scene_frame.hpp"
#include "tracer/vec.hpp"
#include "traces/memory_budget.hpp"

namespace raycache::tracer {

/// Called once per warning, one line without a newline. The program prints it on stderr.
using Warn = std::function<void(const std::string&)>;

/// Metres from the origin, on each axis. What lies further is refused: squared distances would overflow a float, and
/// Embree takes no ray from there.
inline constexpr float max_coordinate = 1e18F;

inline bool is_usable_position(Vec3 p) {
    return std::abs(p.x) <= max_coordinate && std::abs(p.y) <= max_coordinate && std::abs(p.z) <= max_coordinate;
}

/// Beyond the edges of a texture: it begins again, its last texel goes on, or it comes back.
enum class Wrap : std::uint8_t { repeat, clamp, mirror };

/// How a material looks up one of its textures.
struct TextureLookup {
    std::uint8_t layer = 0;  ///< of texture coordinates: 0 = Scene::texcoords, n = Scene::more_texcoords[n - 1]
    Wrap s = Wrap::repeat, t = Wrap::repeat;
    bool operator==(const TextureLookup&) const = default;
};

struct Material {
    std::string name;
    Vec3 base_color{1, 1, 1};     ///< factor, multiplied with the texture and the colour of vertices
    float alpha = 1;              ///< factor
    int base_color_texture = -1;  ///< index into Scene::textures, or -1
    bool alpha_mask = false;      ///< glTF alphaMode MASK: a texel below `alpha_cutoff` is a hole
    float alpha_cutoff = 0.5F;
    bool alpha_blend = false;   ///< glTF alphaMode BLEND: rays pass straight with probability 1 - alpha
    bool vertex_alpha = false;  ///< some triangle of it has a vertex whose alpha is not 1
    Vec3 emission{0, 0, 0};     ///< radiance, W sr^-1 m^-2, factor times strength, multiplied with the texture
    int emission_texture = -1;  ///< index into Scene::textures, or -1

    float metallic = 0, roughness = 1;    ///< factors, 0 … 1
    int metallic_roughness_texture = -1;  ///< green times roughness, blue times metallic; index, or -1
    float transmission = 0;               ///< share of the dielectric that is glass, 0 … 1
    float ior = 1.5F;                     ///< index of refraction, at least 1; 0: reflects everything
    bool thin = true;                     ///< glass is a pane; false: it bounds a solid

    TextureLookup base_color_lookup, metallic_roughness_lookup, emission_lookup;

    /// Whether a ray may pass through some of its points: alphaMode MASK.
    bool may_have_holes() const {
        return alpha_mask && (base_color_texture >= 0 || vertex_alpha || alpha < alpha_cutoff);
    }

    /// Lambert's surface: neither metal nor glass, and a coat of roughness 1 counts as none.
    bool diffuse() const {
        return metallic == 0 && roughness >= 1 && transmission == 0 && !alpha_blend && metallic_roughness_texture < 0;
    }
};

/// A pinhole camera.
struct Camera {
    std::string name;
    Vec3 eye{0, 0, 0};        ///< in the scene's frame, as vertices are
    Vec3 forward{0, 0, -1};   ///< unit
    Vec3 up{0, 1, 0};         ///< unit, orthogonal to forward
    float vertical_fov = 45;  ///< degrees, in (0, 180)
    std::string problem{};    ///< why no picture can be taken with it; empty where one can
};

/// A directional light of finite size.
struct Sun {
    Vec3 direction{0, 1, 0};          ///< unit, towards the sun
    Vec3 irradiance{0, 0, 0};         ///< on a plane facing it, W m^-2
    float angular_radius = 0.00465F;  ///< radians
};

/// A light of no size (KHR_lights_punctual). Only shadow rays find it.
struct PunctualLight {
    enum class Kind : std::uint8_t { point, spot, directional } kind = Kind::point;
    Vec3 position{0, 0, 0};              ///< not of a directional one
    Vec3 direction{0, 0, -1};            ///< unit, that it shines in; not of a point
    Vec3 intensity{0, 0, 0};             ///< W sr^-1; directional: irradiance on a plane facing it, W m^-2
    float range = 0;                     ///< metres, beyond which it is dark; 0 = none
    float cos_inner = 1, cos_outer = 0;  ///< of a spot: full inside the one, dark outside the other
};

/// Linear colour with alpha.
struct VertexColor {
    Vec3 color{1, 1, 1};
    float alpha = 1;
    bool operator==(const VertexColor&) const = default;
};

struct Scene {
    std::string name;                ///< file name without folder, or "courtyard(detail=…)"
    std::uint64_t hash = 0;          ///< XXH3-64 of the source bytes (a .gltf: of its buffers and images too)
    std::vector<std::string> files;  ///< that it was read from; none of a built-in scene

    SceneFrame frame;             ///< of all positions here; the world itself of most scenes
    std::vector<Vec3> positions;  ///< all finite
    std::vector<Vec3> normals;    ///< unit, one per position, or empty if no mesh has any; (0,0,0) = face normal
    std::vector<Vec2> texcoords;  ///< one per position, or empty if no mesh has any
    std::vector<std::vector<Vec2>> more_texcoords;  ///< further layers, each one per position
    std::vector<VertexColor> colors;                ///< one per position, or empty if all are white
    std::vector<std::uint32_t> indices;             ///< 3 per triangle, counter-clockwise from the front
    std::vector<std::uint16_t> material_of;         ///< one per triangle
    std::vector<Material> materials;                ///< at least one
    std::vector<Texture> textures;
    std::vector<Camera> cameras;  ///< at least one; the first is the default
    Vec3 sky{0, 0, 0};            ///< constant radiance from outside, 0 = none
    std::optional<Sun> sun;
    std::vector<PunctualLight> punctual_lights;
    /// Triangles wider than this are giants beside the others: float tells less than the others' size about where on
    /// them a ray ends, so that is done in double (EmbreeScene, Surface::leave). PreparedScene sets it.
    float giant_above = std::numeric_limits<float>::infinity();
    /// Charged with what the scene's source made us allocate; for what is built on it. May be missing.
    std::shared_ptr<MemoryBudget> memory;

    std::size_t triangle_count() const { return material_of.size(); }
    /// Throws Error where the budget has no room for `bytes` more. To be called before they are allocated for `what`.
    void charge(std::uint64_t bytes, const char* what) const;
    Box bounds() const;
    /// `giant_above` of such triangles: 16384 times their median width.
    float find_giant_above() const;
};

/// Where a scene comes from and how it is to be lit and seen.
struct SceneRequest {
    std::string source;        ///< path of a .glb or .gltf file, or a built-in scene's name
    std::uint64_t detail = 0;  ///< built-in scenes: wanted number of triangles; 0 = the scene's default
    enum class Sky { automatic, on, off } sky = Sky::automatic;  ///< automatic: on where the file has no emitter
    std::string camera;                                          ///< name or index; empty = the first
    std::optional<Vec3d> eye, look_at;                           ///< in the world; both or neither; override `camera`
    std::optional<float> vertical_fov;                           ///< degrees; overrides the camera's
};

/// Loads a file or builds a built-in scene, adds sky and sun where asked, and moves the chosen camera to cameras[0].
/// Throws UsageError for unknown names (listing the valid ones), Error for bad files.
Scene load_scene(const SceneRequest&, const Warn&);

/// Reads a glTF 2.0 file (.glb or .gltf). Throws Error: missing, empty, truncated or not glTF; an accessor out of
/// bounds; a required extension we lack; no triangle left. Triangles with a non-finite vertex are skipped with one
/// warning that counts them. A file without cameras gets one that sees the whole scene.
Scene load_gltf(const std::string& path, const Warn&);

struct BuiltinScene {
    std::string name, description;
    std::uint64_t default_detail, min_detail, max_detail;  ///< triangles
    Scene (*build)(std::uint64_t detail);
};
/// The registry of procedural scenes.
const std::vector<BuiltinScene>& builtin_scenes();
/// The one of this name, or nullptr.
const BuiltinScene* find_builtin_scene(const std::string& name);

}  // namespace raycache::tracer
