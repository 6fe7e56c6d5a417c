// What the room is made of.
#pragma once

#include <cstdint>
#include <vector>

#include "tracer/scene/scene.hpp"

namespace raycache::tracer::room {

/// Index of a material in Scene::materials.
enum class Stuff : std::uint16_t {
    wall,
    blue_wall,
    ceiling,
    white_paint,
    oak,     // textured
    walnut,  // textured
    dark_wood,
    linen,  // textured
    canvas,
    grey_felt,
    mustard_felt,
    teal_felt,
    curtain,
    wool_cream,
    wool_grey,
    wool_rust,
    leather,
    paper,
    book_red,
    book_blue,
    book_green,
    book_black,
    book_ochre,
    painting,  // textured
    porcelain,
    clay,
    soil,
    bark,
    leaf_dark,
    leaf_light,
    steel,
    brass,
    iron,
    mirror,
    glass,
    shade,  // of cloth that glows
    globe,
    daylight,
    count
};

std::vector<Material> materials();

/// The textures that materials() refers to: wood, weave, painting.
std::vector<Texture> textures();

}  // namespace raycache::tracer::room
