#include "tracer/scene/gltf_container.hpp"

#include <fmt/format.h>

#include "traces/regular_file.hpp"

namespace raycache::tracer {

namespace {

constexpr std::uint32_t json_chunk = 0x4E4F534A, bin_chunk = 0x004E4942;
constexpr std::size_t header_bytes = 12, chunk_header_bytes = 8;

std::uint32_t little_endian32(const std::vector<std::uint8_t>& bytes, std::size_t at) {
    return bytes[at] | std::uint32_t{bytes[at + 1]} << 8 | std::uint32_t{bytes[at + 2]} << 16 |
           std::uint32_t{bytes[at + 3]} << 24;
}

void split_glb(GltfContainer& file, const GltfReport& report) {
    const std::size_t size = file.bytes.size();
    const auto truncated = [&](const std::string& where, std::size_t expected) {
        report.fail(where, fmt::format("at least {} bytes in the file", expected), fmt::format("{}", size),
                    "the file is truncated, copy it again");
    };
    constexpr const char* wrong_header =
        "its lengths contradict each other: the file was written wrongly, export it again";
    if (size < header_bytes + chunk_header_bytes) truncated("GLB header", header_bytes + chunk_header_bytes);
    const std::uint32_t version = little_endian32(file.bytes, 4), length = little_endian32(file.bytes, 8);
    if (version != 2)
        report.fail("GLB header", "version 2", fmt::format("version {}", version), "convert it to glTF 2.0");
    if (length > size) truncated("GLB header", length);
    const auto too_short = [&](std::size_t needed) {
        report.fail("GLB header", fmt::format("a length of at least {} bytes, that of its chunks", needed),
                    fmt::format("{} in a file of {}", length, size), wrong_header);
    };
    if (length < header_bytes + chunk_header_bytes) too_short(header_bytes + chunk_header_bytes);

    std::size_t at = header_bytes;
    for (int chunk = 0; at + chunk_header_bytes <= size; ++chunk) {
        const std::size_t chunk_bytes = little_endian32(file.bytes, at);
        const std::uint32_t type = little_endian32(file.bytes, at + 4);
        if (at >= length && (chunk != 1 || type != bin_chunk)) break;  // something else follows the scene
        at += chunk_header_bytes;
        const std::string where = fmt::format("GLB chunk {}", chunk);
        if (chunk_bytes > size - at) {
            if (length < size || chunk == 0)
                report.fail(where, fmt::format("a length of at most {} bytes", size - at),
                            fmt::format("{}", chunk_bytes), wrong_header);
            truncated(where, at + chunk_bytes);
        }
        if (at + chunk_bytes > length) too_short(at + chunk_bytes);
        if (chunk_bytes % 4 != 0)
            report.warning(
                fmt::format("{}: its length of {} bytes is no multiple of 4; read as it is", where, chunk_bytes));
        const std::span<const std::uint8_t> content(file.bytes.data() + at, chunk_bytes);
        if (chunk == 0 && type != json_chunk)
            report.fail("GLB chunk 0", "type JSON (0x4e4f534a)", fmt::format("{:#010x}", type));
        if (chunk == 0 && chunk_bytes == 0) break;
        if (chunk == 0) file.json = {reinterpret_cast<const char*>(content.data()), content.size()};
        if (chunk == 1 && type == bin_chunk) file.bin = content;
        at += chunk_bytes;
    }
    if (file.json.empty()) report.fail("GLB chunk 0", "a JSON text", "nothing");
}

}  // namespace

GltfContainer read_gltf_container(const GltfReport& report) {
    GltfContainer file;
    file.bytes = read_regular_file(report.path(), "scene file", report.memory().get());
    const std::string_view text(reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size());
    if (text.empty()) report.fail("scene file", "a glTF 2.0 file", "an empty file", "copy or export it again");
    if (text.starts_with("glTF")) {
        split_glb(file, report);
        return file;
    }
    const std::size_t start = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;  // byte order mark
    const std::size_t brace = text.find_first_not_of(" \t\r\n", start);
    if (brace == std::string_view::npos || text[brace] != '{')
        report.fail("scene file", "a glTF 2.0 file: \"glTF\" (.glb) or \"{\" (.gltf) at its start",
                    fmt::format("byte {:#04x}", file.bytes[brace == std::string_view::npos ? 0 : brace]),
                    "convert the scene to glTF 2.0");
    file.json = text.substr(start);
    return file;
}

}  // namespace raycache::tracer
