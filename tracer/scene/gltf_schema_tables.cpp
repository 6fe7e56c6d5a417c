#include "tracer/scene/gltf_schema_tables.hpp"

namespace raycache::tracer::gltf_schema {

namespace {

constexpr Rule accessor(std::string_view name) { return refers(name, "accessors", "an accessor"); }
constexpr Rule view(std::string_view name) { return refers(name, "bufferViews", "a buffer view"); }
constexpr Rule image(std::string_view name) { return refers(name, "images", "an image"); }
constexpr Rule accessors(std::string_view name, Type type) { return refers(name, "accessors", "an accessor", type); }

constexpr Rule sparse_indices_rules[] = {required(view("bufferView")), required(integer("componentType")),
                                         integer("byteOffset")};
constexpr Object sparse_indices{sparse_indices_rules};
constexpr Rule sparse_values_rules[] = {required(view("bufferView")), integer("byteOffset")};
constexpr Object sparse_values{sparse_values_rules};
constexpr Rule sparse_rules[] = {required(integer("count")), required(has("indices", sparse_indices)),
                                 required(has("values", sparse_values))};
constexpr Object sparse{sparse_rules};
constexpr std::string_view accessor_types[] = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
constexpr Rule accessor_rules[] = {
    view("bufferView"), integer("byteOffset"),      required(integer("componentType")),
    flag("normalized"), required(integer("count")), required(choice("type", accessor_types)),
    numbers("min", 0),  numbers("max", 0),          has("sparse", sparse),
    text("name")};
constexpr Object accessor_object{accessor_rules};

constexpr std::string_view meshopt_modes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
constexpr std::string_view meshopt_filters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
constexpr Rule meshopt_rules[] = {required(refers("buffer", "buffers", "a buffer")),
                                  integer("byteOffset"),
                                  required(integer("byteLength", 1)),
                                  required(integer("byteStride", 1)),
                                  required(integer("count", 1)),
                                  required(choice("mode", meshopt_modes)),
                                  choice("filter", meshopt_filters)};
constexpr Object meshopt{meshopt_rules};
constexpr Rule view_extension_rules[] = {has("EXT_meshopt_compression", meshopt)};
constexpr Object view_extensions{view_extension_rules};
constexpr Rule view_rules[] = {required(refers("buffer", "buffers", "a buffer")),
                               integer("byteOffset"),
                               required(integer("byteLength")),
                               integer("byteStride"),
                               integer("target"),
                               text("name"),
                               has("extensions", view_extensions)};
constexpr Object view_object{view_rules};
constexpr Object anything{};
constexpr Rule buffer_rules[] = {required(integer("byteLength", 1)), text("uri"), text("name"),
                                 has("extensions", anything)};
constexpr Object buffer{buffer_rules};

constexpr Rule perspective_rules[] = {required(number("yfov")), required(number("znear")), number("zfar"),
                                      number("aspectRatio")};
constexpr Object perspective{perspective_rules};
constexpr Rule orthographic_rules[] = {required(number("xmag")), required(number("ymag")), required(number("znear")),
                                       required(number("zfar"))};
constexpr Object orthographic{orthographic_rules};
constexpr std::string_view camera_types[] = {"perspective", "orthographic"};
constexpr Rule camera_rules[] = {required(choice("type", camera_types)), has("perspective", perspective),
                                 has("orthographic", orthographic), text("name")};
constexpr Object camera{camera_rules};

// A texture or image that cannot be had costs a warning and no more, so views of images are not looked up here.
constexpr Rule image_rules[] = {text("uri"), integer("bufferView"), text("mimeType"), text("name")};
constexpr Object image_object{image_rules};
constexpr Rule source_rules[] = {required(image("source"))};
constexpr Object source{source_rules};
constexpr Rule texture_extension_rules[] = {has("EXT_texture_webp", source)};
constexpr Object texture_extensions{texture_extension_rules};
constexpr Rule texture_rules[] = {refers("sampler", "samplers", "a sampler"), image("source"), text("name"),
                                  has("extensions", texture_extensions)};
constexpr Object texture{texture_rules};
constexpr Rule sampler_rules[] = {integer("wrapS"), integer("wrapT"), integer("magFilter"), integer("minFilter"),
                                  text("name")};
constexpr Object sampler{sampler_rules};

constexpr Rule transform_rules[] = {numbers("offset", 2), number("rotation"), numbers("scale", 2), integer("texCoord")};
constexpr Object transform{transform_rules};
constexpr Rule info_extension_rules[] = {has("KHR_texture_transform", transform)};
constexpr Object info_extensions{info_extension_rules};
constexpr Rule info_rules[] = {required(refers("index", "textures", "a texture")), integer("texCoord"), number("scale"),
                               number("strength"), has("extensions", info_extensions)};
constexpr Object info{info_rules};
constexpr Rule pbr_rules[] = {numbers("baseColorFactor", 4), has("baseColorTexture", info), number("metallicFactor"),
                              number("roughnessFactor"), has("metallicRoughnessTexture", info)};
constexpr Object pbr{pbr_rules};
constexpr Rule strength_rules[] = {number("emissiveStrength")};
constexpr Object strength{strength_rules};
constexpr Rule ior_rules[] = {number("ior")};
constexpr Object ior{ior_rules};
constexpr Rule transmission_rules[] = {number("transmissionFactor"), has("transmissionTexture", anything)};
constexpr Object transmission{transmission_rules};
constexpr Rule volume_rules[] = {number("thicknessFactor"), number("attenuationDistance"),
                                 numbers("attenuationColor", 3), has("thicknessTexture", anything)};
constexpr Object volume{volume_rules};
constexpr Rule gloss_rules[] = {numbers("diffuseFactor", 4), has("diffuseTexture", info), numbers("specularFactor", 3),
                                number("glossinessFactor"), has("specularGlossinessTexture", anything)};
constexpr Object gloss{gloss_rules};
constexpr Rule material_extension_rules[] = {
    has("KHR_materials_emissive_strength", strength), has("KHR_materials_ior", ior),
    has("KHR_materials_transmission", transmission), has("KHR_materials_volume", volume),
    has("KHR_materials_pbrSpecularGlossiness", gloss)};
constexpr Object material_extensions{material_extension_rules};
constexpr std::string_view alpha_modes[] = {"OPAQUE", "MASK", "BLEND"};
constexpr Rule material_rules[] = {has("pbrMetallicRoughness", pbr),
                                   has("normalTexture", info),
                                   has("occlusionTexture", info),
                                   has("emissiveTexture", info),
                                   numbers("emissiveFactor", 3),
                                   choice("alphaMode", alpha_modes),
                                   number("alphaCutoff"),
                                   flag("doubleSided"),
                                   text("name"),
                                   has("extensions", material_extensions)};
constexpr Object material{material_rules};

constexpr Rule draco_attribute_rule() {
    Rule rule{"attributes", Type::index_map, true, 0};
    return rule;
}
constexpr Rule draco_rules[] = {required(view("bufferView")), draco_attribute_rule()};
constexpr Object draco{draco_rules};
constexpr Rule primitive_extension_rules[] = {has("KHR_draco_mesh_compression", draco)};
constexpr Object primitive_extensions{primitive_extension_rules};
constexpr Rule mode_rule{"mode", Type::integer, false, 0, 6};
constexpr Rule primitive_rules[] = {required(accessors("attributes", Type::index_map)),
                                    accessor("indices"),
                                    refers("material", "materials", "a material"),
                                    mode_rule,
                                    accessors("targets", Type::index_maps),
                                    has("extensions", primitive_extensions)};
constexpr Object primitive{primitive_rules};
constexpr Rule mesh_rules[] = {required(has("primitives", primitive, Type::objects)), numbers("weights", 0),
                               text("name")};
constexpr Object mesh{mesh_rules};

constexpr Rule instancing_rules[] = {required(accessors("attributes", Type::index_map))};
constexpr Object instancing{instancing_rules};
constexpr Rule node_light_rules[] = {required(refers("light", "lights", "a light"))};
constexpr Object node_light{node_light_rules};
constexpr Rule visibility_rules[] = {flag("visible")};
constexpr Object visibility{visibility_rules};
constexpr Rule node_extension_rules[] = {has("EXT_mesh_gpu_instancing", instancing),
                                         has("KHR_lights_punctual", node_light),
                                         has("KHR_node_visibility", visibility)};
constexpr Object node_extensions{node_extension_rules};
constexpr Rule node_rules[] = {refers("children", "nodes", "a node", Type::indices),
                               refers("camera", "cameras", "a camera"),
                               refers("mesh", "meshes", "a mesh"),
                               refers("skin", "skins", "a skin"),
                               numbers("matrix", 16),
                               numbers("translation", 3),
                               numbers("rotation", 4),
                               numbers("scale", 3),
                               numbers("weights", 0),
                               text("name"),
                               has("extensions", node_extensions)};
constexpr Object node{node_rules};
constexpr Rule scene_rules[] = {refers("nodes", "nodes", "a node", Type::indices), text("name")};
constexpr Object scene{scene_rules};
constexpr Rule skin_rules[] = {required(refers("joints", "nodes", "a node", Type::indices)),
                               accessor("inverseBindMatrices"), refers("skeleton", "nodes", "a node"), text("name")};
constexpr Object skin{skin_rules};

constexpr Rule spot_rules[] = {not_negative("innerConeAngle"), not_negative("outerConeAngle")};
constexpr Object spot{spot_rules};
constexpr std::string_view light_types[] = {"point", "spot", "directional"};
constexpr Rule light_rules[] = {required(choice("type", light_types)),
                                numbers("color", 3),
                                number("intensity"),
                                number("range"),
                                has("spot", spot),
                                text("name")};
constexpr Object light{light_rules};
constexpr Rule lights_rules[] = {required(has("lights", light, Type::objects))};
constexpr Object lights{lights_rules};
constexpr Rule document_extension_rules[] = {has("KHR_lights_punctual", lights)};
constexpr Object document_extensions{document_extension_rules};

constexpr Rule extension_names(std::string_view name) { return {name, Type::strings}; }
constexpr Rule document_rules[] = {extension_names("extensionsUsed"),
                                   extension_names("extensionsRequired"),
                                   has("extensions", document_extensions),
                                   has("accessors", accessor_object, Type::objects),
                                   has("bufferViews", view_object, Type::objects),
                                   has("buffers", buffer, Type::objects),
                                   has("cameras", camera, Type::objects),
                                   has("images", image_object, Type::objects),
                                   has("textures", texture, Type::objects),
                                   has("samplers", sampler, Type::objects),
                                   has("materials", material, Type::objects),
                                   has("meshes", mesh, Type::objects),
                                   has("nodes", node, Type::objects),
                                   has("scenes", scene, Type::objects),
                                   has("skins", skin, Type::objects),
                                   has("animations", anything, Type::objects),
                                   refers("scene", "scenes", "a scene")};

}  // namespace

constinit const Object document{document_rules};

}  // namespace raycache::tracer::gltf_schema
