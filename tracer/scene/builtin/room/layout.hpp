// Where things are, in metres: X from the wall with the windows, Z from the wall with the sofa, Y up.
#pragma once

#include <array>

#include "tracer/scene/builtin/modelling/mesh_builder.hpp"

namespace raycache::tracer::room {

using namespace modelling;

inline constexpr float width = 6.2F, depth = 5.2F, height = 2.85F;
inline constexpr float wall_thickness = 0.32F;

/// Of the wall at X = 0.
struct Window {
    float from, to;  ///< Z
};
inline constexpr std::array<Window, 2> windows{{{0.75F, 2.05F}, {2.95F, 4.25F}}};
inline constexpr float sill = 0.85F, lintel = 2.4F;

inline constexpr Vec3 sofa_at{2.75F, 0, 0.62F}, coffee_table_at{2.75F, 0, 2.15F}, armchair_at{4.6F, 0, 2.35F};
inline constexpr float armchair_turn = -0.2F;  ///< in turns, from facing +Z
inline constexpr Vec3 dining_table_at{1.55F, 0, 4.0F};
inline constexpr float dining_length = 1.7F, dining_width = 0.9F, dining_height = 0.75F;
inline constexpr float coffee_length = 1.15F, coffee_width = 0.62F, coffee_height = 0.4F;
inline constexpr Vec3 shelf_from{4.35F, 0, 0.02F}, shelf_to{6.1F, 2.25F, 0.34F};
inline constexpr Vec3 sideboard_from{5.75F, 0, 2.9F}, sideboard_to{6.18F, 0.78F, 4.6F};
inline constexpr Vec3 plant_at{0.55F, 0, 0.45F}, floor_lamp_at{1.32F, 0, 0.45F};
inline constexpr Vec3 rug_from{1.35F, 0.004F, 1.15F}, rug_to{4.15F, 0.004F, 3.0F};

}  // namespace raycache::tracer::room
