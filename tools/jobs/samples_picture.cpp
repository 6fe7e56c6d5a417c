#include "tools/jobs/samples_picture.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/jobs/canvas.hpp"
#include "tools/jobs/pixel_font.hpp"

namespace raycache::tools {
namespace {

constexpr unsigned margin = 20, panel = 512, text_scale = 2, line = glyph_height * text_scale + 4;
constexpr unsigned cross = 3;  ///< pixels from the middle of a base point's cross to its ends

unsigned place(std::uint32_t u) { return static_cast<unsigned>(std::uint64_t{u} * panel >> 32); }

/// Neighbouring indices lie far apart in a low-discrepancy sequence; a stride through the colours keeps them apart too.
Colour colour_of(std::size_t sample) {
    constexpr double golden = 0.6180339887498949;
    const double at = golden * static_cast<double>(sample);
    return viridis(0.95 * (at - static_cast<double>(static_cast<std::size_t>(at))));
}

std::string caption(const SampleUnion& u) {
    const std::string mu = u.mu ? fmt::format("mu {:.4g}", *u.mu) : "no window";
    if (u.mu == 0.0) return mu + ": all pixels alike";
    if (!u.density) return mu;
    return fmt::format("{}, holes {:.1f} %, density {:.2g} to {:.2g}", mu, 100 * u.density->holes(), u.density->min,
                       u.density->max);
}

void draw_panel(Canvas& canvas, unsigned left, unsigned top, const SampleUnion& u) {
    const unsigned size = u.points.size() > 200'000 ? 1 : 2;
    const auto dot = [&](const tracer::FixedPoint2& p, unsigned width, unsigned height, Colour colour) {
        const unsigned x = place(p.x), y = panel - 1 - place(p.y);
        const unsigned x0 = x - std::min(x, width / 2), y0 = y - std::min(y, height / 2);
        canvas.fill(left + x0, top + y0, std::min(width, panel - x0), std::min(height, panel - y0), colour);
    };
    for (std::size_t i = 0; i < u.points.size(); ++i) dot(u.points[i], size, size, colour_of(i % u.base.size()));
    for (const tracer::FixedPoint2& p : u.base) {
        dot(p, 2 * cross + 1, 1, {0, 0, 0});
        dot(p, 1, 2 * cross + 1, {0, 0, 0});
    }
    canvas.outline(left - 1, top - 1, panel + 2, panel + 2, {0, 0, 0});
}

}  // namespace

tracer::ScreenImage draw_samples(const std::string& title, const std::vector<SamplesPanel>& panels) {
    const auto columns = static_cast<unsigned>(std::min<std::size_t>(2, panels.size()));
    const auto rows = static_cast<unsigned>((panels.size() + columns - 1) / columns);
    const unsigned row_height = panel + 2 * line + margin, head = margin + 2 * line;
    unsigned width = margin + columns * (panel + margin);
    width = std::max(width, 2 * margin + Canvas::text_width(title, text_scale));
    Canvas canvas(width, head + rows * row_height);
    canvas.text(margin, margin, title, text_scale);
    for (std::size_t i = 0; i < panels.size(); ++i) {
        const auto column = static_cast<unsigned>(i % columns), row = static_cast<unsigned>(i / columns);
        const unsigned x = margin + column * (panel + margin), y = head + row * row_height;
        canvas.text(x, y, panels[i].title, text_scale);
        draw_panel(canvas, x, y + line, *panels[i].samples);
        canvas.text(x, y + line + panel + 4, caption(*panels[i].samples), text_scale);
    }
    return canvas.image();
}

}  // namespace raycache::tools
