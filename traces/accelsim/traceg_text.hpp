// A launch as the warp instructions of an Accel-Sim trace (".traceg", tracer version 5).
//
// An object that a warp access reads becomes loads of 16 bytes, or of 8, 4, 2 or 1 where the layout does not align it
// or too little is left: the loads that a compiler makes of a struct. Each region has its own code, one load after the
// other, so program counters ascend within an object. The last load writes the register that the next object's address
// comes from. Ray starts are no instructions: a ray's type and bounce are lost. A CTA is warps_per_cta consecutive
// warps; the last is filled up with warps that only end.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::traces {

struct TracegSettings {
    std::uint32_t warps_per_cta = 4;    ///< 1 to 32
    std::uint32_t binary_version = 86;  ///< compute capability: 61 Pascal, 70 Volta, 75 Turing, 86 Ampere, …
};

class TracegText {
public:
    /// `write` gets the header at once, then pieces of text. Throws UsageError for a CTA size out of range.
    TracegText(const Header&, const TracegSettings&, std::function<void(std::string_view)> write);

    void add(const WarpTrace&);  ///< the next warp of the launch
    void finish();               ///< ends the last CTA

private:
    /// One load of an object: where in it, how wide.
    struct Load {
        std::uint32_t offset, bytes;
    };

    void add_instructions(const WarpTrace&);
    void end_warp();

    const Header& header_;
    TracegSettings settings_;
    std::function<void(std::string_view)> write_;
    std::vector<std::vector<Load>> loads_;  ///< of each region
    std::uint64_t cta_ = 0;
    std::uint32_t warp_ = 0;  ///< next in the CTA
    std::string lines_;       ///< instructions of the warp
    std::uint64_t instructions_ = 0;
};

}  // namespace raycache::traces
