#include "traces/accelsim/byte_source.hpp"

#include <fmt/format.h>
#include <lzma.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <new>
#include <string_view>

#include "traces/error.hpp"
#include "traces/input_file.hpp"
#include "traces/memory_budget.hpp"

namespace raycache::traces {

namespace {
using namespace std::string_view_literals;
constexpr std::size_t piece_bytes = std::size_t{1} << 16;
constexpr std::uint64_t most_memory = std::uint64_t{1} << 30;
}  // namespace

/// Decompresses step by step.
class ByteSource::Decompressor {
public:
    enum class Step { more, end, damaged, needs_memory };
    virtual ~Decompressor() = default;
    /// Takes from the front of `in` and puts at the front of `out`; both shrink. `last`: no input follows.
    virtual Step run(std::span<const std::uint8_t>& in, std::span<std::uint8_t>& out, bool last) = 0;
    /// "NEEDED bytes of memory" of a stream that needs more than it may take.
    virtual std::string needed() const { return "more"; }
};

namespace {

using Decompressor = ByteSource::Decompressor;

class Xz : public Decompressor {
public:
    Xz() {
        if (lzma_stream_decoder(&stream_, std::min(most_memory, memory_limit()), LZMA_CONCATENATED) != LZMA_OK)
            throw std::bad_alloc();
    }
    ~Xz() override { lzma_end(&stream_); }

    Step run(std::span<const std::uint8_t>& in, std::span<std::uint8_t>& out, bool last) override {
        stream_.next_in = in.data();
        stream_.avail_in = in.size();
        stream_.next_out = out.data();
        stream_.avail_out = out.size();
        const lzma_ret result = lzma_code(&stream_, last ? LZMA_FINISH : LZMA_RUN);
        in = in.last(stream_.avail_in);
        out = out.last(stream_.avail_out);
        if (result == LZMA_MEMLIMIT_ERROR) return Step::needs_memory;
        return result == LZMA_OK || result == LZMA_BUF_ERROR ? Step::more
               : result == LZMA_STREAM_END                   ? Step::end
                                                             : Step::damaged;
    }
    std::string needed() const override { return size_text(lzma_memusage(&stream_)); }

private:
    lzma_stream stream_ = LZMA_STREAM_INIT;
};

class Gzip : public Decompressor {
public:
    Gzip() {
        constexpr int gzip_alone = 16 + MAX_WBITS;
        if (inflateInit2(&stream_, gzip_alone) != Z_OK) throw std::bad_alloc();
    }
    ~Gzip() override { inflateEnd(&stream_); }

    Step run(std::span<const std::uint8_t>& in, std::span<std::uint8_t>& out, bool last) override {
        if (between_ && !in.empty()) {  // another member follows
            inflateReset(&stream_);
            between_ = false;
        }
        if (between_) return last ? Step::end : Step::more;
        stream_.next_in = const_cast<Bytef*>(in.data());
        stream_.avail_in = static_cast<uInt>(in.size());
        stream_.next_out = out.data();
        stream_.avail_out = static_cast<uInt>(out.size());
        const int result = inflate(&stream_, Z_NO_FLUSH);
        in = in.last(stream_.avail_in);
        out = out.last(stream_.avail_out);
        between_ = result == Z_STREAM_END;
        return result == Z_OK || result == Z_BUF_ERROR || between_ ? Step::more : Step::damaged;
    }

private:
    z_stream stream_{};
    bool between_ = false;
};

class Zstd : public Decompressor {
public:
    Zstd() : stream_(ZSTD_createDStream()) {
        if (!stream_) throw std::bad_alloc();
    }
    ~Zstd() override { ZSTD_freeDStream(stream_); }

    Step run(std::span<const std::uint8_t>& in, std::span<std::uint8_t>& out, bool last) override {
        if (in.empty() && last && between_) return Step::end;
        ZSTD_inBuffer input{in.data(), in.size(), 0};
        ZSTD_outBuffer output{out.data(), out.size(), 0};
        const std::size_t result = ZSTD_decompressStream(stream_, &output, &input);
        in = in.subspan(input.pos);
        out = out.subspan(output.pos);
        if (ZSTD_isError(result)) return Step::damaged;
        between_ = result == 0;
        return Step::more;
    }

private:
    ZSTD_DStream* stream_;  ///< takes at most a window of 128 MiB
    bool between_ = true;
};

}  // namespace

struct ByteSource::Impl {
    explicit Impl(const std::string& name) : path(name), file(name) {
        file.read(0, std::min<std::uint64_t>(file.bytes(), 6), raw);
        if (starts_with(raw, "\xfd\x37zXZ\0"sv)) {
            container = "xz";
            decompressor = std::make_unique<Xz>();
        } else if (starts_with(raw, "\x1f\x8b"sv)) {
            container = "gzip";
            decompressor = std::make_unique<Gzip>();
        } else if (starts_with(raw, "\x28\xb5\x2f\xfd"sv)) {
            container = "zstd";
            decompressor = std::make_unique<Zstd>();
        }
        raw.clear();
    }

    bool read_raw() {
        const std::uint64_t size = std::min<std::uint64_t>(piece_bytes, file.bytes() - offset);
        if (size == 0) return false;
        file.read(offset, size, raw);
        offset += size;
        left = raw;
        return true;
    }

    bool decompress(std::string& out) {
        while (!ended) {
            if (left.empty()) read_raw();
            const bool last = offset == file.bytes();
            const std::size_t before = out.size(), input = left.size();
            out.resize(before + piece_bytes);
            std::span<std::uint8_t> room(reinterpret_cast<std::uint8_t*>(out.data()) + before, piece_bytes);
            const Decompressor::Step step = decompressor->run(left, room, last);
            out.resize(out.size() - room.size());
            const bool stuck = last && left.size() == input && out.size() == before;
            ended = step == Decompressor::Step::end;
            if (step == Decompressor::Step::needs_memory)
                throw Error(
                    fmt::format("{}: offset {}: expected {} data of a dictionary that fits {}, found {}; compress "
                                "the trace again with a smaller one, or allow more with --memory-limit",
                                path, offset - left.size(), container, size_text(std::min(most_memory, memory_limit())),
                                decompressor->needed()));
            if (step == Decompressor::Step::damaged || (stuck && !ended))
                throw Error(fmt::format("{}: offset {}: expected {} data, found {}; copy the file again", path,
                                        offset - left.size(), container,
                                        step == Decompressor::Step::damaged ? "damaged ones" : "the end of the file"));
            if (out.size() > before) return true;
        }
        return false;
    }

    std::string path;
    InputFile file;
    Bytes raw;
    std::span<const std::uint8_t> left;  ///< of raw
    std::uint64_t offset = 0;            ///< in the file, of what is read next
    std::string container;
    std::unique_ptr<Decompressor> decompressor;
    bool ended = false;
};

ByteSource::ByteSource(const std::string& path) : impl_(std::make_unique<Impl>(path)) {}
ByteSource::~ByteSource() = default;

bool ByteSource::read(std::string& out) {
    if (impl_->decompressor) return impl_->decompress(out);
    if (!impl_->read_raw()) return false;
    out.append(impl_->raw.begin(), impl_->raw.end());
    return true;
}

const std::string& ByteSource::container() const { return impl_->container; }

std::string first_bytes(const std::string& path, std::size_t most) {
    ByteSource source(path);
    std::string text;
    while (text.size() < most && source.read(text)) {
    }
    return text.substr(0, most);
}

}  // namespace raycache::traces
