// Writes down which triangles the rays of a warp pass because there is a hole in them, and nothing else.
#pragma once

#include <cstdint>
#include <vector>

#include "tracer/simt/recorder.hpp"

namespace raycache::tracer {

class HoleRecorder : public NullRecorder {
public:
    struct Passed {
        std::uint32_t lane, triangle;  ///< triangle of the scene
    };
    void passed(std::uint32_t lane, std::uint32_t triangle) { holes.push_back({lane, triangle}); }

    std::vector<Passed> holes;  ///< in the order in which they were met
};

}  // namespace raycache::tracer
