#include "tools/jobs/equal_error.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tracer/quality/sweep_rule.hpp"

namespace raycache::tools {

const std::vector<std::string>& equal_error_baselines() {
    static const std::vector<std::string> all{"cranley-patterson", "owen", "blue-noise"};
    return all;
}

std::string no_equal_error(const tracer::ErrorMeasures& e, bool unbiased) {
    const double certain = std::isfinite(e.r8.half_width) ? e.r8.value - e.r8.half_width : e.r8.value;
    if (certain > most_shared_error)
        return fmt::format("R8 {}, at most {}", tracer::measured_text(e.r8, 2), most_shared_error);
    const double z = e.z_seeds.value_or(e.z_pixels);
    if (!unbiased && z > most_bias)
        return fmt::format("bias: z{} {:.1f}, at most {}", e.z_seeds ? " seeds" : "", z, most_bias);
    return {};
}

cachesim::Estimate gain_at_equal_error(const cachesim::Estimate& speed_up, const tracer::RmseRatio& ratio) {
    if (ratio.decided_by_pixels || !ratio.value.resolved()) return {std::nan(""), std::nullopt};
    const double gain = speed_up.mean / (ratio.value.value * ratio.value.value);
    if (!speed_up.half_width || !std::isfinite(ratio.value.half_width)) return {gain, std::nullopt};
    return {gain,
            gain * std::hypot(*speed_up.half_width / speed_up.mean, 2 * ratio.value.half_width / ratio.value.value)};
}

}  // namespace raycache::tools
