// A GPU's memory system as the replay needs it, read from a TOML preset in this folder or from a user's file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace raycache::cachesim {

/// Which set a line goes to.
enum class SetIndex { modulo, xor_fold };

/// A sectored set-associative cache. Any positive numbers will do: powers of two are not required.
struct CacheGeometry {
    std::uint64_t sets = 0, ways = 0;
    std::uint32_t line_bytes = 128, sector_bytes = 32;
    SetIndex index = SetIndex::modulo;  ///< formulas: cachesim/cache/set_index.hpp
    std::string policy = "lru";         ///< what to evict: a name of cache_policies()

    std::uint64_t bytes() const { return sets * ways * line_bytes; }
};

struct Gpu {
    std::string name;         ///< "gtx-980-ti"
    std::string description;  ///< "GeForce GTX 980 Ti (GM200, Maxwell)"
    std::uint32_t sms = 0;
    std::uint32_t warps_per_sm = 0;  ///< resident at once; a multiple of the CTA size is not required
    std::uint32_t warps_per_cta = 8;
    std::uint32_t l1_per_sm =
        1;             ///< independent L1s of an SM (Maxwell: 2); its resident warps are dealt out among them
    CacheGeometry l1;  ///< one of them
    CacheGeometry l2;  ///< the whole L2; line and sector size as in L1
};

/// A preset's name, or the path of a .toml file (anything with a '/' or ending in ".toml"). Throws UsageError for an
/// unknown name (listing the valid ones); Error "FILE:LINE: …" for unknown or missing keys, wrong types, impossible
/// geometry.
Gpu load_gpu(const std::string& name_or_path);

struct GpuPreset {
    std::string name, description;
};
/// Presets compiled into the program, sorted by name.
std::vector<GpuPreset> gpu_presets();

/// One value of a GPU file, as it is written there.
struct GpuValue {
    std::string key;     ///< "sms", "l1.ways"
    std::string value;   ///< "22", "modulo"
    std::string source;  ///< who says so, or "assumed…"; empty if the file gives none
};
/// Every value except name and description, in the order of the fields of Gpu. Takes and throws what load_gpu() does.
std::vector<GpuValue> gpu_values(const std::string& name_or_path);

}  // namespace raycache::cachesim
