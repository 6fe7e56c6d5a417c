// Which scene a job traces, seen how.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "tools/jobs/observer.hpp"
#include "tools/jobs/outputs.hpp"
#include "tracer/prepared_scene.hpp"

namespace raycache::tools {

/// As a user types it.
struct SceneSettings {
    std::string source;           ///< a .glb or .gltf file, or the name of a built-in scene
    std::uint64_t detail = 0;     ///< triangles wanted of a built-in scene; 0: the scene's own
    std::string camera;           ///< of the scene, by name or index; empty: the first
    std::string eye, look_at;     ///< instead of a camera of the file, "X,Y,Z" both; empty: none
    float fov = 0;                ///< vertical field of view in degrees; 0: the camera's
    std::string sky = "auto";     ///< constant sky and a sun: auto (where the scene has no light), on, off
    bool spatial_splits = false;  ///< build the BVH with spatial splits
    std::string layout = tracer::default_layout;  ///< of the BVH in memory: a name of bvh_layouts()
    std::string bvh_cache;  ///< folder that keeps built BVHs; empty: none. Results do not depend on it

    /// Loads the scene; what is built on it is built when it is first asked for, and speaks to the Observer then. Throws
    /// UsageError for settings that are none, and if one of `outputs`, which the caller is going to write, is a file
    /// that the scene is read from; else as load_scene().
    std::unique_ptr<tracer::PreparedScene> prepare(const FileNames& outputs, Observer&) const;
    /// As options of a command line, for a trace's provenance.
    std::string command() const;
};

}  // namespace raycache::tools
