#include "tools/jobs/quality_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <set>

#include "tools/jobs/colour_scale.hpp"
#include "tools/jobs/exposure.hpp"
#include "tracer/tone_map.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

using tracer::Drawing, tracer::Image;

constexpr int gap = 16, panel_side = 288, line = label_line;
constexpr std::uint32_t usual_crop = 96;

/// Luminance of picture minus reference.
std::vector<double> luminance_error(const Image& image, const Image& reference) {
    std::vector<double> error(image.pixels.size());
    for (std::size_t p = 0; p < error.size(); ++p)
        error[p] = double{tracer::luminance(image.pixels[p]) - tracer::luminance(reference.pixels[p])};
    return error;
}

std::string file_name(std::string label) {
    for (char& c : label)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '.') c = '_';
    return label;
}

/// The square of whole blocks in which the squared block means of all rows add up to most.
Crop worst_crop(const QualityReport& report) {
    const std::uint32_t side = std::min({usual_crop, report.width, report.height});
    const auto& first = report.rows.front().errors.sums.blocks;
    const std::uint32_t blocks = side / tracer::error_block;
    Crop best{0, 0, side};
    double most = -1;
    for (std::uint32_t top = 0; top + blocks <= first.rows; ++top)
        for (std::uint32_t left = 0; left + blocks <= first.columns; ++left) {
            double sum = 0;
            for (const QualityRow& row : report.rows)
                for (std::uint32_t y = top; y < top + blocks && row.errors.block_rmse.value > 0; ++y)
                    for (std::uint32_t x = left; x < left + blocks; ++x) {
                        const double mean = row.errors.sums.blocks.mean[std::size_t{y} * first.columns + x];
                        // A few bright pixels must not choose the place: sizes, not squares.
                        sum += std::fabs(mean) / row.errors.block_rmse.value;
                    }
            if (!(sum > most)) continue;
            most = sum;
            best = {left * tracer::error_block, top * tracer::error_block, side};
        }
    return best;
}

/// A part of a picture that fills a panel's longer side, enlarged or reduced to the nearest pixels.
struct Part {
    Part(std::uint32_t width, std::uint32_t height)
        : side(std::max(width, height)), columns(fill(width)), rows(fill(height)) {}
    /// at(x, y) of every pixel shown, row by row.
    template <class At>
    auto pixels(const At& at) const {
        std::vector<decltype(at(0U, 0U))> shown;
        for (std::uint32_t row = 0; row < rows; ++row)
            for (std::uint32_t column = 0; column < columns; ++column)
                shown.push_back(at(column * side / panel_side, row * side / panel_side));
        return shown;
    }
    /// Pixels of the panel that this length takes.
    std::uint32_t fill(std::uint32_t length) const { return (length * panel_side + side - 1) / side; }
    void frame(Drawing& drawing, int x, int y) const {
        drawing.frame(x, y, static_cast<int>(columns), static_cast<int>(rows), {0, 0, 0});
    }
    std::uint32_t side, columns, rows;
};

/// `colour(x, y)`: of the picture.
template <class ColourAt>
void draw_colours(Drawing& drawing, int x, int y, const Part& part, const ColourAt& colour) {
    drawing.paste(x, y, {part.columns, part.rows, part.pixels(colour)});
    part.frame(drawing, x, y);
}

/// `value(x, y)`: a number of the picture.
template <class ValueAt>
void draw_values(Drawing& drawing, int x, int y, const Part& part, const Scale& scale, const ValueAt& value) {
    const auto shares =
        part.pixels([&](std::uint32_t px, std::uint32_t py) { return scale.share(double{value(px, py)}); });
    drawing.map(x, y, static_cast<int>(part.columns), shares, scale.colours);
    part.frame(drawing, x, y);
}

void draw_crop(Drawing& drawing, int x, int y, const Image& image, const Crop& crop, float exposure) {
    draw_colours(drawing, x, y, {crop.side, crop.side}, [&](std::uint32_t px, std::uint32_t py) {
        return tracer::tone_map(image.pixels[std::size_t{crop.y + py} * image.width + crop.x + px], exposure);
    });
}

void draw_error(Drawing& drawing, int x, int y, const Image& image, const Image& reference, const Crop& crop,
                const Scale& scale) {
    const auto error = luminance_error(image, reference);
    draw_values(drawing, x, y, {crop.side, crop.side}, scale, [&](std::uint32_t px, std::uint32_t py) {
        return error[std::size_t{crop.y + py} * image.width + crop.x + px];
    });
}

std::string number_text(double value, int digits) {
    return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-";
}

/// Without its interval: a caption is short.
std::string short_text(tracer::Measured m, int digits, bool general = false) {
    m.half_width = std::nan("");
    return tracer::measured_text(m, digits, general);
}

std::string speed_text(const QualityRow& row) {
    if (!row.timing || !std::isfinite(row.timing->seconds)) return {};
    return row.timing->speed_up ? fmt::format(", predicted speed {:.2f} x", row.timing->speed_up->mean)
                                : std::string(", predicted speed 1 x");
}

tracer::ScreenImage draw_index(const QualityReport& report, const QualityPictures& pictures, const Crop& crop,
                               const Scale& pixels, const Scale& blocks, float exposure) {
    const Image& reference = pictures.reference;
    const bool equal_time = report.rows.front().equal_time.has_value();
    const int columns = equal_time ? 5 : 3, row_height = line + panel_side + gap;
    const int top = gap + 4 * line + 8;
    const int rows = static_cast<int>(report.rows.size()) + 1;
    const auto owned = tracer::make_drawing(gap + columns * (panel_side + gap), top + rows * row_height + line + gap);
    Drawing& drawing = *owned;
    const auto column = [](int c) { return gap + c * (panel_side + gap); };
    drawing.text(gap, gap,
                 fmt::format("{}, {} x {} pixels, reference of {} samples per pixel", report.scene, report.width,
                             report.height, report.reference_spp),
                 label_size);
    drawing.text(gap, gap + line, "R8: error shared by 8 x 8 pixels; 1: fine noise, 64: patches.", label_size);
    drawing.text(gap, gap + 2 * line, "z: about 1 without bias, above 1.4 the mean is off.", label_size);
    if (equal_time)
        drawing.text(gap, gap + 3 * line,
                     fmt::format("Equal time: as many samples as {} predicts to fit into the time of {}.", report.gpu,
                                 report.baseline.empty() ? "each" : report.baseline),
                     label_size);

    // First row: what is shown, and the scales.
    drawing.text(column(0), top, "reference, crop", label_size);
    draw_crop(drawing, column(0), top + line, reference, crop, exposure);
    drawing.text(column(1), top, "reference, whole", label_size);
    draw_colours(drawing, column(1), top + line, {reference.width, reference.height},
                 [&](std::uint32_t x, std::uint32_t y) {
                     return tracer::tone_map(reference.pixels[std::size_t{y} * reference.width + x], exposure);
                 });
    const std::uint32_t whole = std::max(reference.width, reference.height);
    const auto shown = [&](std::uint32_t length) { return static_cast<int>(length * panel_side / whole); };
    for (const int inset : {0, 1})
        drawing.frame(column(1) + shown(crop.x) + inset, top + line + shown(crop.y) + inset,
                      shown(crop.side) - 2 * inset, shown(crop.side) - 2 * inset, {230, 60, 0});
    drawing.text(column(2), top, "error, red: too bright", label_size);
    draw_scale_bar(drawing, column(2), top + 2 * line, panel_side, pixels, "pixel, luminance");
    draw_scale_bar(drawing, column(2), top + 6 * line, panel_side, blocks, "mean of 8 x 8");

    for (std::size_t r = 0; r < report.rows.size(); ++r) {
        const QualityRow& row = report.rows[r];
        const int y = top + static_cast<int>(r + 1) * row_height;
        drawing.text(column(0), y,
                     fmt::format("{}, N {}, RMSE {}, R8 {}, z {}{}", label(row, report.rows), row.spp(),
                                 short_text(row.errors.rmse, 3, true), short_text(row.errors.r8, 1),
                                 number_text(row.errors.z_pixels, 1), speed_text(row)),
                     label_size);
        draw_crop(drawing, column(0), y + line, pictures.rows[r], crop, exposure);
        draw_error(drawing, column(1), y + line, pictures.rows[r], reference, crop, pixels);
        const auto& means = row.errors.sums.blocks;
        if (means.columns > 0 && means.rows > 0)
            draw_values(
                drawing, column(2), y + line, {means.columns, means.rows}, blocks,
                [&](std::uint32_t bx, std::uint32_t by) { return means.mean[std::size_t{by} * means.columns + bx]; });
        if (!equal_time) continue;
        const QualityRow::EqualTime& same = *row.equal_time;
        drawing.text(column(3), y,
                     fmt::format("equal time: N {}, RMSE {}, R8 {}", same.spp, short_text(same.errors.rmse, 3, true),
                                 short_text(same.errors.r8, 1)),
                     label_size);
        draw_crop(drawing, column(3), y + line, pictures.at_equal_time[r], crop, exposure);
        draw_error(drawing, column(4), y + line, pictures.at_equal_time[r], reference, crop, pixels);
    }
    const int bottom = top + rows * row_height;
    drawing.text(column(0), bottom, "picture, crop", label_size);
    drawing.text(column(1), bottom, "error, crop", label_size);
    drawing.text(column(2), bottom, "error, whole, 8x8", label_size);
    if (equal_time) {
        drawing.text(column(3), bottom, "equal time, crop", label_size);
        drawing.text(column(4), bottom, "its error", label_size);
    }
    return drawing.image();
}

void write_row(const std::string& stem, const QualityRow& row, const Image& picture, const Image& reference,
               const Scale& scale, float exposure, Deliveries& deliveries) {
    deliveries.attempt([&] { tracer::write_image(stem + ".exr", picture); });
    deliveries.attempt([&] { tracer::write_image(stem + ".png", picture, exposure); });
    Image error = picture;
    for (std::size_t p = 0; p < error.pixels.size(); ++p) error.pixels[p] = error.pixels[p] - reference.pixels[p];
    deliveries.attempt([&] { tracer::write_image(stem + "_error.exr", error); });
    const auto width = static_cast<int>(error.width), height = static_cast<int>(error.height);
    const auto drawing = tracer::make_drawing(width, height + scale_bar_height + 2 * line + 8);
    std::vector<float> shares;
    for (const double value : luminance_error(picture, reference)) shares.push_back(scale.share(value));
    drawing->map(0, 0, width, shares, scale.colours);
    draw_scale_bar(*drawing, 0, height + 4, width, scale, "luminance minus reference");
    deliveries.attempt([&] { tracer::write_screen_image(stem + "_error.png", drawing->image()); });
    const auto& blocks = row.errors.sums.blocks;
    if (blocks.columns > 0 && blocks.rows > 0)
        deliveries.attempt([&] {
            tracer::write_channels(stem + "_blocks.exr", blocks.columns, blocks.rows, {{"Y", blocks.mean}});
        });
}

}  // namespace

Crop parse_crop(const std::string& text, std::uint32_t width, std::uint32_t height) {
    Crop crop;
    std::uint32_t* const out[3] = {&crop.x, &crop.y, &crop.side};
    const char *at = text.data(), *end = at + text.size();
    bool good = true;
    for (int i = 0; i < 3 && good; ++i) {
        const auto [stop, error] = std::from_chars(at, end, *out[i]);
        good = error == std::errc{} && (i == 2 ? stop == end : stop != end && *stop == ',');
        at = stop + 1;
    }
    if (!good || crop.side == 0 || std::uint64_t{crop.x} + crop.side > width ||
        std::uint64_t{crop.y} + crop.side > height)
        throw UsageError(fmt::format("--crop '{}'; expected X,Y,SIDE within {} x {} pixels, such as 0,0,{}", text,
                                     width, height, std::min({usual_crop, width, height})));
    return crop;
}

void check_picture_folder(const std::string& folder) {
    refuse_stdout("--output", folder);
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw Error(fmt::format("--output {}: expected a folder that can be made, found: {}; choose another", folder,
                                error.message()));
}

std::vector<std::string> quality_picture_names(const std::string& folder,
                                               const std::vector<tracer::CaptureSettings>& cases) {
    const std::filesystem::path path(folder);
    std::vector<std::string> names{(path / "index.png").string(), (path / "reference.png").string()};
    std::vector<QualityRow> rows(cases.size());
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].settings = cases[i];
    std::set<std::string> named;  // a case that is listed twice has one picture
    for (const QualityRow& row : rows)
        if (const std::string stem = (path / file_name(label(row, rows))).string(); named.insert(stem).second)
            for (const char* end : {".exr", ".png", "_error.exr", "_error.png", "_blocks.exr"})
                names.push_back(stem + end);
    return names;
}

void write_quality_pictures(const std::string& folder, const QualityReport& report, const QualityPictures& pictures,
                            const std::optional<Crop>& given_crop, Deliveries& deliveries) {
    const Image& reference = pictures.reference;
    const Crop crop = given_crop ? *given_crop : worst_crop(report);
    const float exposure = automatic_exposure(reference);
    std::vector<double> errors, means;
    for (const Image& picture : pictures.rows) {
        const auto own = luminance_error(picture, reference);
        errors.insert(errors.end(), own.begin(), own.end());
    }
    for (const QualityRow& row : report.rows)
        means.insert(means.end(), row.errors.sums.blocks.mean.begin(), row.errors.sums.blocks.mean.end());
    const Scale pixels = symmetric_scale(errors), blocks = symmetric_scale(means);
    const std::filesystem::path path(folder);
    for (std::size_t r = 0; r < report.rows.size(); ++r)
        write_row((path / file_name(label(report.rows[r], report.rows))).string(), report.rows[r], pictures.rows[r],
                  reference, pixels, exposure, deliveries);
    deliveries.attempt([&] { tracer::write_image((path / "reference.png").string(), reference, exposure); });
    deliveries.attempt([&] {
        tracer::write_screen_image((path / "index.png").string(),
                                   draw_index(report, pictures, crop, pixels, blocks, exposure));
    });
}

}  // namespace raycache::tools
