// Pictures whose every pixel has a known value, so that the error of a sampling strategy can be measured without a
// renderer and without a reference image's own error. A scene is an integrand over the unit square or the unit
// 4-cube that changes slowly over a picture of 64 x 64 pixels; the right value of a pixel is its integral, in closed
// form. (u, v) in (0, 1)^2 is the centre of the pixel.
//
// scenes_2d(): 12 scenes.
//   edge A            1 on one side of a line with the normal's angle A = 0, 9, 27, 45, 71, 90 degrees, which moves
//   over
//                     the picture: what a pixel sees of a silhouette
//   disc, small disc  1 in a disc of radius 0.31 (0.12) whose centre moves
//   corner            1 where x < a and y < b, a and b moving
//   periodic          exp(sin 2 pi (x + 2y + u)): smooth, and smooth across the border
//   lobe              a Gaussian of width 0.15 whose centre moves: smooth, nearly 0 at the border
//   ramp              (x + u) (y + v)^2: smooth, but it jumps across the border, where jitter wraps
// edges_4d(): 12 scenes, 1 on one side of a plane in four dimensions, with 12 oblique normals. A path's decisions
//                     together decide what it hits, so edges in all its dimensions are the rule in rendering.
//
// Volume of a cube cut by a plane: D. Barrow, P. Smith, "Spline Notation Applied to a Volume Problem", American
// Mathematical Monthly 86(1), 1979.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tracer/sampling/measures/field_error.hpp"
#include "tracer/sampling/sampling_strategy.hpp"

namespace raycache::tracer {

inline constexpr std::uint32_t test_picture_width = 64;
inline constexpr std::uint32_t test_picture_pixels = test_picture_width * test_picture_width;

class TestScene {
public:
    explicit TestScene(std::string name) : name_(std::move(name)) {}
    virtual ~TestScene() = default;
    /// The integrand at y, of 2 or 4 dimensions.
    virtual double value(const double* y, double u, double v) const = 0;
    /// Its integral. Absolute error below 1e-12.
    virtual double integral(double u, double v) const = 0;
    const std::string& name() const { return name_; }

private:
    std::string name_;
};
using TestScenes = std::vector<std::unique_ptr<TestScene>>;

const TestScenes& scenes_2d();
const TestScenes& edges_4d();

/// The points of a pixel: what a strategy, or a variant of one, makes of N base points.
class PixelPoints {
public:
    virtual ~PixelPoints() = default;
    /// Fills `points` with N * dimensions numbers in [0, 1], point after point. Safe from any thread.
    virtual void fill(std::uint32_t pixel, std::span<double> points) const = 0;
};

/// Dimensions 0 … dimensions-1 of a strategy.
class StrategyPoints final : public PixelPoints {
public:
    /// Throws as SamplingStrategy does.
    StrategyPoints(StrategySettings, std::uint32_t dimensions);
    void fill(std::uint32_t pixel, std::span<double> points) const override;

private:
    SamplingStrategy strategy_;
    std::vector<std::uint32_t> base_;  ///< N * dimensions
};

/// Estimates every pixel of every scene as the mean over its N points. One result per scene, in order. Parallel; the
/// result does not depend on the number of threads.
std::vector<FieldError> measure_scenes(const TestScenes&, std::uint32_t dimensions, std::uint32_t n,
                                       const PixelPoints&);

/// Over scenes: mean MSE, root mean square z (1 for no bias; above 1.4 by chance in fewer than 1 of 100 cases of 12
/// scenes), mean R8. Scenes whose error is rounding alone count for the MSE only.
FieldError summarise(std::span<const FieldError>);

}  // namespace raycache::tracer
