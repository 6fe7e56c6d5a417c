#include "traces/compression.hpp"

#define ZSTD_STATIC_LINKING_ONLY  // for ZSTD_c_literalCompressionMode
#include <xxhash.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <memory>
#include <new>
#include <string>

#include "traces/format.hpp"

namespace raycache::traces {
namespace {

struct FreeContext {
    void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

void set(ZSTD_CCtx* context, ZSTD_cParameter parameter, int value) {
    const std::size_t result = ZSTD_CCtx_setParameter(context, parameter, value);
    if (ZSTD_isError(result))
        throw Error(fmt::format("zstd refused parameter {}: {}", int(parameter), ZSTD_getErrorName(result)));
}

/// One context per effort: to change the parameters of one costs more than to compress a small block.
ZSTD_CCtx* compressor(Effort effort) {
    thread_local std::array<std::unique_ptr<ZSTD_CCtx, FreeContext>, 3> contexts;
    auto& context = contexts[static_cast<unsigned>(effort)];
    if (context) return context.get();
    context.reset(ZSTD_createCCtx());
    if (!context) throw std::bad_alloc();
    set(context.get(), ZSTD_c_compressionLevel, effort == Effort::small ? 3 : 1);
    if (effort == Effort::entropy) {
        set(context.get(), ZSTD_c_targetLength, 1024);  // at this level: bytes to skip after a failed look-up
        set(context.get(), ZSTD_c_literalCompressionMode, ZSTD_ps_enable);
    }
    return context.get();
}

ZSTD_DCtx* decompressor() {
    thread_local const std::unique_ptr<ZSTD_DCtx, FreeContext> context(ZSTD_createDCtx());
    if (!context) throw std::bad_alloc();
    return context.get();
}

}  // namespace

std::size_t compress(std::span<const std::uint8_t> raw, Effort effort, Bytes& out) {
    if (raw.empty()) return 0;
    const std::size_t before = out.size();
    out.resize(before + ZSTD_compressBound(raw.size()));
    const std::size_t size =
        ZSTD_compress2(compressor(effort), out.data() + before, out.size() - before, raw.data(), raw.size());
    if (ZSTD_isError(size)) throw Error(fmt::format("zstd could not compress: {}", ZSTD_getErrorName(size)));
    out.resize(before + size);
    return size;
}

void check_content_size(std::span<const std::uint8_t> stored, std::uint64_t size, const Origin& origin) {
    if (size == 0 && stored.empty()) return;
    const unsigned long long content = ZSTD_getFrameContentSize(stored.data(), stored.size());
    if (content != size)
        refuse(origin, "zstd frame", fmt::format("{} bytes of content", size),
               content >= ZSTD_CONTENTSIZE_ERROR ? "no readable size" : fmt::format("{} bytes", content));
}

void decompress(std::span<const std::uint8_t> stored, std::uint64_t size, const Origin& origin, Bytes& raw) {
    check_content_size(stored, size, origin);
    raw.resize(size);
    if (stored.empty()) return;
    const std::size_t found = ZSTD_decompressDCtx(decompressor(), raw.data(), raw.size(), stored.data(), stored.size());
    if (ZSTD_isError(found)) refuse(origin, "zstd frame", "a whole frame", ZSTD_getErrorName(found));
    if (found != size)
        refuse(origin, "zstd frame", fmt::format("{} bytes of content", size), fmt::format("{} bytes", found));
}

std::uint64_t pieces_memory(std::span<const std::uint8_t> stored) {
    if (stored.empty()) return 0;
    const std::size_t bytes = ZSTD_estimateDStreamSize_fromFrame(stored.data(), stored.size());
    return ZSTD_isError(bytes) ? 0 : bytes;  // not readable: refused when it is read
}

void decompress_pieces(std::span<const std::uint8_t> stored, std::uint64_t size, const Origin& origin,
                       const std::function<void(std::span<const std::uint8_t>)>& use) {
    if (size == 0 && stored.empty()) return;
    check_content_size(stored, size, origin);
    ZSTD_DCtx_reset(decompressor(), ZSTD_reset_session_only);
    // pieces_memory() bounds the window, which is as large as the content of a frame in a single segment.
    ZSTD_DCtx_setParameter(decompressor(), ZSTD_d_windowLogMax, ZSTD_WINDOWLOG_MAX);
    Bytes piece(std::clamp<std::uint64_t>(size, 1, ZSTD_DStreamOutSize()));
    ZSTD_inBuffer in{stored.data(), stored.size(), 0};
    std::uint64_t done = 0;
    for (std::size_t left = 1; left != 0;) {
        ZSTD_outBuffer out{piece.data(), piece.size(), 0};
        const std::size_t before = in.pos;
        left = ZSTD_decompressStream(decompressor(), &out, &in);
        if (ZSTD_isError(left)) refuse(origin, "zstd frame", "a whole frame", ZSTD_getErrorName(left));
        if (left != 0 && out.pos == 0 && in.pos == before)
            refuse(origin, "zstd frame", "a whole frame", "the end of the stored bytes");
        done += out.pos;
        if (done > size) break;
        use(std::span(piece).first(out.pos));
    }
    if (done != size)
        refuse(origin, "zstd frame", fmt::format("{} bytes of content", size), fmt::format("{} bytes", done));
    if (in.pos != in.size)
        refuse(origin, "zstd frame", fmt::format("{} bytes", in.pos), fmt::format("{} bytes", in.size));
}

std::uint64_t checksum(std::span<const std::uint8_t> bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

void check_sealed(std::span<const std::uint8_t> whole, const Origin& origin, std::string_view what,
                  std::string_view remedy) {
    const auto body = whole.first(whole.size() - format::checksum_bytes);
    const std::uint64_t stored = load<std::uint64_t>(whole.data() + body.size());
    const std::uint64_t computed = checksum(body);
    if (stored != computed)
        refuse(origin, fmt::format("checksum of the {}", what), hex64(stored), hex64(computed), remedy);
}

void seal(Bytes& bytes) { append(bytes, checksum(bytes)); }

}  // namespace raycache::traces
