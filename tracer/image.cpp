#include "tracer/image.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <iterator>
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

[[noreturn]] void fail_to_encode(const std::string& path, const std::string& why) {
    throw Error(fmt::format("{}: cannot encode the image ({}); choose another format", path, first_line(why)));
}

void check_size(const std::string& path, std::uint32_t width, std::uint32_t height, std::size_t pixels) {
    if (width == 0 || height == 0 || width > 65535 || height > 65535 || pixels != std::size_t{width} * height)
        throw Error(
            fmt::format("{}: expected an image of 1 to 65535 pixels on each side, found {} x {} with {} pixels; "
                        "choose another size",
                        path, width, height, pixels));
}

/// Encodes in memory, which leaves nothing on the disk when it fails, then writes the file.
void write_encoded(const std::string& path, const char* format, const OIIO::ImageSpec& spec, const OIIO::TypeDesc& type,
                   const void* texels) {
    const auto output = OIIO::ImageOutput::create(format);
    if (!output) fail_to_encode(path, OIIO::geterror());
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    if (!output->set_ioproxy(&memory) || !output->open(std::string("memory.") + format, spec) ||
        !output->write_image(type, texels) || !output->close())
        fail_to_encode(path, output->geterror());
    traces::OutputFile file(path);
    file.write(std::span<const std::uint8_t>(bytes));
    file.commit();
}

OIIO::ImageSpec spec_of(std::uint32_t width, std::uint32_t height, int channels, const OIIO::TypeDesc& type) {
    OIIO::ImageSpec spec(static_cast<int>(width), static_cast<int>(height), channels, type);
    spec.attribute("DateTime", "");  // else the time of day: the same picture would give other bytes
    return spec;
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
    check_size(path, image.width, image.height, image.pixels.size());
    if (kind == FileKind::exr || kind == FileKind::hdr) {
        OIIO::ImageSpec spec = spec_of(image.width, image.height, 3, OIIO::TypeDesc::FLOAT);
        if (kind == FileKind::exr) spec.attribute("compression", "zip");
        return write_encoded(path, kind == FileKind::exr ? "openexr" : "hdr", spec, OIIO::TypeDesc::FLOAT,
                             image.pixels.data());
    }
    std::vector<std::array<std::uint8_t, 3>> screen;
    screen.reserve(image.pixels.size());
    for (const Vec3 pixel : image.pixels) screen.push_back(tone_map(pixel, exposure_stops));
    OIIO::ImageSpec spec = spec_of(image.width, image.height, 3, OIIO::TypeDesc::UINT8);
    if (kind == FileKind::jpeg) spec.attribute("Compression", "jpeg:95");
    spec.attribute("oiio:ColorSpace", "sRGB");
    write_encoded(path, kind == FileKind::png ? "png" : "jpeg", spec, OIIO::TypeDesc::UINT8, screen.data());
}

void write_screen_image(const std::string& path, const ScreenImage& image) {
    check_size(path, image.width, image.height, image.pixels.size());
    OIIO::ImageSpec spec = spec_of(image.width, image.height, 3, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    write_encoded(path, "png", spec, OIIO::TypeDesc::UINT8, image.pixels.data());
}

void write_channels(const std::string& path, std::uint32_t width, std::uint32_t height,
                    const std::vector<Channel>& channels, const TextAttributes& attributes) {
    OIIO::ImageSpec spec = spec_of(width, height, static_cast<int>(channels.size()), OIIO::TypeDesc::FLOAT);
    spec.attribute("compression", "zip");
    for (const auto& [name, text] : attributes) spec.attribute(name, text);
    std::vector<float> interleaved(std::size_t{width} * height * channels.size());
    for (std::size_t c = 0; c < channels.size(); ++c) {
        check_size(path, width, height, channels[c].values.size());
        spec.channelnames[c] = channels[c].name;
        for (std::size_t i = 0; i < channels[c].values.size(); ++i)
            interleaved[i * channels.size() + c] = channels[c].values[i];
    }
    write_encoded(path, "openexr", spec, OIIO::TypeDesc::FLOAT, interleaved.data());
}

ChannelFile read_channels(const std::string& path, const std::vector<std::string>& attributes) {
    const auto fail = [&](const std::string& found) {
        throw Error(
            fmt::format("{}: expected a whole OpenEXR image of 32-bit floats, found {}; remove it or name "
                        "another file",
                        path, found));
    };
    std::ifstream stream(path, std::ios::binary);
    std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(stream), {}};
    if (!stream || bytes.empty()) fail("no file that can be read");
    if (!starts_with(bytes, "\x76\x2f\x31\x01")) fail("something else");
    OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
    const auto input = OIIO::ImageInput::create("openexr");
    OIIO::ImageSpec spec;
    if (!input || !input->set_ioproxy(&memory) || !input->open("memory.exr", spec))
        fail("a damaged one (" + first_line(input ? input->geterror() : OIIO::geterror()) + ")");
    if (spec.width < 1 || spec.height < 1 || spec.width > max_side || spec.height > max_side || spec.nchannels < 1 ||
        spec.nchannels > 64 || spec.format != OIIO::TypeDesc::FLOAT)
        fail("another kind of image");
    ChannelFile file{static_cast<std::uint32_t>(spec.width), static_cast<std::uint32_t>(spec.height), {}, {}};
    const std::size_t pixels = std::size_t{file.width} * file.height, count = static_cast<std::size_t>(spec.nchannels);
    std::vector<float> interleaved(pixels * count);
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, interleaved.data()))
        fail("a damaged one (" + first_line(input->geterror()) + ")");
    for (std::size_t c = 0; c < count; ++c) {
        Channel& channel = file.channels.emplace_back(Channel{spec.channelnames[c], std::vector<float>(pixels)});
        for (std::size_t i = 0; i < pixels; ++i) channel.values[i] = interleaved[i * count + c];
    }
    for (const std::string& name : attributes)
        file.attributes.emplace_back(name, std::string(spec.get_string_attribute(name)));
    return file;
}

}  // namespace raycache::tracer
