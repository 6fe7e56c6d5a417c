// net-micro-jitter: all pixels share leading bits of a net's points; the bits below, and all other dimensions, are
// Owen-scrambled per pixel and dimension:
//     y = (x & M_d) | (owen(x) & ~M_d),  M_d = the leading bits of dimension d that are shared
// An extension of this project (docs/sampling.md). Both parts are nested scramblings, so every pixel keeps a full net.
// No wrap. Where each joint cell of the shared bits holds equally many of a pixel's N points, sharing only orders each
// pixel's own scrambled net alike: the mean over pixels is exact and neighbours share no error. A net of N = 2^m points
// has m such bits.
//
// `share` says where they go. First bounce: both dimensions of that direction, m/2 bits each, mu = N^(-1/2) there.
// `sets`: the leading k bits of every dimension, with sets of 4 dimensions exact jointly (mu about N^(-1/4)) and not
// beyond.
#include <fmt/format.h>

#include "tracer/sampling/decorrelations/net_bits.hpp"
#include "tracer/sampling/decorrelations/shared_pairs.hpp"
#include "tracer/sampling/hash.hpp"
#include "tracer/sampling/owen_scramble.hpp"

namespace raycache::tracer {

namespace {

constexpr const char* sets = "sets";

void check_share(const std::string& text) {
    if (text != sets) parse_pairs(text);
}

constexpr ParameterEntry share_parameter{
    .name = "share",
    .description =
        "pairs of dimensions whose leading bits pixels share: first-bounce, light0, camera, or the first "
        "dimensions of pairs, joined by +; or sets: of all dimensions, in sets of 4",
    .fallback = "first-bounce",
    .label = "share",
    .remedy = "give share=first-bounce",
    .check = check_share};
constexpr ParameterEntry share_bits_parameter{.name = "share-bits",
                                              .description =
                                                  "bits shared, of all dimensions of `share` together; "
                                                  "default: as many as are free",
                                              .fallback = "",
                                              .label = "the number of shared bits",
                                              .remedy = "leave it out: as many as are free",
                                              .whole = true,
                                              .most = 256};

class NetMicroJitter final : public Decorrelation {
public:
    NetMicroJitter(const Parameters& parameters, const SampleSet& samples, const Sequence& sequence)
        : share_(parameters.word(share_parameter)), key_(samples.seed, HashPurpose::pixel_scramble) {
        if (share_ == sets) {
            of_sets_.emplace("net-micro-jitter with share=sets", 4, samples, sequence);
            return;
        }
        const int bits =
            parameters.has(share_bits_parameter.name) ? static_cast<int>(parameters.whole(share_bits_parameter)) : -1;
        of_pairs_.emplace(parse_pairs(share_), bits, samples, sequence);
    }

    std::uint32_t apply(std::uint32_t x, std::uint32_t pixel, std::uint32_t, std::uint32_t dimension) const override {
        const std::uint32_t shared = shared_bits(dimension);
        return (x & shared) | (owen_scramble(x, key_.words(pixel, dimension, 0)) & ~shared);
    }
    std::string parameters() const override {
        return fmt::format("share={} {}", share_, of_sets_ ? of_sets_->parameters() : of_pairs_->parameters());
    }
    std::string warning() const override { return of_pairs_ ? of_pairs_->warning() : std::string(); }
    std::uint32_t shared_bits(std::uint32_t dimension) const override {
        return of_sets_ ? of_sets_->mask(dimension) : of_pairs_->mask(dimension);
    }

private:
    std::string share_;
    std::optional<NetBits> of_sets_;
    std::optional<SharedPairs> of_pairs_;  ///< else
    HashKey key_;
};

std::vector<std::string> reads(const Parameters& given) {
    if (given.text(share_parameter.name) == sets) return {share_parameter.name};
    return {share_parameter.name, share_bits_parameter.name};
}

}  // namespace

DecorrelationEntry net_micro_jitter_entry() {
    return {.name = "net-micro-jitter",
            .description =
                "leading bits of a net shared, of the first bounce's direction, the rest Owen-scrambled per "
                "pixel; unbiased",
            .make = [](const Parameters& parameters, const SampleSet& samples,
                       const Sequence& sequence) -> std::unique_ptr<Decorrelation> {
                return std::make_unique<NetMicroJitter>(parameters, samples, sequence);
            },
            .parameters = {share_parameter, share_bits_parameter},
            .reads = reads};
}

}  // namespace raycache::tracer
