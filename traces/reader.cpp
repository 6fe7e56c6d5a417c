#include "traces/reader.hpp"

#include <algorithm>
#include <string>

#include "traces/block_decoder.hpp"
#include "traces/block_index.hpp"
#include "traces/format.hpp"
#include "traces/header_codec.hpp"
#include "traces/input_file.hpp"
#include "traces/memory_budget.hpp"

namespace raycache::traces {

struct Reader::Impl {
    explicit Impl(const std::string& path) : file(path) {
        Bytes bytes;
        file.read(0, std::min<std::uint64_t>(file.bytes(), format::fixed_header_bytes), bytes);
        const std::uint64_t head = header_bytes(bytes, file.bytes(), file.at(0));
        {
            const MemoryHold hold(budget, head, path, "head of the trace");
            file.read(0, head, bytes);
            header = decode_header(bytes, file.at(0), budget);
            bytes = {};
        }

        const std::uint64_t tail = std::min<std::uint64_t>(file.bytes() - head, format::index_tail_bytes);
        file.read(file.bytes() - tail, tail, bytes);
        const std::uint64_t size = index_bytes(bytes, file.bytes() - head, file.at(file.bytes() - tail));
        budget.charge(2 * size, path, "index of its blocks");
        file.read(file.bytes() - size, size, bytes);
        blocks = decode_index(header, head, bytes, file.at(file.bytes() - size));
    }

    MemoryBudget budget;
    InputFile file;
    Header header;
    std::vector<BlockInfo> blocks;
};

Reader::Reader(const std::string& path) : impl_(std::make_unique<Impl>(path)) {}
Reader::~Reader() = default;
Reader::Reader(Reader&&) noexcept = default;

const Header& Reader::header() const { return impl_->header; }
const std::vector<BlockInfo>& Reader::blocks() const { return impl_->blocks; }
std::uint64_t Reader::file_bytes() const { return impl_->file.bytes(); }

void Reader::read_block(std::size_t i, std::vector<WarpTrace>& out) const {
    const BlockInfo& info = impl_->blocks.at(i);
    const Origin origin = impl_->file.at(info.offset);
    thread_local Bytes bytes;
    impl_->budget.check(info.bytes, origin.path, "bytes of a block");
    impl_->file.read(info.offset, info.bytes, bytes);
    const BlockHead head = decode_block(impl_->header, bytes, origin, impl_->budget, out);
    if (head.launch != info.launch || head.first_warp != info.first_warp || head.warps != info.warps ||
        head.records != info.records || head.lane_accesses != info.lane_accesses || head.rays != info.rays)
        refuse(origin, fmt::format("head of block {}", i), "what the index says", "another launch, warp or count");
}

}  // namespace raycache::traces
