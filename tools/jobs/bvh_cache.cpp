#include "tools/jobs/bvh_cache.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "tools/jobs/outputs.hpp"
#include "tracer/bvh/bvh_file.hpp"
#include "traces/error.hpp"

namespace raycache::tools {

namespace fs = std::filesystem;

void check_bvh_cache(const std::string& folder) {
    std::error_code unknown;
    const fs::file_status status = fs::status(folder, unknown);
    if (fs::exists(status) && !fs::is_directory(status))
        throw UsageError(fmt::format(
            "the BVH cache {}: expected a folder, found something else; name a folder with --bvh-cache or in "
            "RAYCACHE_BVH_CACHE",
            folder));
}

tracer::Bvh cached_bvh(const std::string& folder, const tracer::Scene& scene, const tracer::BvhSettings& settings,
                       const Say& warn) {
    const std::string key = tracer::bvh_key(scene, settings);
    const std::string path = (fs::path(folder) / tracer::bvh_file_name(key)).string();
    warn_of_unfinished(path, warn);
    std::error_code error;
    if (fs::exists(fs::symlink_status(path, error))) {
        try {
            return tracer::read_bvh(path, scene, settings, key);
        } catch (const Error& e) {
            warn(fmt::format("cached BVH built again: {}", e.what()));
        }
    }
    tracer::Bvh bvh = tracer::build_bvh(scene, settings);
    fs::create_directories(folder, error);  // writing says it if that failed
    try {
        tracer::write_bvh(path, bvh, scene, key);
    } catch (const Error& e) {
        warn(fmt::format("the BVH is not kept: {}", e.what()));
    }
    return bvh;
}

}  // namespace raycache::tools
