// blue-noise: Cranley-Patterson rotation whose offsets form blue noise in the picture: neighbours get offsets far
// apart, so their errors cancel under a small blur. I. Georgiev, M. Fajardo, "Blue-noise dithered sampling", SIGGRAPH
// 2016 Talks. The offset of pixel (px, py) in dimension d is the rank of a void-and-cluster mask (blue_noise_mask.hpp)
// at (px + u_d, py + v_d), over the 4096 ranks, with a random number of the pixel below one rank: uniform in [0, 1)
// over a tile of 64x64 pixels. The shifts (u_d, v_d) are successive points of the R2 sequence from a random start, so
// that masks of nearby dimensions lie far apart; two dimensions whose shifts come within two or three pixels of each
// other, from some hundred dimensions on, are correlated.
//
// One mask per dimension, not a mask of vectors: the noise is blue in each dimension of a sample by itself.
#include "tracer/sampling/blue_noise_mask.hpp"
#include "tracer/sampling/decorrelation.hpp"
#include "tracer/sampling/hash.hpp"
#include "tracer/sampling/pixel_place.hpp"

namespace raycache::tracer {

namespace {

class BlueNoise final : public Decorrelation {
public:
    BlueNoise(const SampleSet& samples, const Sequence& sequence)
        : places_("blue-noise", samples.width),
          detail_(samples.seed, HashPurpose::mask_detail),
          mask_(make_blue_noise_mask(samples.seed)) {
        const HashWords start = HashKey(samples.seed, HashPurpose::mask_shift).words(0, 0, 0);
        PixelPlace shift{start[0], start[1]};  // as a share of the torus, in units of 2^-32
        for (std::uint32_t d = 0; d < sequence.dimensions(); ++d) {
            shifts_.push_back({shift.x >> 26, shift.y >> 26});
            shift.x += 0xC13FA9A9U;  // 2^32 / p and 2^32 / p^2, p^3 = p + 1
            shift.y += 0x91E10DA6U;
        }
    }

    std::uint32_t apply(std::uint32_t x, std::uint32_t pixel, std::uint32_t, std::uint32_t dimension) const override {
        const PixelPlace at = places_.of(pixel), shift = shifts_[dimension];
        const std::uint32_t row = (at.y + shift.y) % mask_side, column = (at.x + shift.x) % mask_side;
        const std::uint32_t rank = mask_[std::size_t{row} * mask_side + column];
        const std::uint32_t detail = pixel_offset(detail_, pixel, dimension) >> mask_bits;
        return x + (rank << (32 - mask_bits) | detail);  // wraps: modulo 1 in fixed point
    }

private:
    PixelPlaces places_;
    HashKey detail_;
    BlueNoiseMask mask_;
    std::vector<PixelPlace> shifts_;
};

}  // namespace

DecorrelationEntry blue_noise_entry() {
    return {.name = "blue-noise",
            .description = "Cranley-Patterson rotation by a blue-noise mask: neighbours' offsets lie far apart",
            .make = [](const Parameters&, const SampleSet& samples, const Sequence& sequence)
                -> std::unique_ptr<Decorrelation> { return std::make_unique<BlueNoise>(samples, sequence); }};
}

}  // namespace raycache::tracer
