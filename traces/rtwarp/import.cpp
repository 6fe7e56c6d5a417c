#include "traces/rtwarp/import.hpp"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string_view>
#include <vector>

#include "traces/accelsim/byte_source.hpp"
#include "traces/error.hpp"
#include "traces/format.hpp"
#include "traces/memory_budget.hpp"
#include "traces/writer.hpp"

namespace raycache::traces {
namespace {

constexpr const char* magic = "RTWARP01";
constexpr std::uint32_t zstd_magic = 0xfd2fb528;
constexpr std::size_t warps_per_block = 64;

/// The bytes of a file, decompressed if need be.
class Input {
public:
    explicit Input(const std::string& path)
        : path_(path), file_(path, std::ios::binary), packed_(ZSTD_DStreamInSize()), stream_(ZSTD_createDStream()) {
        if (!file_ || !std::filesystem::is_regular_file(path))
            throw Error(fmt::format("{}: expected an RTWARP01 trace, found no file to read; check the path", path));
        std::uint32_t start = 0;
        file_.read(reinterpret_cast<char*>(&start), sizeof start);
        zstd_ = file_.gcount() == sizeof start && start == zstd_magic;
        file_.clear();
        file_.seekg(0);
    }

    template <class T>
    T take() {
        T value;
        take(&value, sizeof value);
        return value;
    }
    void take(void* to, std::size_t bytes) {
        char* out = static_cast<char*>(to);
        while (bytes > 0) {
            if (at_ == ready_.size()) refill();
            const std::size_t n = std::min(bytes, ready_.size() - at_);
            std::memcpy(out, ready_.data() + at_, n);
            out += n;
            at_ += n;
            bytes -= n;
            offset_ += n;
        }
    }
    [[noreturn]] void fail(const std::string& expected_and_found) const {
        throw Error(fmt::format("{}: offset {:#x}{}: {}; get the file again", path_, offset_,
                                zstd_ ? " after decompression" : "", expected_and_found));
    }

private:
    void refill() {
        ready_.resize(std::size_t{1} << 17);
        at_ = 0;
        std::size_t got = 0;
        if (!zstd_) {
            file_.read(ready_.data(), static_cast<std::streamsize>(ready_.size()));
            got = static_cast<std::size_t>(file_.gcount());
        }
        while (zstd_ && got == 0) {
            if (in_.pos == in_.size) {
                file_.read(packed_.data(), static_cast<std::streamsize>(packed_.size()));
                in_ = {packed_.data(), static_cast<std::size_t>(file_.gcount()), 0};
                if (in_.size == 0) break;
            }
            ZSTD_outBuffer out{ready_.data(), ready_.size(), 0};
            const std::size_t result = ZSTD_decompressStream(stream_.get(), &out, &in_);
            if (ZSTD_isError(result)) fail(fmt::format("expected zstd data, found: {}", ZSTD_getErrorName(result)));
            got = out.pos;
        }
        ready_.resize(got);
        if (got == 0) fail("expected more data, found the end of the file");
    }

    struct Free {
        void operator()(ZSTD_DStream* stream) const { ZSTD_freeDStream(stream); }
    };
    std::string path_;
    std::ifstream file_;
    bool zstd_ = false;
    std::vector<char> packed_, ready_;
    std::size_t at_ = 0;
    std::uint64_t offset_ = 0;
    ZSTD_inBuffer in_{nullptr, 0, 0};
    std::unique_ptr<ZSTD_DStream, Free> stream_;
};

Header read_header(Input& in) {
    char found[8];
    in.take(found, sizeof found);
    if (std::memcmp(found, magic, sizeof found) != 0) in.fail(fmt::format("expected the magic {}, found none", magic));
    if (const auto size = in.take<std::uint32_t>(); size != 64)
        in.fail(fmt::format("expected a header of 64 bytes, found {}", size));
    Header header;
    header.warps_per_launch = in.take<std::uint32_t>();
    if (header.warps_per_launch == 0 || header.warps_per_launch > format::max_warps_per_launch)
        in.fail(fmt::format("expected 1 to 2^26 warps, found {}", header.warps_per_launch));
    Provenance& p = header.provenance;
    p.width = in.take<std::uint32_t>();
    p.height = in.take<std::uint32_t>();
    header.launches = {in.take<std::uint32_t>()};
    p.spp = in.take<std::uint32_t>();
    const auto mu = in.take<float>();
    const auto strategy = in.take<std::uint32_t>();
    static constexpr const char* strategies[] = {"coherent", "cranley-patterson", "micro-jitter"};
    if (strategy >= std::size(strategies)) in.fail(fmt::format("expected a strategy of 0 to 2, found {}", strategy));
    p.decorrelation = strategies[strategy];
    p.sequence = "sobol";
    p.thread_map = "tile";
    p.layout = "bvh2";
    if (strategy == 2) p.parameters = fmt::format("mu={}", mu);
    header.regions.resize(2);
    for (Region& region : header.regions) {
        region.element_size = region.stride = in.take<std::uint32_t>();
        if (region.stride == 0 || region.stride > 4096)
            in.fail(fmt::format("expected objects of 1 to 4096 bytes, found {}", region.stride));
    }
    for (Region& region : header.regions) {
        region.base = in.take<std::uint64_t>();
        if (region.base >= format::max_address)
            in.fail(fmt::format("expected objects below address 2^48, found them at {:#x}", region.base));
    }
    header.regions[1].kind = ObjectKind::triangle;
    return header;
}

WarpTrace read_warp(Input& in, std::uint32_t number, Header& header, MemoryBudget& budget, const std::string& file) {
    constexpr const char* what = "its records";
    WarpTrace warp;
    budget.charge(2 * sizeof(WarpTrace), file, what);  // the list of warps grows by doubling
    warp.warp = number;
    const auto records = in.take<std::uint32_t>();
    in.take<std::uint32_t>();  // bytes of them
    for (std::uint32_t i = 0; i < records; ++i) {
        const auto tag = in.take<std::uint8_t>();
        Record record;
        record.mask = in.take<std::uint32_t>();
        if (record.mask == 0) in.fail("expected active lanes, found a mask of 0");
        record.bounce = tag & 3;
        record.ray = tag & 4 ? RayType::shadow : tag & 3 ? RayType::bounce : RayType::camera;
        record.region = tag & 0x80 ? ray_start : tag & 0x40 ? 1 : 0;
        budget.charge(sizeof(Record) + (record.is_access() ? record.lanes() * sizeof(std::uint32_t) : 0), file, what);
        warp.records.push_back(record);
        if (!record.is_access()) continue;
        Region& region = header.regions[record.region];
        for (unsigned lane = 0; lane < record.lanes(); ++lane) {
            const auto element = in.take<std::uint32_t>();
            if (element >= format::max_elements)
                in.fail(fmt::format("expected an index below 2^30 - 1, found {}", element));
            warp.elements.push_back(element);
            region.count = std::max(region.count, element + 1);
        }
    }
    warp.records.shrink_to_fit();
    warp.elements.shrink_to_fit();
    return warp;
}

/// A region starts at a multiple of 2 MiB; the objects of the file need not.
void align(Region& region, std::vector<WarpTrace>& warps, std::uint8_t number, Input& in) {
    const std::uint64_t beyond = region.base % format::region_alignment;
    if (beyond % region.stride != 0)
        in.fail(fmt::format("expected objects at a multiple of their {} bytes above a multiple of 2 MiB, found {:#x}",
                            region.stride, region.base));
    const auto skipped = static_cast<std::uint32_t>(beyond / region.stride);
    if (skipped == 0) return;
    if (region.count > format::max_elements - skipped)
        in.fail(fmt::format("expected indices below {} from address {:#x} on, found {}", format::max_elements - skipped,
                            region.base, region.count - 1));
    region.base -= beyond;
    region.count += skipped;
    for (WarpTrace& warp : warps) {
        std::uint32_t* element = warp.elements.data();
        for (const Record& record : warp.records) {
            if (!record.is_access()) continue;
            if (record.region == number)
                for (unsigned lane = 0; lane < record.lanes(); ++lane) element[lane] += skipped;
            element += record.lanes();
        }
    }
}

}  // namespace

bool looks_like_rtwarp(const std::string& path) {
    constexpr std::size_t bytes = 8;
    return first_bytes(path, bytes) == std::string_view(magic, bytes);
}

void import_rtwarp(const std::string& input, const std::string& output, const std::string& program,
                   const std::string& command) {
    Input in(input);
    Header header = read_header(in);
    header.provenance.program = program;
    header.provenance.command = command;
    // The same for all strategies of one picture, so that they can be compared.
    header.provenance.scene = fmt::format("rtwarp {}x{}", header.provenance.width, header.provenance.height);
    MemoryBudget budget;
    std::vector<WarpTrace> warps;
    for (std::uint32_t w = 0; w < header.warps_per_launch; ++w)
        warps.push_back(read_warp(in, w, header, budget, input));
    for (std::uint8_t region = 0; region < 2; ++region) align(header.regions[region], warps, region, in);
    Writer writer(output, header);
    for (std::size_t w = 0; w < warps.size(); w += warps_per_block)
        writer.append(encode_block(header, std::span(warps).subspan(w, std::min(warps_per_block, warps.size() - w))));
    writer.finish();
}

}  // namespace raycache::traces
