#include "reference_trace.hpp"

#include <zstd.h>

#include <bit>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace raycache::cachesim::test {

namespace {

std::string decompressed(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string packed{std::istreambuf_iterator<char>(file), {}};
    std::string bytes, piece(ZSTD_DStreamOutSize(), '\0');
    ZSTD_DStream* stream = ZSTD_createDStream();
    ZSTD_inBuffer in{packed.data(), packed.size(), 0};
    while (in.pos < in.size) {
        ZSTD_outBuffer out{piece.data(), piece.size(), 0};
        if (ZSTD_isError(ZSTD_decompressStream(stream, &out, &in))) break;
        bytes.append(piece.data(), out.pos);
    }
    ZSTD_freeDStream(stream);
    if (bytes.size() < 64 || bytes.compare(0, 8, "RTWARP01") != 0)
        throw std::runtime_error(path + ": no RTWARP01 trace");
    return bytes;
}

template <class T>
T take(const std::string& bytes, std::size_t& at) {
    T value;
    if (at + sizeof value > bytes.size()) throw std::runtime_error("reference trace ends early");
    std::memcpy(&value, bytes.data() + at, sizeof value);
    at += sizeof value;
    return value;
}

}  // namespace

Launch read_rtwarp(const std::string& path) {
    const std::string bytes = decompressed(path);
    std::size_t at = 12;
    const auto warps = take<std::uint32_t>(bytes, at);
    at = 40;
    Launch launch{std::vector<traces::Region>(2), {}};
    for (traces::Region& region : launch.regions) region.element_size = region.stride = take<std::uint32_t>(bytes, at);
    for (traces::Region& region : launch.regions) region.base = take<std::uint64_t>(bytes, at);
    launch.regions[1].kind = traces::ObjectKind::triangle;
    for (std::uint32_t w = 0; w < warps; ++w) {
        auto warp = std::make_shared<traces::WarpTrace>();
        warp->warp = w;
        const auto records = take<std::uint32_t>(bytes, at);
        take<std::uint32_t>(bytes, at);
        for (std::uint32_t i = 0; i < records; ++i) {
            const auto tag = take<std::uint8_t>(bytes, at);
            traces::Record record;
            record.mask = take<std::uint32_t>(bytes, at);
            record.bounce = tag & 3;
            record.ray = tag & 4   ? traces::RayType::shadow
                         : tag & 3 ? traces::RayType::bounce
                                   : traces::RayType::camera;
            record.region = tag & 0x80 ? traces::ray_start : tag & 0x40 ? 1 : 0;
            warp->records.push_back(record);
            if (!record.is_access()) continue;
            traces::Region& region = launch.regions[record.region];
            for (unsigned lane = 0; lane < record.lanes(); ++lane) {
                warp->elements.push_back(take<std::uint32_t>(bytes, at));
                region.count = std::max(region.count, warp->elements.back() + 1);
            }
        }
        warp->records.shrink_to_fit();
        warp->elements.shrink_to_fit();
        launch.warps.push_back(std::move(warp));
    }
    return launch;
}

}  // namespace raycache::cachesim::test
