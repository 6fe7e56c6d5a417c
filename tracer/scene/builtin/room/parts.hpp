// The parts of the room. Each adds itself to the builder, in world space, as fine as asked.
#pragma once

#include "tracer/scene/builtin/modelling/shapes.hpp"
#include "tracer/scene/builtin/room/layout.hpp"
#include "tracer/scene/builtin/room/materials.hpp"

namespace raycache::tracer::room {

void shell(MeshBuilder&, Fineness);  ///< walls, ceiling with its cornice, windows with the daylight behind, radiators
void floor_boards(MeshBuilder&, Fineness);
void curtains(MeshBuilder&, Fineness);   ///< and the rods they hang from
void seats(MeshBuilder&, Fineness);      ///< sofa and armchair with their cushions
void tables(MeshBuilder&, Fineness);     ///< coffee table of glass, dining table, its chairs, sideboard
void books(MeshBuilder&, Fineness);      ///< the shelf and all that stands in it
void tableware(MeshBuilder&, Fineness);  ///< plates, cups and vases, of porcelain and glass
void lamps(MeshBuilder&, Fineness);      ///< pendant, floor lamp, table lamp
void pictures(MeshBuilder&, Fineness);   ///< paintings and a mirror in their frames
void plant(MeshBuilder&, Fineness);

/// Tufts of wool, three triangles each, of exactly or just under `triangles` triangles.
void rug(MeshBuilder&, std::size_t triangles);
/// How many vertices rug() adds.
std::size_t rug_vertices(std::size_t triangles);

/// A cushion around the origin, its seams in the plane Y = 0: half-widths `half.x` and `half.z`, half its thickness
/// `half.y`.
void cushion(MeshBuilder&, Vec3 half, Fineness);

}  // namespace raycache::tracer::room
