// The parts of the courtyard. Each adds itself to the builder, in world space, as fine as asked.
#pragma once

#include "tracer/scene/builtin/courtyard/layout.hpp"
#include "tracer/scene/builtin/courtyard/materials.hpp"
#include "tracer/scene/builtin/modelling/mesh_builder.hpp"
#include "tracer/scene/builtin/modelling/shapes.hpp"

namespace raycache::tracer::courtyard {

void arcade(MeshBuilder&, Fineness);     ///< columns, round arches, mouldings, the gallery's edge
void house(MeshBuilder&, Fineness);      ///< walls, doors, windows, floors, ceilings with their beams, bell tower
void gallery(MeshBuilder&, Fineness);    ///< posts, brackets and the railing with its balusters
void roof(MeshBuilder&, Fineness);       ///< rows of curved tiles
void paving(MeshBuilder&, Fineness);     ///< worn stones, kerbs
void fountain(MeshBuilder&, Fineness);   ///< basin, bowls, water
void furniture(MeshBuilder&, Fineness);  ///< tables, chairs, parasols
void tableware(MeshBuilder&, Fineness);  ///< plates, cups, bottles, cutlery, fruit
void ornament(MeshBuilder&, Fineness);   ///< lanterns on chains, strings of cut paper
void pots(MeshBuilder&, Fineness);       ///< flower pots and jars, without their plants
void tree_wood(MeshBuilder&, Fineness);  ///< trunks, branches, twigs, and the rings of stone around them

}  // namespace raycache::tracer::courtyard
