#include "traces/accelsim/text_lines.hpp"

#include <fmt/format.h>
#include <lzma.h>

#include <algorithm>
#include <new>

#include "traces/error.hpp"
#include "traces/input_file.hpp"
#include "traces/memory_budget.hpp"
#include "traces/printable.hpp"

namespace raycache::traces {

namespace {
constexpr std::size_t piece_bytes = std::size_t{1} << 16;
constexpr std::size_t most_line_bytes = 1'000'000;
constexpr std::uint64_t most_memory = std::uint64_t{1} << 30;
constexpr std::uint8_t xz_magic[] = {0xfd, '7', 'z', 'X', 'Z', 0};

/// One line of a message, whatever was in the file.
std::string excerpt(std::string_view text) {
    return printable_line(text.substr(0, 60)) + (text.size() > 60 ? "…" : "");
}
}  // namespace

struct TextLines::Impl {
    explicit Impl(const std::string& name) : path(name), file(name) {
        file.read(0, std::min<std::uint64_t>(file.bytes(), sizeof xz_magic), raw);
        compressed = std::equal(raw.begin(), raw.end(), std::begin(xz_magic), std::end(xz_magic));
        if (compressed &&
            lzma_stream_decoder(&stream, std::min(most_memory, memory_limit()), LZMA_CONCATENATED) != LZMA_OK)
            throw std::bad_alloc();
        raw.clear();
    }
    ~Impl() { lzma_end(&stream); }

    /// Appends some text to `text`; false at the end of the file.
    bool fill() {
        if (!compressed) {
            if (!read()) return false;
            text.append(raw.begin(), raw.end());
            return true;
        }
        while (!ended) {
            if (stream.avail_in == 0 && read()) {
                stream.next_in = raw.data();
                stream.avail_in = raw.size();
            }
            const std::size_t before = text.size();
            text.resize(before + piece_bytes);
            stream.next_out = reinterpret_cast<std::uint8_t*>(text.data() + before);
            stream.avail_out = piece_bytes;
            const lzma_ret result = lzma_code(&stream, offset == file.bytes() ? LZMA_FINISH : LZMA_RUN);
            text.resize(text.size() - stream.avail_out);
            ended = result == LZMA_STREAM_END;
            if (result == LZMA_MEMLIMIT_ERROR)
                throw Error(
                    fmt::format("{}: offset {}: expected xz data of a dictionary that fits {}, found {}; compress "
                                "the trace again with a smaller one, or allow more with --memory-limit",
                                path, offset - stream.avail_in, size_text(lzma_memlimit_get(&stream)),
                                size_text(lzma_memusage(&stream))));
            if (!ended && result != LZMA_OK)
                throw Error(fmt::format("{}: offset {}: expected xz data, found {}; copy the file again", path,
                                        offset - stream.avail_in,
                                        result == LZMA_BUF_ERROR ? "the end of the file" : "damaged ones"));
            if (text.size() > before) return true;
        }
        return false;
    }

    bool read() {
        const std::uint64_t size = std::min<std::uint64_t>(piece_bytes, file.bytes() - offset);
        if (size == 0) return false;
        file.read(offset, size, raw);
        offset += size;
        return true;
    }

    std::string path;
    InputFile file;
    Bytes raw;
    std::uint64_t offset = 0;  ///< in the file, of what is read next
    bool compressed = false, ended = false;
    lzma_stream stream = LZMA_STREAM_INIT;
    std::string text;  ///< not yet given, from `at` on
    std::size_t at = 0;
    std::uint64_t line = 0;
};

TextLines::TextLines(const std::string& path) : impl_(std::make_unique<Impl>(path)) {}
TextLines::~TextLines() = default;

bool TextLines::next(std::string_view& line) {
    Impl& i = *impl_;
    std::size_t end = i.text.find('\n', i.at), searched = i.text.size();
    while (end == std::string::npos) {
        i.text.erase(0, i.at);
        searched -= i.at;
        i.at = 0;
        if (i.text.size() > most_line_bytes) {
            ++i.line;
            refuse("line", "at most a million characters", "more");
        }
        if (!i.fill()) {
            if (i.text.empty()) {
                line = {};
                return false;
            }
            i.text += '\n';  // a last line without an end
        }
        end = i.text.find('\n', searched);
        searched = i.text.size();
    }
    line = std::string_view(i.text).substr(i.at, end - i.at);
    if (line.ends_with('\r')) line.remove_suffix(1);
    i.at = end + 1;
    ++i.line;
    return true;
}

void TextLines::refuse(std::string_view what, std::string_view expected, std::string_view found) const {
    throw Error(fmt::format("{}: line {}: {}: expected {}, found {}; write the trace again", impl_->path, impl_->line,
                            what, expected, excerpt(found)));
}

}  // namespace raycache::traces
