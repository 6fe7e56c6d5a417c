#include "traces/compression.hpp"

#define ZSTD_STATIC_LINKING_ONLY  // for ZSTD_c_literalCompressionMode
#include <xxhash.h>
#include <zstd.h>

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

void decompress(std::span<const std::uint8_t> stored, std::span<std::uint8_t> raw, const Origin& origin) {
    if (raw.empty() && stored.empty()) return;
    const unsigned long long content = ZSTD_getFrameContentSize(stored.data(), stored.size());
    if (content != raw.size())
        refuse(origin, "zstd frame", fmt::format("{} bytes of content", raw.size()),
               content >= ZSTD_CONTENTSIZE_ERROR ? "no readable size" : fmt::format("{} bytes", content));
    const std::size_t size = ZSTD_decompressDCtx(decompressor(), raw.data(), raw.size(), stored.data(), stored.size());
    if (ZSTD_isError(size)) refuse(origin, "zstd frame", "a whole frame", ZSTD_getErrorName(size));
    if (size != raw.size())
        refuse(origin, "zstd frame", fmt::format("{} bytes of content", raw.size()), fmt::format("{} bytes", size));
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
