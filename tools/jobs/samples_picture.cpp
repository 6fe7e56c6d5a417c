#include "tools/jobs/samples_picture.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/jobs/colour_scale.hpp"

namespace raycache::tools {
namespace {

using tracer::Colour;

constexpr int border = 20, plot_side = 512;
constexpr unsigned cross = 3;  ///< pixels from the middle of a base point's cross to its ends
constexpr Colour black{0, 0, 0};

unsigned place(std::uint32_t u) { return static_cast<unsigned>(std::uint64_t{u} * plot_side >> 32); }

/// A colour for each sample: neighbouring indices lie far apart in a low-discrepancy sequence; a stride through the
/// colours keeps them apart too.
std::vector<Colour> sample_colours(std::size_t samples) {
    constexpr double golden = 0.6180339887498949;
    std::vector<float> shares;
    for (std::size_t i = 0; i < samples; ++i) {
        const double at = golden * static_cast<double>(i);
        shares.push_back(static_cast<float>(0.95 * (at - static_cast<double>(static_cast<std::size_t>(at)))));
    }
    const auto drawing = tracer::make_drawing(static_cast<int>(samples), 1);
    drawing->map(0, 0, static_cast<int>(samples), shares, viridis());
    return drawing->image().pixels;
}

std::string caption(const SampleUnion& u) {
    const std::string mu = u.mu ? fmt::format("mu {:.4g}", *u.mu) : "no window";
    if (u.mu == 0.0) return mu + ": all pixels alike";
    if (!u.density) return mu;
    return fmt::format("{}, holes {:.1f} %, density {:.2g} to {:.2g}", mu, 100 * u.density->holes(), u.density->min,
                       u.density->max);
}

/// All points of the unit square, y upwards.
tracer::ScreenImage draw_points(const SampleUnion& u) {
    tracer::ScreenImage image{plot_side, plot_side,
                              std::vector<Colour>(std::size_t{plot_side} * plot_side, {255, 255, 255})};
    const auto dot = [&](const tracer::FixedPoint2& p, unsigned width, unsigned height, Colour colour) {
        const unsigned x = place(p.x), y = plot_side - 1 - place(p.y);
        const unsigned x0 = x - std::min(x, width / 2), y0 = y - std::min(y, height / 2);
        for (unsigned row = y0; row < std::min<unsigned>(y0 + height, plot_side); ++row)
            for (unsigned column = x0; column < std::min<unsigned>(x0 + width, plot_side); ++column)
                image.pixels[std::size_t{row} * plot_side + column] = colour;
    };
    const unsigned size = u.points.size() > 200'000 ? 1 : 2;
    const std::vector<Colour> colours = sample_colours(u.base.size());
    for (std::size_t i = 0; i < u.points.size(); ++i) dot(u.points[i], size, size, colours[i % u.base.size()]);
    for (const tracer::FixedPoint2& p : u.base) {
        dot(p, 2 * cross + 1, 1, black);
        dot(p, 1, 2 * cross + 1, black);
    }
    return image;
}

}  // namespace

tracer::ScreenImage draw_samples(const std::string& title, const std::vector<SamplesPanel>& panels) {
    const auto columns = static_cast<int>(std::min<std::size_t>(2, panels.size()));
    const int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
    const int row_height = plot_side + 2 * label_line + border, head = border + 2 * label_line;
    const int width =
        std::max(border + columns * (plot_side + border), 2 * border + tracer::text_width(title, label_size));
    const auto drawing = tracer::make_drawing(width, head + rows * row_height);
    drawing->text(border, border, title, label_size);
    for (std::size_t i = 0; i < panels.size(); ++i) {
        const int column = static_cast<int>(i) % columns, row = static_cast<int>(i) / columns;
        const int x = border + column * (plot_side + border), y = head + row * row_height;
        drawing->text(x, y, panels[i].title, label_size);
        drawing->paste(x, y + label_line, draw_points(*panels[i].samples));
        drawing->frame(x - 1, y + label_line - 1, plot_side + 2, plot_side + 2, black);
        drawing->text(x, y + label_line + plot_side + 4, caption(*panels[i].samples), label_size);
    }
    return drawing->image();
}

}  // namespace raycache::tools
