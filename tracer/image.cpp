#include "tracer/image.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <memory>
#include <optional>
#include <string_view>

#include "tracer/png_chunks.hpp"
#include "tracer/tone_map.hpp"
#include "traces/error.hpp"
#include "traces/output_file.hpp"

namespace raycache::tracer {

namespace {

/// On either side; 1 GiB of texels.
constexpr int max_side = 16384;

bool starts_with(std::span<const std::uint8_t> bytes, std::string_view magic) {
    return bytes.size() >= magic.size() &&
           std::equal(magic.begin(), magic.end(), bytes.begin(),
                      [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

/// An image file in memory, opened: its header is read and found acceptable, its texels are not decoded.
class OpenedImage {
    const std::string& name_;
    OIIO::Filesystem::IOMemReader memory_;  // outlives `input`

public:
    OpenedImage(std::span<const std::uint8_t> bytes, const std::string& name)
        : name_(name), memory_(bytes.data(), bytes.size()) {
        const bool png = starts_with(bytes, "\x89PNG\r\n\x1A\n"), jpeg = starts_with(bytes, "\xFF\xD8\xFF");
        if (!png && !jpeg)
            throw Error(fmt::format("{}: expected a PNG or JPEG image, found {} bytes of something else; convert it",
                                    name, bytes.size()));
        if (png && !is_whole_png(bytes)) fail("a chunk is cut short or has a wrong checksum");
        OIIO::ImageSpec config;
        config.attribute("oiio:UnassociatedAlpha", 1);  // glTF's colours are not multiplied by alpha
        input = OIIO::ImageInput::create(png ? "png" : "jpeg");
        if (!input) fail(OIIO::geterror());
        OIIO::ImageSpec spec;
        if (!input->set_ioproxy(&memory_) || !input->open(png ? "memory.png" : "memory.jpg", spec, config))
            fail(input->geterror());
        if (spec.width < 1 || spec.height < 1 || spec.width > max_side || spec.height > max_side || spec.nchannels < 1)
            throw Error(fmt::format("{}: expected an image of 1 to {} pixels on each side, found {} x {}; reduce it",
                                    name, max_side, spec.width, spec.height));
    }

    [[noreturn]] void fail(const std::string& why) const {
        throw Error(fmt::format("{}: expected a whole PNG or JPEG image, found a damaged one ({}); export it again",
                                name_, first_line(why)));
    }

    std::unique_ptr<OIIO::ImageInput> input;
};

enum class FileKind { png, jpeg, exr, hdr };

std::optional<FileKind> kind_of(const std::string& path) {
    const std::size_t dot = path.rfind('.');
    if (dot == std::string::npos) return std::nullopt;
    std::string extension = path.substr(dot + 1);
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (extension == "png") return FileKind::png;
    if (extension == "jpg" || extension == "jpeg") return FileKind::jpeg;
    if (extension == "exr") return FileKind::exr;
    if (extension == "hdr") return FileKind::hdr;
    return std::nullopt;
}

FileKind require_kind(const std::string& path) {
    const auto kind = kind_of(path);
    if (!kind)
        throw UsageError(
            fmt::format("{}: expected an image name that ends in .png, .jpg, .exr or .hdr, found another; "
                        "rename it",
                        path));
    return *kind;
}

/// The file's bytes. Encoding in memory leaves nothing on the disk when it fails.
std::vector<unsigned char> encode(const std::string& path, FileKind kind, const Image& image, float exposure_stops) {
    const char* format = kind == FileKind::png    ? "png"
                         : kind == FileKind::jpeg ? "jpeg"
                         : kind == FileKind::exr  ? "openexr"
                                                  : "hdr";
    const bool linear = kind == FileKind::exr || kind == FileKind::hdr;
    const auto fail = [&](const std::string& why) {
        throw Error(fmt::format("{}: cannot encode the image ({}); choose another format", path, first_line(why)));
    };
    const auto output = OIIO::ImageOutput::create(format);
    if (!output) fail(OIIO::geterror());
    OIIO::ImageSpec spec(static_cast<int>(image.width), static_cast<int>(image.height), 3,
                         linear ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
    if (kind == FileKind::exr) spec.attribute("compression", "zip");
    if (kind == FileKind::jpeg) spec.attribute("Compression", "jpeg:95");
    if (!linear) spec.attribute("oiio:ColorSpace", "sRGB");

    std::vector<std::array<std::uint8_t, 3>> screen;
    if (!linear) {
        screen.reserve(image.pixels.size());
        for (const Vec3 pixel : image.pixels) screen.push_back(tone_map(pixel, exposure_stops));
    }
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    if (!output->set_ioproxy(&memory) || !output->open(std::string("memory.") + format, spec)) fail(output->geterror());
    const bool written = linear ? output->write_image(OIIO::TypeDesc::FLOAT, image.pixels.data())
                                : output->write_image(OIIO::TypeDesc::UINT8, screen.data());
    if (!written || !output->close()) fail(output->geterror());
    return bytes;
}

}  // namespace

ImageSize image_size(std::span<const std::uint8_t> bytes, const std::string& name) {
    const OpenedImage image(bytes, name);
    const OIIO::ImageSpec& spec = image.input->spec();
    return {static_cast<std::uint32_t>(spec.width), static_cast<std::uint32_t>(spec.height)};
}

Texture decode_image(std::span<const std::uint8_t> bytes, const std::string& name) {
    const OpenedImage image(bytes, name);
    const OIIO::ImageSpec& spec = image.input->spec();
    Texture texture;
    texture.name = name;
    texture.width = static_cast<std::uint32_t>(spec.width);
    texture.height = static_cast<std::uint32_t>(spec.height);
    texture.rgba.assign(std::size_t{4} * texture.width * texture.height, 255);
    const int channels = std::min(spec.nchannels, 4);
    if (!image.input->read_image(0, 0, 0, channels, OIIO::TypeDesc::UINT8, texture.rgba.data(), 4))
        image.fail(image.input->geterror());
    if (channels <= 2) {  // grey, perhaps with alpha
        for (std::size_t i = 0; i < texture.rgba.size(); i += 4) {
            if (channels == 2) texture.rgba[i + 3] = texture.rgba[i + 1];
            texture.rgba[i + 1] = texture.rgba[i + 2] = texture.rgba[i];
        }
    }
    return texture;
}

void check_image_name(const std::string& path) { require_kind(path); }

void write_image(const std::string& path, const Image& image, float exposure_stops) {
    const FileKind kind = require_kind(path);
    if (image.width == 0 || image.height == 0 || image.width > 65535 || image.height > 65535 ||
        image.pixels.size() != std::size_t{image.width} * image.height)
        throw Error(
            fmt::format("{}: expected an image of 1 to 65535 pixels on each side, found {} x {} with {} pixels; "
                        "choose another size",
                        path, image.width, image.height, image.pixels.size()));
    const std::vector<unsigned char> bytes = encode(path, kind, image, exposure_stops);
    traces::OutputFile file(path);
    file.write(std::span<const std::uint8_t>(bytes));
    file.commit();
}

}  // namespace raycache::tracer
