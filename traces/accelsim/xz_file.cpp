#include "traces/accelsim/xz_file.hpp"

#include <lzma.h>

#include <array>
#include <new>
#include <span>

#include "traces/output_file.hpp"

namespace raycache::traces {

struct XzFile::Impl {
    explicit Impl(const std::string& path) : file(path), compressed(path.ends_with(".xz")) {
        // Preset 1: these texts shrink to a few percent at any preset, and higher ones take many times as long.
        if (compressed && lzma_easy_encoder(&stream, 1, LZMA_CHECK_CRC64) != LZMA_OK) throw std::bad_alloc();
    }
    ~Impl() { lzma_end(&stream); }

    void code(std::string_view text, lzma_action action) {
        stream.next_in = reinterpret_cast<const std::uint8_t*>(text.data());
        stream.avail_in = text.size();
        std::array<std::uint8_t, 1 << 16> out;
        lzma_ret result = LZMA_OK;
        do {
            stream.next_out = out.data();
            stream.avail_out = out.size();
            result = lzma_code(&stream, action);
            if (result != LZMA_OK && result != LZMA_STREAM_END) throw std::bad_alloc();  // nothing else can happen
            file.write(std::span<const std::uint8_t>(out.data(), out.size() - stream.avail_out));
        } while (action == LZMA_FINISH ? result != LZMA_STREAM_END : stream.avail_in > 0);
    }

    OutputFile file;
    bool compressed;
    lzma_stream stream = LZMA_STREAM_INIT;
};

XzFile::XzFile(const std::string& path) : impl_(std::make_unique<Impl>(path)) {}
XzFile::~XzFile() = default;

void XzFile::write(std::string_view text) {
    if (impl_->compressed)
        impl_->code(text, LZMA_RUN);
    else
        impl_->file.write(text);
}

void XzFile::commit() {
    if (impl_->compressed) impl_->code({}, LZMA_FINISH);
    impl_->file.commit();
}

}  // namespace raycache::traces
