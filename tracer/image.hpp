// Images: decode a texture, write a picture or a map of numbers. OpenImageIO, behind image_codec.hpp, does the work.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tracer/vec.hpp"

namespace raycache::tracer {

/// 8-bit RGBA texels, rows top to bottom; colour is sRGB-encoded as glTF's baseColorTexture is.
struct Texture {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;  ///< 4 * width * height
    std::string name;                ///< for messages
};

/// Decodes a PNG, JPEG or WebP file held in memory. Grey becomes RGB, missing alpha 255. Throws Error naming `name`.
Texture decode_image(std::span<const std::uint8_t> bytes, const std::string& name);

struct ImageSize {
    std::uint32_t width = 0, height = 0;
};

/// What decode_image() would give, from the file's header alone. Throws as it does.
ImageSize image_size(std::span<const std::uint8_t> bytes, const std::string& name);

/// Linear RGB, rows top to bottom.
struct Image {
    std::uint32_t width = 0, height = 0;
    std::vector<Vec3> pixels;
};

/// Writes by extension: .exr and .hdr keep linear floats; .png and .jpg are tone mapped (exposure in stops, then a
/// filmic curve, then sRGB). Throws UsageError for another extension (before rendering: see check_image_name), Error
/// when the file cannot be written. No partial file stays behind.
void write_image(const std::string& path, const Image&, float exposure_stops = 0);

/// Colours of a screen, sRGB, rows top to bottom.
struct ScreenImage {
    std::uint32_t width = 0, height = 0;
    std::vector<std::array<std::uint8_t, 3>> pixels;
};
/// Writes a .png as it is. Throws as write_image() does.
void write_screen_image(const std::string& path, const ScreenImage&);

/// Numbers by pixel, rows top to bottom.
struct Channel {
    std::string name;  ///< "layer.channel" or "channel"
    std::vector<float> values;
};
using TextAttributes = std::vector<std::pair<std::string, std::string>>;  ///< name, text
/// Writes an .exr of 32-bit floats. Throws as write_image() does.
void write_channels(const std::string& path, std::uint32_t width, std::uint32_t height, const std::vector<Channel>&,
                    const TextAttributes& = {});

struct ChannelFile {
    std::uint32_t width = 0, height = 0;
    std::vector<Channel> channels;
    TextAttributes attributes;
};
/// Reads an .exr of floats with the attributes of these names; one that the file lacks is empty. `check`, if any, gets
/// the file as its header describes it, channels without values, and throws where that is not wanted: before anything
/// of the header's size is allocated. Throws Error where the file is missing, damaged or something else, also one whose
/// channels are not all 32-bit floats of one flat picture.
ChannelFile read_channels(const std::string& path, const std::vector<std::string>& attributes,
                          const std::function<void(const ChannelFile&)>& check = {});

/// Whether write_image() tone maps what it writes under that name. Throws UsageError for an extension it does not know.
bool is_tone_mapped(const std::string& path);

/// Throws UsageError unless write_image() knows the extension of `path`, Error if nothing can be written at all.
void check_image_name(const std::string& path);

}  // namespace raycache::tracer
