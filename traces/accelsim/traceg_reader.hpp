// What the text of a kernel's trace means, line by line, wherever the lines come from. Internal to traces/accelsim/.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "traces/accelsim/instruction_line.hpp"
#include "traces/accelsim/text_place.hpp"
#include "traces/accelsim/traceg_parser.hpp"

namespace raycache::traces {

class TracegReader {
public:
    using Use = std::function<void(std::uint64_t warp, GlobalLoad&)>;

    TracegReader(const Use& use, const TracegOptions& options) : use_(use), options_(options) {
        grammar_.stores = options.stores;
    }

    /// A line of the header, which begins with '-'.
    void header_line(std::string_view line, const TextPlace&);
    void end_header(const TextPlace&);

    void begin_block(const TextPlace&);
    void coordinates(std::array<std::uint64_t, 3>, const TextPlace&);  ///< at most once a block
    void begin_warp(std::uint64_t number, const TextPlace&);           ///< of the block
    void instruction(std::string_view line, const TextPlace&);
    void end_block() {
        end_warp();
        in_block_ = false;
    }

    /// `place`: the end of the file.
    TracegKernel finish(const TextPlace& place);

    bool in_block() const { return in_block_; }

    /// What stands behind "KEY = ", if the line has this key.
    static std::optional<std::string_view> value_of(std::string_view line, std::string_view key);
    static std::uint64_t number(std::string_view what, std::string_view text, const TextPlace&);
    /// Three numbers with commas between them.
    static std::array<std::uint64_t, 3> triple(std::string_view what, std::string_view text, const TextPlace&);

private:
    void end_warp();
    void other_instruction(const InstructionLine&);
    void hand_on();
    void leave_out(std::string_view opcode);
    bool drop_null_lanes();

    const Use& use_;
    TracegOptions options_;
    InstructionGrammar grammar_{0, 0};
    bool line_numbers_ = false, first_instruction_ = true;
    std::array<std::uint64_t, 3> grid_{};
    TracegKernel kernel_;
    std::uint64_t blocks_ = 0;  ///< so far
    std::uint64_t block_ = 0;   ///< number of this one
    bool in_block_ = false;
    std::uint64_t warp_ = 0;
    std::vector<bool> seen_;  ///< warps of the block
    bool in_warp_ = false;
    bool exit_ = false;  ///< the last instruction was EXIT
    GlobalLoad load_;
    std::uint32_t handed_on_ = 0;  ///< loads and stores of the warp
    Scoreboard scoreboard_;
    RegisterSet between_;  ///< GlobalLoad::between of the load that comes next
};

}  // namespace raycache::traces
