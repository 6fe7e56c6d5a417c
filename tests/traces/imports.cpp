// Imports as traces: what the lanes of each record read, from traces of other programs that the tests write.
#include <fmt/format.h>
#include <zlib.h>
#include <zstd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <map>

#include "files.hpp"
#include "traces/accelsim/import.hpp"
#include "traces/addresses/address_stream.hpp"
#include "traces/bytes.hpp"
#include "traces/reader.hpp"
#include "traces/verify.hpp"

using namespace raycache::traces;
using Catch::Matchers::Contains;

namespace {

using Addresses = std::vector<std::uint64_t>;

void write_text(const std::string& path, const std::string& text) { write_file(path, {text.begin(), text.end()}); }

struct Access {
    std::uint32_t launch, warp, mask, bytes;
    Addresses addresses;
    bool operator==(const Access&) const = default;
};

std::vector<Access> accesses_of(const std::string& path) {
    verify(path);
    const Reader reader(path);
    std::vector<Access> found;
    std::vector<WarpTrace> warps;
    for (std::size_t b = 0; b < reader.blocks().size(); ++b) {
        reader.read_block(b, warps);
        for (const WarpTrace& warp : warps) {
            const std::uint32_t* element = warp.elements.data();
            for (const Record& record : warp.records) {
                if (!record.is_access()) continue;
                const Region& region = reader.header().regions[record.region];
                Access access{warp.launch, warp.warp, record.mask, region.element_size, {}};
                for (unsigned i = 0; i < record.lanes(); ++i) access.addresses.push_back(region.address(*element++));
                found.push_back(access);
            }
        }
    }
    return found;
}

std::string head(unsigned version = 5, unsigned grid = 1, const std::string& more = {}) {
    return fmt::format(
        "-kernel name = k\n-grid dim = ({},1,1)\n-block dim = (32,1,1)\n-accelsim tracer version = {}\n{}\n#traces "
        "format = x\n\n",
        grid, version, more);
}

std::string block(const std::vector<std::string>& lines, const std::string& between = {}, unsigned x = 0) {
    std::string text =
        fmt::format("#BEGIN_TB\nthread block = {},0,0\n{}warp = 0\ninsts = {}\n", x, between, lines.size());
    for (const std::string& line : lines) text += line + '\n';
    return text + "#END_TB\n";
}

struct Case {
    TemporaryFolder folder;
    std::string path = folder / "k.traceg", out = folder / "k.rct";
    std::vector<ImportedKernel> kernels;

    std::vector<Access> import(const ImportSettings& settings = {}) {
        kernels = import_traceg(path, out, settings);
        return accesses_of(out);
    }
    std::vector<Access> import_text(const std::string& text, const ImportSettings& settings = {}) {
        write_text(path, text);
        return import(settings);
    }
};

/// "OPCODE" at these addresses, in the first lanes.
std::string load(const std::string& opcode, const Addresses& addresses) {
    const std::uint32_t mask = static_cast<std::uint32_t>((std::uint64_t{1} << addresses.size()) - 1);
    std::string line = fmt::format("10 {:x} 1 R4 {} 1 R2 4 0", mask, opcode);
    for (const std::uint64_t address : addresses) line += fmt::format(" {:#x}", address);
    return line + " 0";
}

const std::string one_load = "10 3 1 R4 LDG.E.SYS 1 R2 4 0 0x1000 0x2000 0";
const std::vector<Access> from_one_load{{0, 0, 3, 4, {0x1000, 0x2000}}};

/// A container as Accel-Sim 2 writes it; of frames that say their size, or not.
std::string tracez(const std::vector<std::string>& lines, bool sized) {
    Bytes bytes;
    append(bytes, std::string_view(head(6, 3)));
    append(bytes, std::uint8_t{0});
    append(bytes, std::uint32_t{0});  // no dictionary
    append(bytes, std::uint32_t{2});
    const std::uint64_t warp = bytes.size();
    const auto count = static_cast<std::uint32_t>(lines.size());
    append(bytes, count);
    append(bytes, count);  // a piece a line
    for (const std::string& line : lines) {
        std::vector<std::uint8_t> frame(ZSTD_compressBound(line.size()));
        ZSTD_CCtx* const context = ZSTD_createCCtx();
        ZSTD_CCtx_setParameter(context, ZSTD_c_contentSizeFlag, sized);
        frame.resize(ZSTD_compress2(context, frame.data(), frame.size(), line.data(), line.size()));
        ZSTD_freeCCtx(context);
        append(bytes, static_cast<std::uint32_t>(frame.size()));
        append(bytes, std::span<const std::uint8_t>(frame));
    }
    const std::uint64_t index = bytes.size();
    append(bytes, std::uint32_t{1});
    for (const std::uint32_t x : {2u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 1u, count, count}) append(bytes, x);
    append(bytes, warp);
    for (std::uint32_t i = 0; i < count; ++i) append(bytes, std::uint32_t{1});
    append(bytes, index);
    return {bytes.begin(), bytes.end()};
}

}  // namespace

TEST_CASE("a load is one access, however far apart its lanes are and in whatever order") {
    Case c;
    const std::vector<std::pair<std::string, std::uint32_t>> opcodes{
        {"LDG.E.U8", 1}, {"LDG.E.S16", 2}, {"LDG.E", 4}, {"LDG.E.64", 8}, {"LDG.E.128", 16}, {"LDG.E.256", 32}};
    const std::vector<Addresses> lanes{{0x7f0000000000, 0x7f0200000000},
                                       {0x7f0200000000, 0x7f0000000000, 0x1000},
                                       {0xffffffffffffffe0, 0x20, 0x8000000000000000},
                                       {0x40000000, 0x0, 0xffffffffffffffe0, 0x40000000}};
    for (const auto& [opcode, bytes] : opcodes)
        for (const Addresses& addresses : lanes) {
            INFO(opcode << " " << addresses.front());
            const auto mask = static_cast<std::uint32_t>((1u << addresses.size()) - 1);
            CHECK(c.import_text(head() + block({load(opcode, addresses)})) ==
                  std::vector<Access>{{0, 0, mask, bytes, addresses}});
        }
}

TEST_CASE("loads near each other and those of far arrays keep regions without pages") {
    Case c;
    const Addresses near{0x7f0000000000, 0x7f0000100000}, far{0x7f8000000000, 0x7f8000100000};
    const auto found = c.import_text(head() + block({load("LDG.E.U8", near), load("LDG.E.U8", far)}));
    CHECK(found == std::vector<Access>{{0, 0, 3, 1, near}, {0, 0, 3, 1, far}});
    const Reader reader(c.out);
    for (const Region& region : reader.header().regions) CHECK(region.pages.empty());
}

TEST_CASE("objects that no array has at multiples of their size are read, too") {
    Case c;
    std::vector<std::string> lines;
    for (unsigned k = 0; k < 3; ++k)
        lines.push_back(fmt::format("{:x} 3 1 R{} LDG.E.128 1 R2 16 0 {:#x} {:#x} 0", 16 * k, 8 + 4 * k,
                                    0x1000 + 16 * k, 0x1010 + 16 * k));
    ImportSettings settings;
    settings.fuse = Fuse::always;
    CHECK(c.import_text(head() + block(lines), settings) == std::vector<Access>{{0, 0, 3, 48, {0x1000, 0x1010}}});
}

TEST_CASE("loads whose registers show that none waits for another are one access where they read on") {
    Case c;
    const auto node = [](unsigned first, const std::string& address, const std::string& width = "128") {
        std::vector<std::string> lines;
        for (unsigned k = 0; k < 2; ++k)
            lines.push_back(fmt::format("{:x} 1 1 R{} LDG.E.{} 1 {} 16 0 {:#x} 0", 16 * k, first + 4 * k, width,
                                        address, 0x1000 + (width == "128" ? 16 : 8) * k));
        return block(lines);
    };
    const auto count = [&](const std::string& text, Fuse fuse = Fuse::independent) {
        ImportSettings settings;
        settings.fuse = fuse;
        return c.import_text(head() + text, settings).size();
    };
    CHECK(count(node(8, "R4")) == 1);
    CHECK(count(node(8, "R4"), Fuse::never) == 2);
    CHECK(count(node(8, "R10")) == 2);  // an address that the first one loads
    CHECK(count(node(8, "R7")) == 2);   // its upper half
    const std::string first = "0 1 1 R8 LDG.E.128 1 R4 16 0 0x1000 0",
                      second = "20 1 1 R12 LDG.E.128 1 R4 16 0 0x1010 0";
    CHECK(count(block({first, "10 1 1 R4 IADD3 1 R4 0 0", second})) == 1);
    CHECK(count(block({first, "10 1 1 R20 FFMA 1 R9 0 0", second})) == 2);  // waits for the data
    CHECK(count(node(8, "R4", "64")) == 2);                                 // two loads of 8 B are not one of 16
    CHECK(count(node(8, "R10"), Fuse::always) == 1);
}

TEST_CASE("lanes that read address 0 are counted; loads of nothing else are left out unless asked for") {
    Case c;
    const std::string text = head() + block({load("LDG.E", {0, 0}), load("LDG.E", {0x1000, 0, 0x1004})});
    ImportSettings settings;
    CHECK(c.import_text(text, settings) == std::vector<Access>{{0, 0, 7, 4, {0x1000, 0, 0x1004}}});
    CHECK(c.kernels.front().kernel.null_lanes == 3);
    CHECK(c.kernels.front().kernel.null_loads == 2);
    CHECK(c.kernels.front().kernel.loads == 1);
    settings.null_lanes = NullLanes::drop_lanes;
    CHECK(c.import_text(text, settings) == std::vector<Access>{{0, 0, 5, 4, {0x1000, 0x1004}}});
    settings.null_lanes = NullLanes::keep;
    CHECK(c.import_text(text, settings).size() == 2);
    CHECK(c.kernels.front().kernel.null_lanes == 3);
}

TEST_CASE("traces of tracer versions 2 to 6 are read alike") {
    Case c;
    const std::string cluster = "cluster id = 0,0,0\ncluster cta = 0,0,0\ncluster rank = 0\n";
    CHECK(c.import_text(head(2) + block({"0 0 0 0 " + one_load})) == from_one_load);
    CHECK(c.import_text(head(3) + block({"10 3 1 R4 LDG.E.SYS 1 R2 4 0 0x1000 0x2000"})) == from_one_load);
    CHECK(c.import_text(head(5) + block({one_load}, cluster)) == from_one_load);
    CHECK(c.import_text(head(5) + block({"10 3 1 R4 LDG.E 3 R2 UR4 P0 4 0 0x1000 0x2000 0"})) == from_one_load);
    for (const char* end : {"0 0 NoVal", "0 0 Val 0x1 0x2", "-1 0x7"})
        CHECK(c.import_text(head(6) + block({"10 3 1 R4 LDG.E 2 R2 UR4 4 0 0x1000 0x2000 " + std::string(end)},
                                            cluster)) == from_one_load);
    const std::string said = "-accelsim tracer version = 2\n";
    std::string unsaid = head(2) + block({"0 0 0 0 " + one_load});
    unsaid.erase(unsaid.find(said), said.size());
    CHECK(c.import_text(unsaid) == from_one_load);
    CHECK_THAT(refusal([&] { c.import_text(head(7) + block({one_load})); }), Contains("at most 6"));
}

TEST_CASE("bulk copies, and generic loads of shared and local memory, are no loads of global memory") {
    Case c;
    const std::string windows = "-shmem base_addr = 0x00007f0000000000\n-local mem base_addr = 0x00007e0000000000\n";
    const std::vector<std::string> lines{
        "0 ffffffff 0 UTMALDG.2D 3 UR4 UR8 R2 0x400 2 0x7f5000000000 2 128 4096 0 0 NoVal",
        "10 3 1 R4 LD.E 1 R2 4 0 0x7f0000000010 0x7f0000000014 0 0 NoVal",
        "20 3 1 R4 LD.E 1 R2 4 0 0x7e0000000010 0x7e0000000014 0 0 NoVal",
        "30 3 1 R4 LD.E 1 R2 4 0 0x1000 0x2000 0 0 NoVal",
        "40 3 0 LDGSTS.E.BYPASS.LTC128B.128 2 R217 R22 16 0 0x5000 0x5010 0 0 NoVal"};
    CHECK(c.import_text(head(6, 1, windows) + block(lines)) ==
          std::vector<Access>{{0, 0, 3, 4, {0x1000, 0x2000}}, {0, 0, 3, 16, {0x5000, 0x5010}}});
    CHECK(c.kernels.front().kernel.left_out == std::map<std::string, std::uint64_t>{{"LD", 2}, {"UTMALDG", 1}});
    CHECK(c.kernels.front().kernel.bypassing == 1);
}

TEST_CASE("stores of global memory are writes where they are asked for, and no load is joined across one") {
    Case c;
    const std::string windows = "-shmem base_addr = 0x00007f0000000000\n";
    const std::vector<std::string> lines{
        "0 3 1 R4 LDG.E.128 1 R2 16 1 0x1000 32 0",  "10 3 0 STG.E 2 R2 R4 4 1 0x1000 4 0",
        "20 3 1 R8 LDG.E.128 1 R2 16 1 0x1010 32 0", "30 1 0 ST.E.64 2 R2 R4 8 0 0x2008 0",
        "40 1 0 ST.E 2 R2 R4 4 0 0x7f0000000010 0",  "50 1 0 RED.E.ADD 2 R2 R4 4 0 0x1000 0"};
    ImportSettings settings;
    settings.stores = true;
    for (const Fuse fuse : {Fuse::never, Fuse::independent, Fuse::always}) {
        settings.fuse = fuse;
        CHECK(c.import_text(head(5, 1, windows) + block(lines), settings) ==
              std::vector<Access>{{0, 0, 3, 16, {0x1000, 0x1020}},
                                  {0, 0, 3, 4, {0x1000, 0x1004}},
                                  {0, 0, 3, 16, {0x1010, 0x1030}},
                                  {0, 0, 1, 8, {0x2008}}});
        const TracegKernel& kernel = c.kernels.front().kernel;
        CHECK(kernel.loads == 2);
        CHECK(kernel.stores == 2);
        CHECK(kernel.left_out == std::map<std::string, std::uint64_t>{{"RED", 1}, {"ST", 1}});
        const Reader reader(c.out);
        for (const Region& region : reader.header().regions)
            CHECK(region.kind == (region.element_size == 16 ? ObjectKind::node : ObjectKind::ray_state_write));
    }
    settings.stores = false;
    settings.fuse = Fuse::never;
    CHECK(c.import_text(head(5, 1, windows) + block(lines), settings) ==
          std::vector<Access>{{0, 0, 3, 16, {0x1000, 0x1020}}, {0, 0, 3, 16, {0x1010, 0x1030}}});
    CHECK(c.kernels.front().kernel.left_out == std::map<std::string, std::uint64_t>{{"RED", 1}, {"ST", 2}, {"STG", 1}});
}

TEST_CASE("objects of one size that are read and that are written are told apart at the same addresses") {
    Case c;
    ImportSettings settings;
    settings.stores = true;
    const std::vector<std::string> lines{"0 3 1 R4 LDG.E 1 R2 4 0 0x1000 0xff00000000000000 0",
                                         "10 3 0 STG.E 2 R2 R4 4 0 0x1000 0xff00000000000000 0"};
    CHECK(c.import_text(head() + block(lines), settings).size() == 2);
    const Reader reader(c.out);
    const std::vector<Region>& regions = reader.header().regions;
    REQUIRE(regions.size() == 2);
    CHECK(regions[0].kind == ObjectKind::node);
    CHECK(regions[1].kind == ObjectKind::ray_state_write);
    CHECK(regions[0].address(0) == regions[1].address(0));
}

TEST_CASE("gzip and zstd are told by their first bytes, several members and frames included, and damage is refused") {
    Case c;
    const std::string text = head() + block({one_load});
    const std::size_t half = text.size() / 2;
    const auto zstd = [](std::string_view part) {
        std::string frame(ZSTD_compressBound(part.size()), 0);
        frame.resize(ZSTD_compress(frame.data(), frame.size(), part.data(), part.size(), 1));
        return frame;
    };
    const auto gzip = [](std::string_view part) {
        std::string member(1000 + part.size(), 0);
        z_stream stream{};
        REQUIRE(deflateInit2(&stream, 6, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY) == Z_OK);
        stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(part.data()));
        stream.avail_in = static_cast<uInt>(part.size());
        stream.next_out = reinterpret_cast<Bytef*>(member.data());
        stream.avail_out = static_cast<uInt>(member.size());
        REQUIRE(deflate(&stream, Z_FINISH) == Z_STREAM_END);
        member.resize(stream.total_out);
        deflateEnd(&stream);
        return member;
    };
    for (const auto& compress : {std::function<std::string(std::string_view)>(zstd), {gzip}}) {
        const std::string whole = compress(text);
        CHECK(c.import_text(whole) == from_one_load);
        const std::string_view view = text;
        CHECK(c.import_text(compress(view.substr(0, half)) + compress(view.substr(half))) == from_one_load);
        for (std::size_t size = 4; size < whole.size(); size += 7)
            CHECK_THAT(refusal([&] { c.import_text(whole.substr(0, size)); }), Contains("the end of the file"));
    }
}

TEST_CASE("the container of Accel-Sim 2 is read, and refused where it is cut or damaged") {
    Case c;
    const std::vector<std::string> lines{"10 3 1 R4 LDG.E 1 R2 4 0 0x1000 0x2000 0 0 NoVal",
                                         "20 3 1 R5 LDG.E 1 R2 4 0 0x3000 0x4000 0 0 NoVal"};
    const std::vector<Access> expected{{0, 2, 3, 4, {0x1000, 0x2000}}, {0, 2, 3, 4, {0x3000, 0x4000}}};
    CHECK(c.import_text(tracez(lines, true)) == expected);
    CHECK(c.kernels.front().kernel.empty_ctas == 2);
    const std::string whole = tracez(lines, false);
    CHECK(c.import_text(whole) == expected);
    for (std::size_t size = head(6, 3).size() + 1; size < whole.size(); size += 3) {
        INFO(size);
        CHECK_FALSE(refusal([&] { c.import_text(whole.substr(0, size)); }).empty());
    }
    CHECK_THAT(refusal([&] { c.import_text(tracez({"10 3 1 R4 LDG.E 1 R2 4 0 0x1001 0x2000 0"}, true)); }),
               Contains("instruction 1: address"));
}

TEST_CASE("a list of kernels, or its folder, is a launch a kernel, each with its own warps") {
    Case c;
    const std::string folder = c.folder / "traces";
    std::filesystem::create_directory(folder);
    write_text(folder + "/kernel-1.traceg", head() + block({one_load}));
    write_text(folder + "/kernel-2.traceg", head(5, 3) + block({one_load}, "", 2));
    write_text(folder + "/kernelslist.g", "MemcpyHtoD,0x7f5000000000,4096\nkernel-1.traceg\nkernel-2.traceg\n");
    std::vector<Access> expected = from_one_load;
    expected.push_back({1, 2, 3, 4, {0x1000, 0x2000}});
    for (const std::string& name : {folder, folder + "/", folder + "/kernelslist.g"}) {
        c.path = name;
        CHECK(c.import() == expected);
        CHECK(Reader(c.out).header().warps_per_launch == 3);
    }
    write_text(folder + "/kernelslist.g", "kernel-3.traceg\n");
    CHECK_THAT(refusal([&] { c.import(); }), Contains("kernelslist.g: line 1") && Contains("kernel-3.traceg"));
    std::filesystem::remove(folder + "/kernelslist.g");
    c.path = folder;
    CHECK_THAT(refusal([&] { c.import(); }), Contains("expected a folder with a kernelslist.g"));
}

TEST_CASE("addresses of Dinero, CSV and 64-bit words are reads of one lane") {
    Case c;
    const std::string words("\x40\0\0\0\x50\x7f\0\0\x01\0\0\0\0\0\0\0", 16);
    const auto import = [&](AddressFormat format, const std::string& text, std::uint32_t bytes = 1) {
        write_text(c.path, text);
        import_addresses(c.path, c.out, {format, bytes, "", ""});
        return accesses_of(c.out);
    };
    const std::vector<Access> expected{{0, 0, 1, 1, {0x7f5000000040}}, {0, 0, 1, 1, {1}}};
    CHECK(import(AddressFormat::u64, words) == expected);
    CHECK(import(AddressFormat::dinero, "0 7f5000000040\n1 20\n2 30\n0 0x1\n") == expected);
    CHECK(import(AddressFormat::csv, "139981574111296\n0x1\n") == expected);
    CHECK(import(AddressFormat::csv, "\xef\xbb\xbfobj_id\r\n0x7f5000000040\r\n1\r\n") == expected);
    CHECK(import(AddressFormat::csv, "time,Obj,op\n1,0x7f5000000040,read\n2,7,write\n3,1,read\n") == expected);
    CHECK(import(AddressFormat::csv, "address,size\n0x10,8\n0x1003,4098\n") ==
          std::vector<Access>{{0, 0, 1, 8, {0x10}}, {0, 0, 1, 4096, {0x1003}}, {0, 0, 1, 2, {0x2003}}});
    CHECK(import(AddressFormat::dinero, "0 fff\n", 4) == std::vector<Access>{{0, 0, 1, 4, {0xfff}}});
    CHECK_THAT(refusal([&] { import(AddressFormat::u64, words.substr(0, 9)); }), Contains("1 bytes more"));
    CHECK_THAT(refusal([&] { import(AddressFormat::csv, "1,2,3\n"); }), Contains("3 columns without a header"));
    CHECK_THAT(refusal([&] { import(AddressFormat::csv, "time,what\n1,2\n"); }), Contains("a column address"));
    CHECK_THAT(refusal([&] { import(AddressFormat::dinero, "0 7f5\n0 xyz\n"); }), Contains("line 2"));
    CHECK_THAT(refusal([&] { import(AddressFormat::dinero, "1 20\n"); }), Contains("expected reads"));
}
