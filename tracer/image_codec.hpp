// What OpenImageIO does for image.hpp: headers, texels, encoding. It stands in a module of its own
// (image_module/open_image_io.cpp), loaded when the first image is read or written: the 250 libraries that Debian's
// OpenImageIO brings take the dynamic linker a third of a second, which commands without images need not wait.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace raycache::tracer {

enum class ImageFormat { png, jpeg, webp, exr, hdr };

struct ImageLayout {
    int width = 0, height = 0, channels = 0;
    bool floats = false;                                          ///< 32-bit floats; else 8-bit
    std::vector<std::string> channel_names;                       ///< one per channel, or none: the format's own
    std::vector<std::pair<std::string, std::string>> attributes;  ///< name, text
    bool flat = true;  ///< one plane, its channels alike: neither deep nor 3D
};

/// Every function returns what is wrong, in OpenImageIO's words, or nothing. Rows go top to bottom, channels of a pixel
/// stand together.
class ImageCodec {
public:
    virtual ~ImageCodec() = default;

    /// From the header. Of the attributes only those that `layout` names on entry; one that the file lacks is empty.
    virtual std::string read_layout(std::span<const std::uint8_t> bytes, ImageFormat, ImageLayout& layout) const = 0;
    /// The first `channels` channels as 8-bit numbers (not multiplied by alpha), or as floats. From one pixel of `out`
    /// to the next: `stride` bytes.
    virtual std::string read_texels(std::span<const std::uint8_t> bytes, ImageFormat, int channels, bool floats,
                                    void* out, std::size_t stride) const = 0;
    /// Appends nothing to `out` unless it succeeds.
    virtual std::string encode(ImageFormat, const ImageLayout&, const void* texels,
                               std::vector<unsigned char>& out) const = 0;
};

/// Loads the module at the first call. Throws Error where it cannot.
const ImageCodec& image_codec();

/// A function of the module by its name; drawing.hpp is built on it.
void* image_module_symbol(const char* name);

}  // namespace raycache::tracer
