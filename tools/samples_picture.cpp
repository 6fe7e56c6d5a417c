#include "tools/samples_picture.hpp"

#include <algorithm>
#include <cmath>

#include "tools/canvas.hpp"
#include "tools/pixel_font.hpp"

namespace raycache::tools {

namespace {

constexpr unsigned side = 480, margin = 24, text_scale = 2, line = glyph_height * text_scale + 2;
constexpr unsigned panel_height = 2 * line + side + margin, panel_width = side + margin;
constexpr Colour hole{255, 205, 205}, frame{90, 90, 90};

unsigned to_pixel(std::uint32_t u) { return static_cast<unsigned>((std::uint64_t{u} * side) >> 32); }

/// A bit per pixel of the panel, row by row: does a window around a base point reach it?
std::vector<bool> covered(const SamplePanel& panel) {
    std::vector<bool> reached(std::size_t{side} * side);
    const double half = panel.mu / 2;
    const auto near = [half](double at, std::uint32_t centre) {
        const double distance = std::fabs(at - static_cast<double>(centre) * 0x1p-32);
        return std::min(distance, 1 - distance) <= half;
    };
    for (unsigned y = 0; y < side; ++y) {
        std::vector<const tracer::FixedPoint2*> of_row;
        for (const tracer::FixedPoint2& p : panel.base)
            if (near((y + 0.5) / side, p.y)) of_row.push_back(&p);
        for (unsigned x = 0; x < side; ++x)
            reached[std::size_t{y} * side + x] =
                std::any_of(of_row.begin(), of_row.end(), [&](const auto* p) { return near((x + 0.5) / side, p->x); });
    }
    return reached;
}

void draw(Canvas& canvas, unsigned left, unsigned top, const SamplePanel& panel, std::uint64_t n) {
    canvas.text(left, top, panel.title, text_scale);
    canvas.text(left, top + line, panel.subtitle, text_scale);
    const unsigned y0 = top + 2 * line;
    if (panel.mu < 1) {
        const std::vector<bool> reached = covered(panel);
        for (unsigned y = 0; y < side; ++y)
            for (unsigned x = 0; x < side; ++x)  // the y axis points up
                if (!reached[std::size_t{y} * side + x]) canvas.fill(left + x, y0 + side - 1 - y, 1, 1, hole);
    }
    const unsigned dot = panel.points.size() < 1000 ? 5 : panel.points.size() < 100000 ? 2 : 1;
    for (std::size_t i = 0; i < panel.points.size(); ++i) {
        const unsigned x = std::min(to_pixel(panel.points[i].x), side - dot);
        const unsigned y = std::min(side - 1 - to_pixel(panel.points[i].y), side - dot);
        canvas.fill(left + x, y0 + y, dot, dot,
                    viridis(0.9 * static_cast<double>(panel.index[i]) / static_cast<double>(n)));
    }
    canvas.outline(left, y0, side, side, frame);
}

}  // namespace

tracer::ScreenImage draw_samples(const std::vector<SamplePanel>& panels, std::uint64_t n) {
    const auto columns = static_cast<unsigned>(std::min<std::size_t>(2, panels.size()));
    const auto rows = static_cast<unsigned>((panels.size() + columns - 1) / columns);
    Canvas canvas(margin + columns * panel_width, margin + rows * panel_height);
    for (unsigned i = 0; i < panels.size(); ++i)
        draw(canvas, margin + i % columns * panel_width, margin + i / columns * panel_height, panels[i], n);
    return canvas.image();
}

}  // namespace raycache::tools
