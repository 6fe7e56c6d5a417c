// Single look-ups in a level of one set per cache or of linear sets, as tests ask for them.
#pragma once

#include <cstdint>

#include "cachesim/cache/level.hpp"
#include "cachesim/gpus/gpu.hpp"
#include "cachesim/replay/request_sink.hpp"

namespace raycache::cachesim::test {

/// The sectors that the cache fetches for a look-up; one slice, modulo.
inline std::uint32_t look_up(Level& level, const CacheGeometry& geometry, std::uint32_t line, std::uint32_t sectors,
                             std::uint32_t cache = 0) {
    const auto set = static_cast<std::uint32_t>(cache * geometry.sets + line % geometry.sets);
    level.process(&set, &line, &sectors, 1);
    return sectors;
}

/// What a sink hears of a look-up of the first cache of the first SM.
inline ServedRequest served_request(const CacheGeometry& geometry, std::uint32_t line, std::uint32_t asked) {
    ServedRequest request;
    request.address = std::uint64_t{line} * geometry.line_bytes;
    request.line = line;
    request.asked = asked;
    return request;
}

}  // namespace raycache::cachesim::test
