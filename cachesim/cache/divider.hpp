// Division of any number by one that is known beforehand, without the machine's slow division.
#pragma once

#include <cstdint>

namespace raycache::cachesim {

class Divider {
public:
    explicit Divider(std::uint64_t divisor)
        : divisor_(divisor),
          reciprocal_(divisor == 1 ? ~std::uint64_t{0} : static_cast<std::uint64_t>((Wide{1} << 64) / divisor)) {}

    struct Result {
        std::uint64_t quotient, rest;
    };
    Result operator()(std::uint64_t value) const {
        // floor(value * reciprocal / 2^64) is the quotient or one less.
        const auto quotient = static_cast<std::uint64_t>((Wide{value} * reciprocal_) >> 64);
        const std::uint64_t rest = value - quotient * divisor_;
        return rest < divisor_ ? Result{quotient, rest} : Result{quotient + 1, rest - divisor_};
    }

private:
    __extension__ using Wide = unsigned __int128;
    std::uint64_t divisor_, reciprocal_;
};

}  // namespace raycache::cachesim
