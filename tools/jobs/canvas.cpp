#include "tools/jobs/canvas.hpp"

#include <algorithm>

#include "tools/jobs/pixel_font.hpp"

namespace raycache::tools {

namespace {
constexpr Colour white{255, 255, 255}, black{0, 0, 0};
}

Canvas::Canvas(unsigned width, unsigned height)
    : image_{width, height, std::vector<Colour>(std::size_t{width} * height, white)} {}

void Canvas::fill(unsigned x, unsigned y, unsigned width, unsigned height, Colour colour) {
    for (unsigned row = y; row < std::min(y + height, image_.height); ++row)
        for (unsigned column = x; column < std::min(x + width, image_.width); ++column)
            image_.pixels[std::size_t{row} * image_.width + column] = colour;
}

void Canvas::outline(unsigned x, unsigned y, unsigned width, unsigned height, Colour colour) {
    fill(x, y, width, 1, colour);
    fill(x, y + height - 1, width, 1, colour);
    fill(x, y, 1, height, colour);
    fill(x + width - 1, y, 1, height, colour);
}

void Canvas::text(unsigned x, unsigned y, const std::string& text, unsigned scale) {
    for (const char c : text) {
        const auto& columns = glyph(c);
        for (unsigned column = 0; column < columns.size(); ++column)
            for (unsigned row = 0; row < 8; ++row)
                if (columns[column] >> row & 1) fill(x + column * scale, y + row * scale, scale, scale, black);
        x += glyph_width * scale;
    }
}

unsigned Canvas::text_width(const std::string& text, unsigned scale) {
    return static_cast<unsigned>(text.size()) * glyph_width * scale;
}

std::vector<std::string> Canvas::lines(const std::string& text, unsigned scale, unsigned width) {
    const std::size_t most = std::max(1u, width / (glyph_width * scale));
    std::vector<std::string> lines;
    for (std::string rest = text;;) {
        if (rest.size() <= most) {
            lines.push_back(rest);
            return lines;
        }
        const std::size_t space = rest.rfind(' ', most);
        const bool between = space != std::string::npos && space > 0;
        lines.push_back(rest.substr(0, between ? space : most));
        rest.erase(0, between ? space + 1 : most);
    }
}

}  // namespace raycache::tools
