#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "traces/block_streams.hpp"
#include "traces/known_symbols.hpp"
#include "traces/lane_stack.hpp"
#include "traces/record_rules.hpp"
#include "traces/symbol_search.hpp"
#include "traces/writer.hpp"

namespace raycache::traces {
namespace {

/// Turns warps into a block. Kept per thread for its memory.
class Encoder {
public:
    Block encode(const Header&, std::span<const WarpTrace>, std::span<const WarpSymbols>);

private:
    BlockStreams streams_;
    SymbolSearch search_;
    KnownSymbols known_;
};

Block Encoder::encode(const Header& header, std::span<const WarpTrace> warps, std::span<const WarpSymbols> symbols) {
    if (warps.empty() || warps.size() > format::max_block_warps)
        throw Error(fmt::format("trace block: expected 1 to {} warps, found {}; split the launch into more blocks",
                                format::max_block_warps, warps.size()));
    Block block{warps[0].launch, warps[0].warp, static_cast<std::uint32_t>(warps.size()), 0, 0, 0, {}};
    std::uint64_t lanes = 0;
    for (std::size_t i = 0; i < warps.size(); ++i) {
        if (warps[i].launch != warps[0].launch || warps[i].warp != warps[0].warp + i)
            throw Error(
                fmt::format("trace block: expected launch {} warp {}, found launch {} warp {}; a block holds "
                            "consecutive warps of one launch",
                            warps[0].launch, warps[0].warp + i, warps[i].launch, warps[i].warp));
        block.records += warps[i].records.size();
        block.lane_accesses += warps[i].elements.size();
        for (const Record& record : warps[i].records) lanes += record.lanes();
    }
    if (lanes > format::max_block_lanes || block.records > format::max_block_records)
        throw Error(
            fmt::format("trace block: expected at most {} lane accesses and rays, found {} in {} warps; put fewer "
                        "warps into a block",
                        format::max_block_lanes, lanes, warps.size()));
    block.rays = lanes - block.lane_accesses;  // whether the elements are as many as the masks say is checked below
    streams_.begin_block(lanes + warp_lanes * warps.size());
    Schedule schedule(header);
    const bool usable = header.regions.size() <= unlinkable;
    for (std::size_t i = 0; i < warps.size(); ++i) {
        schedule.start_warp();
        if (usable && i < symbols.size() && !symbols[i].empty())
            known_.write(header, schedule, warps[i], symbols[i], streams_);
        else
            search_.write(header, schedule, warps[i], streams_);
        check_issue(header, warps[i]);
        if (header.issue) streams_.issue(warps[i]);
    }
    block.bytes = streams_.assemble(
        {0, block.launch, block.first_warp, block.warps, block.records, block.lane_accesses, block.rays, {}});
    return block;
}

}  // namespace

Block encode_block(const Header& header, std::span<const WarpTrace> warps, std::span<const WarpSymbols> symbols) {
    thread_local const auto encoder = std::make_unique<Encoder>();
    return encoder->encode(header, warps, symbols);
}

}  // namespace raycache::traces
