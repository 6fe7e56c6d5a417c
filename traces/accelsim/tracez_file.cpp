#include "traces/accelsim/tracez_file.hpp"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <memory>
#include <new>

#include "traces/accelsim/traceg_reader.hpp"
#include "traces/error.hpp"
#include "traces/input_file.hpp"

namespace raycache::traces {
namespace {

constexpr std::uint64_t most_header_bytes = 1 << 20;
constexpr std::size_t buffer_bytes = 1 << 16;

/// Values one after the other, read ahead a window at a time.
class Cursor {
public:
    Cursor(const InputFile& file, const std::string& path, std::uint64_t at, std::uint64_t end)
        : file_(file), path_(path), at_(at), end_(end) {}

    template <class T>
    T take() {
        if (end_ - at_ < sizeof(T))
            throw Error(fmt::format("{}: offset {}: expected {} more bytes of a .tracez, found {}; copy the file again",
                                    path_, at_, sizeof(T), end_ - at_));
        if (at_ < from_ || at_ + sizeof(T) > from_ + window_.size()) {
            from_ = at_;
            file_.read(at_, std::min<std::uint64_t>(buffer_bytes, end_ - at_), window_);
        }
        const T value = load<T>(window_.data() + (at_ - from_));
        at_ += sizeof(T);
        return value;
    }
    void skip(std::uint64_t bytes) { at_ += std::min(bytes, end_ - at_); }
    std::uint64_t at() const { return at_; }
    std::uint64_t left() const { return end_ - at_; }

private:
    const InputFile& file_;
    const std::string& path_;
    std::uint64_t at_, end_, from_ = 0;
    Bytes window_;
};

class TracezParser : public TextPlace {
public:
    TracezParser(const std::string& path, const TracegReader::Use& use, const TracegOptions& options)
        : path_(path), file_(path), reader_(use, options), context_(ZSTD_createDCtx(), ZSTD_freeDCtx) {
        if (!context_) throw std::bad_alloc();
    }

    TracegKernel run() {
        const std::uint64_t after = read_header();
        Cursor sizes(file_, path_, after, file_.bytes());
        const auto dictionary = sizes.take<std::uint32_t>();
        sizes.take<std::uint32_t>();
        if (dictionary > sizes.left()) damaged(after, "a dictionary within the file", "a longer one");
        Bytes bytes;
        file_.read(sizes.at(), dictionary, bytes);
        if (dictionary > 0 && ZSTD_isError(ZSTD_DCtx_loadDictionary(context_.get(), bytes.data(), bytes.size())))
            damaged(sizes.at(), "a zstd dictionary", "other bytes");
        if (file_.bytes() < sizeof(std::uint64_t)) damaged(0, "an index", "none");
        const std::uint64_t end = file_.bytes() - sizeof(std::uint64_t);
        const auto index = Cursor(file_, path_, end, file_.bytes()).take<std::uint64_t>();
        if (index > end || index < sizes.at() + dictionary)
            damaged(end, fmt::format("the offset of the index, {} to {}", sizes.at() + dictionary, end),
                    fmt::format("{}", index));
        data_end_ = index;
        Cursor cursor(file_, path_, index, end);
        const auto blocks = cursor.take<std::uint32_t>();
        for (std::uint32_t b = 0; b < blocks; ++b) read_block(cursor);
        return reader_.finish(*this);
    }

    std::string where() const override {
        return at_ < data_end_ ? fmt::format("{}: warp at offset {}, instruction {}", path_, at_, instruction_) : path_;
    }

private:
    [[noreturn]] void damaged(std::uint64_t offset, const std::string& expected, const std::string& found) const {
        throw Error(
            fmt::format("{}: offset {}: expected {}, found {}; copy the file again", path_, offset, expected, found));
    }

    /// Returns the offset behind the byte 0.
    std::uint64_t read_header() {
        Bytes front;
        file_.read(0, std::min(file_.bytes(), most_header_bytes), front);
        const auto end = std::find(front.begin(), front.end(), 0);
        if (end == front.end()) damaged(0, "a header that ends with a byte 0", "none");
        std::string_view text(reinterpret_cast<const char*>(front.data()),
                              static_cast<std::size_t>(end - front.begin()));
        const std::uint64_t after = text.size() + 1;
        for (std::size_t stop; !text.empty(); text.remove_prefix(std::min(stop + 1, text.size()))) {
            stop = std::min(text.find('\n'), text.size());
            if (text[0] == '-') reader_.header_line(text.substr(0, stop), *this);
        }
        reader_.end_header(*this);
        return after;
    }

    void read_block(Cursor& index) {
        reader_.begin_block(*this);
        std::array<std::uint64_t, 3> at{};
        for (std::uint64_t& i : at) i = index.take<std::uint32_t>();
        for (unsigned i = 0; i < 7; ++i) index.take<std::uint32_t>();  // of the cluster
        reader_.coordinates(at, *this);
        const auto warps = index.take<std::uint32_t>();
        for (std::uint32_t w = 0; w < warps; ++w) {
            const auto instructions = index.take<std::uint32_t>(), pieces = index.take<std::uint32_t>();
            const auto offset = index.take<std::uint64_t>();
            if (pieces > index.left() / sizeof(std::uint32_t)) damaged(index.at(), "pieces of a warp", "more than fit");
            index.skip(std::uint64_t{pieces} * sizeof(std::uint32_t));
            at_ = offset;
            instruction_ = 0;
            reader_.begin_warp(w, *this);
            read_warp(offset, instructions);
            at_ = data_end_;
        }
        reader_.end_block();
    }

    void read_warp(std::uint64_t offset, std::uint64_t instructions) {
        if (offset > data_end_) damaged(offset, "a warp before the index", "one behind it");
        Cursor cursor(file_, path_, offset, data_end_);
        const auto announced = cursor.take<std::uint32_t>(), pieces = cursor.take<std::uint32_t>();
        if (announced != instructions)
            damaged(offset, fmt::format("{} instructions, as the index says", instructions),
                    fmt::format("{}", announced));
        for (std::uint32_t p = 0; p < pieces; ++p) {
            const auto size = cursor.take<std::uint32_t>();
            if (size > cursor.left()) damaged(cursor.at(), "a piece before the index", "a longer one");
            read_piece(cursor.at(), size);
            cursor.skip(size);
        }
        if (instruction_ != instructions)
            refuse("warp", fmt::format("{} instructions", instructions), fmt::format("{}", instruction_));
    }

    void read_piece(std::uint64_t offset, std::uint32_t size) {
        file_.read(offset, size, stored_);
        ZSTD_DCtx_reset(context_.get(), ZSTD_reset_session_only);
        ZSTD_inBuffer in{stored_.data(), size, 0};
        text_.clear();
        for (std::size_t left = 1; left != 0;) {
            const std::size_t before = text_.size();
            text_.resize(before + buffer_bytes);
            ZSTD_outBuffer out{text_.data() + before, buffer_bytes, 0};
            const std::size_t taken = in.pos;
            left = ZSTD_decompressStream(context_.get(), &out, &in);
            text_.resize(before + out.pos);
            if (ZSTD_isError(left) || (left != 0 && in.pos == taken && out.pos == 0))
                damaged(offset, "zstd data", ZSTD_isError(left) ? "damaged ones" : "the end of the piece");
            read_lines(left == 0);
        }
        if (in.pos != size) damaged(offset + in.pos, "the end of the piece", "more bytes");
    }

    /// Those that text_ has whole; all of it at the end of a piece.
    void read_lines(bool last) {
        std::size_t at = 0;
        for (std::size_t stop; at < text_.size(); at = stop + 1) {
            stop = text_.find('\n', at);
            if (stop == std::string::npos && !last) break;
            std::string_view line = std::string_view(text_).substr(at, stop - at);
            stop = std::min(stop, text_.size());
            if (line.ends_with('\r')) line.remove_suffix(1);
            if (line.find_first_not_of(" \t") == std::string_view::npos) continue;
            ++instruction_;
            reader_.instruction(line, *this);
        }
        text_.erase(0, at);
        if (text_.size() > most_line_bytes) refuse("line", "at most a million characters", "more");
    }

    std::string path_;
    InputFile file_;
    TracegReader reader_;
    std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context_;
    std::uint64_t data_end_ = 0;              ///< offset of the index
    std::uint64_t at_ = 0, instruction_ = 0;  ///< of the warp that is read, for messages
    Bytes stored_;
    std::string text_;  ///< of the piece, from the first line that was not read
};

}  // namespace

bool looks_like_tracez(const std::string& path) {
    const InputFile file(path);
    Bytes front;
    file.read(0, std::min(file.bytes(), most_header_bytes), front);
    if (!starts_with(front, "-")) return false;
    const auto zero = std::find(front.begin(), front.end(), 0);
    return zero != front.end();
}

TracegKernel parse_tracez(const std::string& path, const std::function<void(std::uint64_t, GlobalLoad&)>& load,
                          const TracegOptions& options) {
    return TracezParser(path, load, options).run();
}

}  // namespace raycache::traces
