// What the courtyard is made of.
#pragma once

#include <cstdint>
#include <vector>

#include "tracer/scene/scene.hpp"

namespace raycache::tracer::courtyard {

/// Index of a material in Scene::materials.
enum class Stuff : std::uint16_t {
    ochre_plaster,  // textured
    white_plaster,  // textured
    red_plaster,
    mosaic,  // textured
    stone,
    pale_stone,
    mortar,
    paver_grey,
    paver_sand,
    paver_rose,
    tile_red,
    tile_orange,
    tile_brown,
    dark_wood,
    light_wood,
    blue_paint,
    green_paint,
    iron,
    brass,
    dark_glass,
    bottle_glass,
    water,
    terracotta,
    blue_glaze,
    soil,
    porcelain,
    white_cloth,
    red_cloth,
    orange_peel,
    lemon_peel,
    wax,
    bark,
    leaf_deep,
    leaf_mid,
    leaf_light,
    leaf_olive,
    ivy_dark,
    ivy_light,
    agave,
    bougainvillea,
    geranium,
    paper_pink,    // cut paper: holes by alpha mask
    paper_yellow,  // cut paper
    paper_green,   // cut paper
    count
};

std::vector<Material> materials();

/// The textures that materials() refers to: plaster, floor mosaic, cut paper.
std::vector<Texture> textures();

}  // namespace raycache::tracer::courtyard
