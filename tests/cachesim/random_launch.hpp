// Random launches and small GPUs for the tests.
#pragma once

#include <random>

#include "cachesim/gpus/gpu.hpp"
#include "reference_trace.hpp"

namespace raycache::cachesim::test {

/// A GPU with everything small, LRU, modulo.
inline Gpu small_gpu() {
    Gpu gpu;
    gpu.name = "small";
    gpu.sms = 2;
    gpu.warps_per_sm = 4;
    gpu.warps_per_cta = 2;
    gpu.levels[0].sets = 2;
    gpu.levels[0].ways = 4;
    gpu.levels[1].sets = 4;
    gpu.levels[1].ways = 8;
    return gpu;
}

inline traces::Region region(traces::ObjectKind kind, std::uint64_t base, std::uint32_t size, std::uint32_t stride,
                             std::uint32_t count) {
    return {kind, base, size, stride, count, 0, {}};
}

/// `warps` warps of up to `records` records over the regions; some warps empty, some with ray starts only.
inline Launch random_launch(std::vector<traces::Region> regions, unsigned warps, unsigned records, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto below = [&](std::uint64_t n) { return random() % n; };
    Launch launch{std::move(regions), {}};
    for (unsigned w = 0; w < warps; ++w) {
        auto warp = std::make_shared<traces::WarpTrace>();
        warp->warp = w;
        const auto length = below(5) == 0 ? 0 : below(records + 1);
        for (std::uint64_t i = 0; i < length; ++i) {
            traces::Record record;
            while (record.mask == 0) record.mask = static_cast<std::uint32_t>(random() & (below(2) ? ~0ull : random()));
            record.ray = static_cast<traces::RayType>(below(traces::ray_types));
            record.bounce = static_cast<std::uint8_t>(below(8) == 0 ? 255 : below(3));
            record.region = static_cast<std::uint8_t>(below(launch.regions.size()));
            if (below(6) == 0) record.region = traces::ray_start;
            warp->records.push_back(record);
            if (!record.is_access()) continue;
            // Half of the accesses stay close together, as rays do.
            const std::uint64_t count = launch.regions[record.region].count;
            const std::uint64_t span = below(2) ? count : std::min<std::uint64_t>(count, 24);
            const std::uint64_t start = below(count - span + 1);
            for (unsigned lane = 0; lane < record.lanes(); ++lane)
                warp->elements.push_back(static_cast<std::uint32_t>(start + below(span)));
        }
        launch.warps.push_back(std::move(warp));
    }
    return launch;
}

}  // namespace raycache::cachesim::test
