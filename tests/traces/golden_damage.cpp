// The smallest golden trace, cut at every length and with every byte changed: through all that read traces, it is
// refused in one line, or the launches that are still whole are recovered.
#include <algorithm>
#include <catch2/catch.hpp>

#include "files.hpp"
#include "tests/folders.hpp"
#include "traces/read_launch.hpp"
#include "traces/reader.hpp"
#include "traces/verify.hpp"

using namespace raycache::traces;

namespace {

using Launches = std::vector<std::vector<WarpTrace>>;

/// As info and replay read: all of the header, then each launch.
Launches launches_of(const std::string& path) {
    const Reader reader(path);
    Launches launches(reader.header().launches.size());
    for (std::uint32_t launch = 0; launch < launches.size(); ++launch)
        read_launch(reader, launch, [&](WarpTrace&& warp) { launches[launch].push_back(std::move(warp)); });
    return launches;
}

bool is_one_line(const std::string& message) {
    return message.find("expected ") != std::string::npos && message.find("found ") != std::string::npos &&
           message.find('\n') == std::string::npos;
}

bool same_warps(const std::vector<WarpTrace>& a, const std::vector<WarpTrace>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const WarpTrace& x, const WarpTrace& y) {
        return x.warp == y.warp && x.records == y.records && x.elements == y.elements;
    });
}

class DamagedTrace {
public:
    explicit DamagedTrace(const std::string& golden)
        : good_(read_file(raycache::test::source_folder() + "traces/golden/good/" + golden)) {
        write_file(damaged_, good_);
        whole_ = launches_of(damaged_);
    }
    const std::vector<std::uint8_t>& good() const { return good_; }

    /// Refused by all readers; recovered, if at all, only launches of the whole trace.
    void check(const std::vector<std::uint8_t>& bytes, const std::string& what) {
        INFO(what);
        write_file(damaged_, bytes);
        CHECK(is_one_line(refusal([&] { verify(damaged_); })));
        CHECK(is_one_line(refusal([&] { launches_of(damaged_); })));
        std::filesystem::remove(saved_);
        const std::string problem = refusal([&] { recover(damaged_, saved_); });
        if (!problem.empty()) {
            CHECK(is_one_line(problem));
            CHECK(!std::filesystem::exists(saved_));
            return;
        }
        ++recovered;
        verify(saved_);
        for (const auto& launch : launches_of(saved_))
            CHECK(std::any_of(whole_.begin(), whole_.end(), [&](const auto& w) { return same_warps(w, launch); }));
    }
    std::size_t recovered = 0;

private:
    TemporaryFolder folder_;
    std::string damaged_ = folder_ / "damaged.rct", saved_ = folder_ / "saved.rct";
    std::vector<std::uint8_t> good_;
    Launches whole_;
};

}  // namespace

TEST_CASE("a golden trace cut at any length is refused, or its whole launches are recovered") {
    for (const char* golden : {"example.rct", "bvh2-depth-first.rct"}) {
        DamagedTrace trace(golden);
        for (std::size_t size = 0; size < trace.good().size(); ++size)
            trace.check({trace.good().begin(), trace.good().begin() + static_cast<std::ptrdiff_t>(size)},
                        std::string(golden) + " cut to " + std::to_string(size) + " bytes");
        CHECK(trace.recovered > 0);  // without its index
    }
}

TEST_CASE("a golden trace with any byte changed is refused, or its whole launches are recovered") {
    DamagedTrace trace("example.rct");
    for (std::size_t at = 0; at < trace.good().size(); ++at)
        for (const unsigned flip : {0x01U, 0x80U, 0xffU}) {
            auto bytes = trace.good();
            bytes[at] ^= static_cast<std::uint8_t>(flip);
            trace.check(bytes, "byte " + std::to_string(at) + " ^ " + std::to_string(flip));
        }
    CHECK(trace.recovered > 0);
}
