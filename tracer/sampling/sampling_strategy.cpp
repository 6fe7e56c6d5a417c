#include "tracer/sampling/sampling_strategy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <unordered_set>

#include "tracer/sampling/random_stream.hpp"
#include "traces/error.hpp"

namespace raycache::tracer {

namespace {

constexpr std::uint64_t max_chosen = std::uint64_t{1} << 20;

/// Another decorrelation, with one pair of dimensions left to `random`.
class IndependentPair final : public Decorrelation {
public:
    IndependentPair(std::unique_ptr<Decorrelation> others, std::uint32_t pair, const SampleSet& samples)
        : others_(std::move(others)), independent_(make_decorrelation("random", {}, samples)), pair_(pair) {}

    std::uint32_t apply(std::uint32_t x, std::uint32_t pixel, std::uint32_t index,
                        std::uint32_t dimension) const override {
        return (dimension / 2 == pair_ ? independent_ : others_)->apply(x, pixel, index, dimension);
    }
    std::string parameters() const override { return others_->parameters(); }
    std::string warning() const override { return others_->warning(); }

private:
    std::unique_ptr<Decorrelation> others_, independent_;
    std::uint32_t pair_;
};

}  // namespace

SamplingStrategy::SamplingStrategy(const StrategySettings& settings, std::uint32_t dimensions)
    : settings_(settings), dimensions_(dimensions), sequence_(make_sequence(settings.sequence, settings.samples.seed)) {
    check_spp(settings.samples.spp);
    check_parameters(settings.parameters);
    if (dimensions > sequence_->dimensions()) {
        throw UsageError(fmt::format(
            "sampling: sequence '{}' must have a dimension for every random number of a path, expected at most {}, "
            "found {}: trace fewer bounces or choose another sequence",
            settings.sequence, sequence_->dimensions(), dimensions));
    }
    if (settings.samples.spp > sequence_->points()) {
        throw UsageError(
            fmt::format("sampling: sequence '{}' has {} points, found N = {}: lower N or choose another sequence",
                        settings.sequence, sequence_->points(), settings.samples.spp));
    }
    settings_.samples.dimensions = dimensions;
    decorrelation_ = make_decorrelation(settings.decorrelation, settings_.parameters, settings_.samples, *sequence_);
    if (settings.independent_pair)
        decorrelation_ =
            std::make_unique<IndependentPair>(std::move(decorrelation_), *settings.independent_pair, settings.samples);
}

std::vector<std::string> SamplingStrategy::warnings() const {
    std::vector<std::string> lines;
    if (const std::string line = decorrelation_->warning(); !line.empty()) lines.push_back(line);
    const std::uint64_t n = settings_.samples.spp;
    const DecorrelationEntry& entry = find_decorrelation(settings_.decorrelation);
    if (sequence_->net_dimensions() != 0 && !std::has_single_bit(n) && entry.reads_sequence)
        lines.push_back(fmt::format(
            "N = {} is no power of two: the points of sequence '{}' are then no whole net and spread less evenly; "
            "choose {} or {}",
            n, settings_.sequence, std::bit_floor(n), std::bit_ceil(n)));
    return lines;
}

std::vector<std::uint32_t> SamplingStrategy::base_point(std::uint64_t index) const {
    if (index >= settings_.samples.spp) {
        throw UsageError(
            fmt::format("sampling: a sample index must be below the number of samples per pixel N = {}, found {}: "
                        "raise N or choose "
                        "a smaller index",
                        settings_.samples.spp, index));
    }
    std::vector<std::uint32_t> point(dimensions_);
    for (std::uint32_t d = 0; d < dimensions_; ++d) {
        point[d] = sequence_->sample(static_cast<std::uint32_t>(index), d);
    }
    return point;
}

std::vector<std::uint32_t> choose_sample_indices(std::uint64_t spp, std::uint64_t count, std::uint64_t seed) {
    check_spp(spp);
    if (count == 0) {
        throw UsageError("sampling: the number of samples to trace must be 1 or more, found 0: ask for at least 1");
    }
    count = std::min(count, spp);
    if (count > max_chosen) {
        throw UsageError(fmt::format("sampling: at most {} of the N samples can be traced, found {}: ask for fewer",
                                     max_chosen, count));
    }
    std::vector<std::uint32_t> chosen;
    chosen.reserve(count);
    if (count == spp) {
        for (std::uint64_t i = 0; i < spp; ++i) chosen.push_back(static_cast<std::uint32_t>(i));
        return chosen;
    }
    // R. W. Floyd's subset algorithm (J. Bentley, "Programming Pearls: a sample of brilliance", CACM 30(9), 1987):
    // every subset is equally likely, with `count` draws however large spp is.
    RandomStream random(seed, HashPurpose::sample_indices);
    std::unordered_set<std::uint32_t> taken;
    taken.reserve(count);
    for (std::uint64_t last = spp - count; last < spp; ++last) {
        const auto candidate = static_cast<std::uint32_t>(random.below(last + 1));
        chosen.push_back(taken.insert(candidate).second ? candidate : static_cast<std::uint32_t>(last));
        taken.insert(chosen.back());
    }
    std::sort(chosen.begin(), chosen.end());
    return chosen;
}

}  // namespace raycache::tracer
