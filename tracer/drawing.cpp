#include "tracer/drawing.hpp"

#include "tracer/image_codec.hpp"
#include "tracer/image_module/painter.hpp"
#include "traces/error.hpp"

namespace raycache::tracer {
namespace {

const Painter& painter() {
    static const Painter* const only = [] {
        const auto* const found = reinterpret_cast<const Painter* (*)()>(image_module_symbol("raycache_painter"))();
        if (found->text_width("n", 16) < 0)
            throw Error(
                "labels of pictures: expected the font DejaVuSans.ttf in a folder of fonts or in $OPENIMAGEIO_FONTS, "
                "found none; install it (Debian: fonts-dejavu-core)");
        return found;
    }();
    return *only;
}

}  // namespace

std::unique_ptr<Drawing> make_drawing(int width, int height) { return painter().drawing(width, height); }

int text_width(const std::string& line, int pixels_high) { return painter().text_width(line, pixels_high); }

void check_drawing() { painter(); }

}  // namespace raycache::tracer
