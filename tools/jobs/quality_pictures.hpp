// Strategies side by side: crops of their pictures, where they err, and which blocks err together.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/jobs/outputs.hpp"
#include "tools/jobs/quality_report.hpp"

namespace raycache::tools {

/// A square part of the picture.
struct Crop {
    std::uint32_t x = 0, y = 0, side = 0;
};

/// "X,Y,SIDE" in pixels. Throws UsageError where that does not lie within the picture.
Crop parse_crop(const std::string&, std::uint32_t width, std::uint32_t height);

/// Makes the folder if need be. Throws Error if it cannot.
void check_picture_folder(const std::string& folder);

/// The files that write_quality_pictures() will write.
std::vector<std::string> quality_picture_names(const std::string& folder,
                                               const std::vector<tracer::CaptureSettings>& cases);

/// Writes into `folder`: index.png (a row per strategy: crop, its error, all blocks' mean errors, and with equal_time
/// crop and error at that N), reference.png, and for each strategy NAME.exr and .png (its picture), NAME_error.exr and
/// .png (minus the reference) and NAME_blocks.exr. `crop`: default is where strategies' blocks err most.
void write_quality_pictures(const std::string& folder, const QualityReport&, const QualityPictures&,
                            const std::optional<Crop>& crop, Deliveries&);

}  // namespace raycache::tools
