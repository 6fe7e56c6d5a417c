// A scene of a wanted number of triangles: every part as fine as its share allows, and one that takes what is left.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "tracer/scene/builtin/modelling/shapes.hpp"

namespace raycache::tracer::modelling {

struct Part {
    void (*build)(MeshBuilder&, Fineness);
    double share;  ///< of the wanted triangles
};

/// What is made of small pieces, as many as there are triangles left.
struct Remainder {
    void (*build)(MeshBuilder&, std::size_t triangles);
    std::size_t (*vertices)(std::size_t triangles);  ///< that build() adds
};

/// Each part at the greatest fineness, to one per cent, at which it keeps its share (at the least one where none does).
MeshBuilder build_within(std::uint64_t triangles, std::span<const Part>, const Remainder&);

}  // namespace raycache::tracer::modelling
