// The picture that errors are measured against, and how far it can itself be wrong.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "tracer/image.hpp"
#include "tracer/prepared_scene.hpp"
#include "tracer/render.hpp"

namespace raycache::tracer {

/// Two independent pictures a and b of half the samples each, kept as their mean and half their difference. The error
/// of the mean, (e_a + e_b) / 2, and the half difference, (e_a - e_b) / 2, have the same covariance (e_a and e_b being
/// independent, unbiased and alike): whatever square is measured on `half_difference` is, on average, what the
/// reference's own error adds to the same square of a difference to `mean`.
struct Reference {
    Image mean, half_difference;
    std::string key;  ///< reference_key() of what it shows
};

struct ReferenceSettings {
    std::uint32_t width = 512, height = 512;  ///< pixels
    PathSettings paths;
    std::uint64_t spp = 1024;  ///< samples per pixel of both halves together, at least 2; odd numbers are rounded up
    /// Must be unbiased and draw each pixel's numbers independently of other pixels' and of other seeds'.
    std::string decorrelation = "random", sequence = "sobol";
    std::optional<float> clamp{};  ///< as RenderSettings::clamp; must be that of the pictures held against it
};

/// Everything the reference depends on, in words, the scene's content by its hash. Equal keys, equal pictures.
std::string reference_key(const PreparedScene&, const ReferenceSettings&);

/// By default plain Monte Carlo, the estimator that shares nothing with a strategy: independent random numbers for each
/// pixel, sample and dimension. In blocks of 4096 samples, each with a seed of its own that check_seeds() keeps away
/// from the strategies'. Throws UsageError for less than 2 samples and as SamplingStrategy does. `progress` as in
/// render().
Reference render_reference(const PreparedScene&, const ReferenceSettings&,
                           const std::function<void(std::uint64_t paths)>& progress);

/// Throws UsageError where one of the `count` seeds from `first` on belongs to references.
void check_seeds(std::uint64_t first, std::uint64_t count);

}  // namespace raycache::tracer
