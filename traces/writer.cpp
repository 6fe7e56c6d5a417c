#include "traces/writer.hpp"

#include "traces/block_index.hpp"
#include "traces/header_codec.hpp"
#include "traces/output_file.hpp"

namespace raycache::traces {

struct Writer::Impl {
    Impl(const std::string& name, const Header& header) : path(name), file(name), cursor(header) {
        file.write(encode_header(header));
    }

    std::string path;
    OutputFile file;
    WarpCursor cursor;
    std::vector<BlockInfo> blocks;
};

Writer::Writer(const std::string& path, const Header& header) : impl_(std::make_unique<Impl>(path, header)) {}
Writer::~Writer() = default;

void Writer::append(const Block& block) {
    if (!impl_->cursor.accepts(block.launch, block.first_warp, block.warps))
        refuse({impl_->path, impl_->file.bytes()}, "block to be written",
               impl_->cursor.done()
                   ? std::string("no more blocks")
                   : fmt::format("launch {} from warp {}", impl_->cursor.launch(), impl_->cursor.warp()),
               fmt::format("launch {} from warp {}, {} warps", block.launch, block.first_warp, block.warps),
               "append the blocks in order of launch and warp");
    impl_->blocks.push_back({impl_->file.bytes(), static_cast<std::uint32_t>(block.bytes.size()), block.launch,
                             block.first_warp, block.warps, block.records, block.lane_accesses, block.rays});
    impl_->file.write(block.bytes);
    impl_->cursor.advance(block.warps);
}

void Writer::finish() {
    if (!impl_->cursor.done())
        refuse({impl_->path, impl_->file.bytes()}, "end of the trace", "every warp of every launch",
               fmt::format("none for launch {} warp {}", impl_->cursor.launch(), impl_->cursor.warp()),
               "append the missing blocks");
    impl_->file.write(encode_index(impl_->blocks));
    impl_->file.commit();
}

std::uint64_t Writer::bytes_written() const { return impl_->file.bytes(); }

}  // namespace raycache::traces
