// The module libraycache_images.so: ImageCodec by OpenImageIO. Needs nothing of the program's but the header.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <memory>

#include "tracer/image_codec.hpp"
#include "tracer/image_module/webp.hpp"

namespace raycache::tracer {

namespace {

const char* format_name(ImageFormat format) {
    switch (format) {
        case ImageFormat::png:
            return "png";
        case ImageFormat::jpeg:
            return "jpeg";
        case ImageFormat::webp:
            return "webp";
        case ImageFormat::exr:
            return "openexr";
        case ImageFormat::hdr:
            break;
    }
    return "hdr";
}

/// A name with the extension by which OpenImageIO knows the format.
std::string file_name(ImageFormat format) {
    return std::string("memory.") + (format == ImageFormat::exr ? "exr" : format_name(format));
}

/// A file in memory, opened: its header is read.
struct OpenedImage {
    OIIO::Filesystem::IOMemReader memory;  // outlives `input`
    std::unique_ptr<OIIO::ImageInput> input;
    OIIO::ImageSpec spec;
    std::string problem;

    OpenedImage(std::span<const std::uint8_t> bytes, ImageFormat format)
        : memory(bytes.data(), bytes.size()), input(OIIO::ImageInput::create(format_name(format))) {
        OIIO::ImageSpec config;
        config.attribute("oiio:UnassociatedAlpha", 1);  // glTF's colours are not multiplied by alpha
        if (!input)
            problem = said(OIIO::geterror());
        else if (!input->set_ioproxy(&memory) || !input->open(file_name(format), spec, config))
            problem = said(input->geterror());
    }

    /// Never empty.
    static std::string said(const std::string& error) { return error.empty() ? "no reason given" : error; }
};

class OpenImageIo final : public ImageCodec {
public:
    std::string read_layout(std::span<const std::uint8_t> bytes, ImageFormat format,
                            ImageLayout& layout) const override {
        if (format == ImageFormat::webp) return webp_layout(bytes, layout);
        const OpenedImage image(bytes, format);
        if (!image.problem.empty()) return image.problem;
        layout.width = image.spec.width;
        layout.height = image.spec.height;
        layout.channels = image.spec.nchannels;
        layout.floats = image.spec.format == OIIO::TypeDesc::FLOAT;
        layout.flat = image.spec.depth <= 1 && !image.spec.deep &&
                      std::all_of(image.spec.channelformats.begin(), image.spec.channelformats.end(),
                                  [&](const OIIO::TypeDesc& type) { return type == image.spec.format; });
        layout.channel_names = image.spec.channelnames;
        for (auto& [name, text] : layout.attributes) text = std::string(image.spec.get_string_attribute(name));
        return {};
    }

    std::string read_texels(std::span<const std::uint8_t> bytes, ImageFormat format, int channels, bool floats,
                            void* out, std::size_t stride) const override {
        if (format == ImageFormat::webp) return webp_texels(bytes, channels, floats, out, stride);
        const OpenedImage image(bytes, format);
        if (!image.problem.empty()) return image.problem;
        if (image.input->read_image(0, 0, 0, channels, floats ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8, out,
                                    static_cast<OIIO::stride_t>(stride)))
            return {};
        return OpenedImage::said(image.input->geterror());
    }

    std::string encode(ImageFormat format, const ImageLayout& layout, const void* texels,
                       std::vector<unsigned char>& out) const override {
        const OIIO::TypeDesc type = layout.floats ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8;
        OIIO::ImageSpec spec(layout.width, layout.height, layout.channels, type);
        for (const auto& [name, text] : layout.attributes) spec.attribute(name, text);
        if (!layout.channel_names.empty()) spec.channelnames = layout.channel_names;
        const auto output = OIIO::ImageOutput::create(format_name(format));
        if (!output) return OpenedImage::said(OIIO::geterror());
        std::vector<unsigned char> bytes;
        OIIO::Filesystem::IOVecOutput memory(bytes);
        if (!output->set_ioproxy(&memory) || !output->open(file_name(format), spec) ||
            !output->write_image(type, texels) || !output->close())
            return OpenedImage::said(output->geterror());
        out.insert(out.end(), bytes.begin(), bytes.end());
        return {};
    }
};

}  // namespace

}  // namespace raycache::tracer

extern "C" __attribute__((visibility("default"))) const raycache::tracer::ImageCodec* raycache_image_codec() {
    static const raycache::tracer::OpenImageIo codec;
    return &codec;
}
