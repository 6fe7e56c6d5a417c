// random: an independent uniform number per index and dimension, the same for all pixels: Monte Carlo points under a
// decorrelation. (The decorrelation `random` differs per pixel too and ignores the sequence.)
#include "tracer/sampling/hash.hpp"
#include "tracer/sampling/sequence.hpp"

namespace raycache::tracer {

namespace {

class RandomNumbers final : public Sequence {
public:
    explicit RandomNumbers(std::uint64_t seed) : key_(seed, HashPurpose::point_numbers) {}

    std::uint32_t sample(std::uint32_t index, std::uint32_t dimension) const override {
        return key_.words(index, dimension, 0)[0];
    }
    std::uint32_t dimensions() const override { return 1024; }

private:
    HashKey key_;
};

}  // namespace

SequenceEntry random_numbers_entry() {
    return {"random", "independent random points, the same for every pixel",
            [](std::uint64_t seed) -> std::unique_ptr<Sequence> { return std::make_unique<RandomNumbers>(seed); }};
}

}  // namespace raycache::tracer
