// The module libraycache_images.so: Painter by OpenImageIO's ImageBufAlgo.
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <cmath>
#include <vector>

#include "tracer/image_module/painter.hpp"

namespace raycache::tracer {
namespace {

namespace Algo = OIIO::ImageBufAlgo;
using OIIO::ImageBuf, OIIO::ImageSpec, OIIO::ROI, OIIO::TypeDesc;

/// A file of that name in a font folder; not the library's own choice, which depends on the machine.
constexpr const char* font = "DejaVuSans";
/// From the top of a line to its base line, of the height of the font: capitals are 0.73 high.
constexpr double ascent = 0.85;

ImageSpec rgb(int width, int height) { return {width, height, 3, TypeDesc::UINT8}; }

std::vector<float> floats(std::span<const Colour> colours) {
    std::vector<float> out;
    for (const Colour& colour : colours)
        for (const std::uint8_t channel : colour) out.push_back(static_cast<float>(channel) / 255.0F);
    return out;
}

class OpenImageIoDrawing final : public Drawing {
public:
    OpenImageIoDrawing(int width, int height) : picture_(rgb(width, height)) {
        Algo::fill(picture_, {1.0F, 1.0F, 1.0F});
    }

    void text(int x, int y, const std::string& line, int pixels_high, TextAlign align) override {
        const auto side = align == TextAlign::left     ? Algo::TextAlignX::Left
                          : align == TextAlign::centre ? Algo::TextAlignX::Center
                                                       : Algo::TextAlignX::Right;
        Algo::render_text(picture_, x, y + static_cast<int>(std::lround(ascent * pixels_high)), line, pixels_high, font,
                          {0.0F, 0.0F, 0.0F}, side, Algo::TextAlignY::Baseline);
    }

    void frame(int x, int y, int width, int height, Colour colour) override {
        Algo::render_box(picture_, x, y, x + width - 1, y + height - 1, floats({&colour, 1}), false);
    }

    void paste(int x, int y, const ScreenImage& other) override {
        ScreenImage copy = other;  // ImageBuf does not take memory that it may not write to
        const ImageBuf pixels(rgb(static_cast<int>(other.width), static_cast<int>(other.height)), copy.pixels.data());
        Algo::paste(picture_, x, y, 0, 0, pixels);
    }

    void map(int x, int y, int width, std::span<const float> shares, std::span<const Colour> colours) override {
        const int height = static_cast<int>(shares.size()) / width;
        std::vector<float> numbers(shares.begin(), shares.end());
        const ImageBuf source(ImageSpec(width, height, 1, TypeDesc::FLOAT), numbers.data());
        ImageBuf mapped(rgb(width, height));
        Algo::color_map(mapped, source, 0, static_cast<int>(colours.size()), 3, floats(colours));
        const std::vector<float> grey = floats({&no_value, 1});
        for (ImageBuf::Iterator<std::uint8_t> pixel(mapped); !pixel.done(); ++pixel)
            if (std::isnan(numbers[static_cast<std::size_t>(pixel.y()) * width + pixel.x()]))
                for (int c = 0; c < 3; ++c) pixel[c] = grey[c];
        Algo::paste(picture_, x, y, 0, 0, mapped);
    }

    ScreenImage image() const override {
        const ImageSpec& spec = picture_.spec();
        ScreenImage out{static_cast<std::uint32_t>(spec.width), static_cast<std::uint32_t>(spec.height), {}};
        out.pixels.resize(std::size_t{out.width} * out.height);
        picture_.get_pixels(picture_.roi(), TypeDesc::UINT8, out.pixels.data());
        return out;
    }

private:
    ImageBuf picture_;
};

class OpenImageIoPainter final : public Painter {
public:
    std::unique_ptr<Drawing> drawing(int width, int height) const override {
        return std::make_unique<OpenImageIoDrawing>(width, height);
    }
    int text_width(const std::string& line, int pixels_high) const override {
        const ROI roi = Algo::text_size(line, pixels_high, font);
        if (!roi.defined()) return line.empty() ? 0 : -1;
        return roi.xend > roi.xbegin ? roi.width() : 0;  // blanks alone: a region inside out
    }
};

}  // namespace
}  // namespace raycache::tracer

extern "C" __attribute__((visibility("default"))) const raycache::tracer::Painter* raycache_painter() {
    static const raycache::tracer::OpenImageIoPainter painter;
    return &painter;
}
