#include "tracer/image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string_view>
#include <tuple>

#include "tracer/image_codec.hpp"
#include "tracer/png_chunks.hpp"
#include "tracer/tone_map.hpp"
#include "traces/error.hpp"
#include "traces/output_file.hpp"
#include "traces/regular_file.hpp"

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

[[noreturn]] void fail_to_decode(const std::string& name, const std::string& why) {
    throw Error(fmt::format("{}: expected a whole PNG, JPEG or WebP image, found a damaged one ({}); export it again",
                            name, first_line(why)));
}

struct TextureLayout {
    ImageFormat format;
    ImageLayout layout;
};

/// From the header, found acceptable.
TextureLayout texture_layout(std::span<const std::uint8_t> bytes, const std::string& name) {
    const bool png = starts_with(bytes, "\x89PNG\r\n\x1A\n"), jpeg = starts_with(bytes, "\xFF\xD8\xFF");
    const bool webp = starts_with(bytes, "RIFF") && bytes.size() > 12 && starts_with(bytes.subspan(8), "WEBP");
    if (!png && !jpeg && !webp)
        throw Error(fmt::format("{}: expected a PNG, JPEG or WebP image, found {} bytes of something else; convert it",
                                name, bytes.size()));
    if (png && !is_whole_png(bytes)) fail_to_decode(name, "a chunk is cut short or has a wrong checksum");
    TextureLayout found{png ? ImageFormat::png : jpeg ? ImageFormat::jpeg : ImageFormat::webp, {}};
    const std::string problem = image_codec().read_layout(bytes, found.format, found.layout);
    if (!problem.empty()) fail_to_decode(name, problem);
    const auto [width, height, channels] = std::tie(found.layout.width, found.layout.height, found.layout.channels);
    if (width < 1 || height < 1 || width > max_side || height > max_side || channels < 1)
        throw Error(fmt::format("{}: expected an image of 1 to {} pixels on each side, found {} x {}; reduce it", name,
                                max_side, width, height));
    return found;
}

std::optional<ImageFormat> format_of(const std::string& path) {
    const std::size_t dot = path.rfind('.');
    if (dot == std::string::npos) return std::nullopt;
    std::string extension = path.substr(dot + 1);
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (extension == "png") return ImageFormat::png;
    if (extension == "jpg" || extension == "jpeg") return ImageFormat::jpeg;
    if (extension == "exr") return ImageFormat::exr;
    if (extension == "hdr") return ImageFormat::hdr;
    return std::nullopt;
}

ImageFormat require_format(const std::string& path) {
    const auto format = format_of(path);
    if (!format)
        throw UsageError(
            fmt::format("{}: expected an image name that ends in .png, .jpg, .exr or .hdr, found another; "
                        "rename it",
                        path));
    return *format;
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
void write_encoded(const std::string& path, ImageFormat format, const ImageLayout& layout, const void* texels) {
    std::vector<unsigned char> bytes;
    const std::string problem = image_codec().encode(format, layout, texels, bytes);
    if (!problem.empty()) fail_to_encode(path, problem);
    traces::OutputFile file(path);
    file.write(std::span<const std::uint8_t>(bytes));
    file.commit();
}

ImageLayout layout_of(std::uint32_t width, std::uint32_t height, std::size_t channels, bool floats) {
    // No time of day: the same picture would give other bytes.
    return {static_cast<int>(width),
            static_cast<int>(height),
            static_cast<int>(channels),
            floats,
            {},
            {{"DateTime", ""}},
            true};
}

}  // namespace

ImageSize image_size(std::span<const std::uint8_t> bytes, const std::string& name) {
    const ImageLayout layout = texture_layout(bytes, name).layout;
    return {static_cast<std::uint32_t>(layout.width), static_cast<std::uint32_t>(layout.height)};
}

Texture decode_image(std::span<const std::uint8_t> bytes, const std::string& name) {
    const auto [format, layout] = texture_layout(bytes, name);
    Texture texture;
    texture.name = name;
    texture.width = static_cast<std::uint32_t>(layout.width);
    texture.height = static_cast<std::uint32_t>(layout.height);
    texture.rgba.assign(std::size_t{4} * texture.width * texture.height, 255);
    const int channels = std::min(layout.channels, 4);
    const std::string problem = image_codec().read_texels(bytes, format, channels, false, texture.rgba.data(), 4);
    if (!problem.empty()) fail_to_decode(name, problem);
    if (channels <= 2) {  // grey, perhaps with alpha
        for (std::size_t i = 0; i < texture.rgba.size(); i += 4) {
            if (channels == 2) texture.rgba[i + 3] = texture.rgba[i + 1];
            texture.rgba[i + 1] = texture.rgba[i + 2] = texture.rgba[i];
        }
    }
    return texture;
}

bool is_tone_mapped(const std::string& path) {
    const ImageFormat format = require_format(path);
    return format != ImageFormat::exr && format != ImageFormat::hdr;
}

void check_image_name(const std::string& path) {
    require_format(path);
    image_codec();  // may be missing
}

void write_image(const std::string& path, const Image& image, float exposure_stops) {
    const ImageFormat format = require_format(path);
    check_size(path, image.width, image.height, image.pixels.size());
    const bool floats = !is_tone_mapped(path);
    ImageLayout layout = layout_of(image.width, image.height, 3, floats);
    if (floats) {
        if (format == ImageFormat::exr) layout.attributes.emplace_back("compression", "zip");
        return write_encoded(path, format, layout, image.pixels.data());
    }
    std::vector<std::array<std::uint8_t, 3>> screen;
    screen.reserve(image.pixels.size());
    for (const Vec3 pixel : image.pixels) screen.push_back(tone_map(pixel, exposure_stops));
    if (format == ImageFormat::jpeg) layout.attributes.emplace_back("Compression", "jpeg:95");
    layout.attributes.emplace_back("oiio:ColorSpace", "sRGB");
    write_encoded(path, format, layout, screen.data());
}

void write_screen_image(const std::string& path, const ScreenImage& image) {
    check_size(path, image.width, image.height, image.pixels.size());
    ImageLayout layout = layout_of(image.width, image.height, 3, false);
    layout.attributes.emplace_back("oiio:ColorSpace", "sRGB");
    write_encoded(path, ImageFormat::png, layout, image.pixels.data());
}

void write_channels(const std::string& path, std::uint32_t width, std::uint32_t height,
                    const std::vector<Channel>& channels, const TextAttributes& attributes) {
    ImageLayout layout = layout_of(width, height, channels.size(), true);
    layout.attributes.emplace_back("compression", "zip");
    layout.attributes.insert(layout.attributes.end(), attributes.begin(), attributes.end());
    std::vector<float> interleaved(std::size_t{width} * height * channels.size());
    for (std::size_t c = 0; c < channels.size(); ++c) {
        check_size(path, width, height, channels[c].values.size());
        layout.channel_names.push_back(channels[c].name);
        for (std::size_t i = 0; i < channels[c].values.size(); ++i)
            interleaved[i * channels.size() + c] = channels[c].values[i];
    }
    write_encoded(path, ImageFormat::exr, layout, interleaved.data());
}

ChannelFile read_channels(const std::string& path, const std::vector<std::string>& attributes,
                          const std::function<void(const ChannelFile&)>& check) {
    const auto fail = [&](const std::string& found) {
        throw Error(
            fmt::format("{}: expected a whole OpenEXR image of 32-bit floats, found {}; remove it or name "
                        "another file",
                        path, found));
    };
    const std::vector<std::uint8_t> bytes = read_regular_file(path, "OpenEXR image");
    if (bytes.empty()) fail("an empty file");
    if (!starts_with(bytes, "\x76\x2f\x31\x01")) fail("something else");
    ImageLayout layout;
    for (const std::string& name : attributes) layout.attributes.emplace_back(name, "");
    const auto decoded = [&](const std::string& problem) {
        if (!problem.empty()) fail("a damaged one (" + first_line(problem) + ")");
    };
    decoded(image_codec().read_layout(bytes, ImageFormat::exr, layout));
    if (layout.width < 1 || layout.height < 1 || layout.width > max_side || layout.height > max_side)
        fail(fmt::format("{} x {} pixels", layout.width, layout.height));
    if (layout.channels < 1 || layout.channels > 64) fail(fmt::format("{} channels", layout.channels));
    if (!layout.floats || !layout.flat) fail("channels of another type");
    ChannelFile file{static_cast<std::uint32_t>(layout.width), static_cast<std::uint32_t>(layout.height), {}, {}};
    const std::size_t pixels = std::size_t{file.width} * file.height, count = static_cast<std::size_t>(layout.channels);
    for (const std::string& name : layout.channel_names) file.channels.push_back({name, {}});
    if (file.channels.size() != count) fail("channels without names");
    file.attributes = layout.attributes;
    if (check) check(file);
    std::vector<float> interleaved(pixels * count);
    decoded(image_codec().read_texels(bytes, ImageFormat::exr, layout.channels, true, interleaved.data(),
                                      count * sizeof(float)));
    for (std::size_t c = 0; c < count; ++c) {
        file.channels[c].values.resize(pixels);
        for (std::size_t i = 0; i < pixels; ++i) file.channels[c].values[i] = interleaved[i * count + c];
    }
    return file;
}

}  // namespace raycache::tracer
