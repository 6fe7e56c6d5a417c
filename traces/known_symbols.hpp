// Writes a warp whose symbols the tracer has kept: they need no search, only the literals are looked up. Internal to
// traces/.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "traces/block_streams.hpp"
#include "traces/header.hpp"
#include "traces/record.hpp"
#include "traces/schedule.hpp"

namespace raycache::traces {

/// Kept from warp to warp for its memory.
class KnownSymbols {
public:
    /// `symbols`: see encode_block. Throws Error if the warp breaks a rule of record.hpp.
    void write(const Header&, Schedule&, const WarpTrace&, std::span<const std::uint8_t> symbols, BlockStreams&);

private:
    /// Lanes whose next access, after the record, is in region 0, 1, 2.
    using NextIn = std::array<std::uint32_t, 3>;
    struct Literal {
        std::uint32_t region, element;
    };

    void look_ahead(const Header&, const WarpTrace&, std::size_t symbols);
    /// The lanes of record i whose literal is open read what it stands for.
    void look_up(const Header&, const WarpTrace&, std::size_t i, const std::uint32_t* elements);
    /// `special`: which of the record's symbols are no depth.
    void note_special(Schedule&, std::uint32_t mask, const std::uint8_t* symbols, std::uint32_t special);

    std::vector<NextIn> next_in_;  ///< of each record
    std::vector<Literal> literals_;
    std::array<std::size_t, warp_lanes> literal_of_{};  ///< by lane, place in literals_
    std::uint32_t open_ = 0;                            ///< lanes whose literal waits for the lane's next access
};

}  // namespace raycache::traces
