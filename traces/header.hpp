// The head of a trace: where it came from, which memory regions it reads, which launches it holds.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "traces/object_kind.hpp"
#include "traces/page_table.hpp"

namespace raycache::traces {

/// A link value that leads nowhere.
inline constexpr std::uint32_t no_link = 0xffffffffu;

/// An array of equal objects in the virtual memory of the imagined GPU; or, with `pages`, the pages that a program used
/// of all its memory, as if they lay one behind the other: then one region has objects however far apart.
struct Region {
    ObjectKind kind = ObjectKind::node;
    std::uint64_t base = 0;          ///< byte address of element 0; a multiple of 2 MiB
    std::uint32_t element_size = 0;  ///< bytes that one access reads, 1 … 4096
    std::uint32_t stride = 0;        ///< bytes from one element to the next, >= element_size
    std::uint32_t count = 0;         ///< elements, 0 … 2^30 - 1

    /// Optional successor table: `degree` (0 … 16) links per element. A BVH node links to its children. The codec
    /// predicts a lane's next access from it, and analyses derive BVH depth from it. A link is (region index << 30) |
    /// element index, or `no_link`. Only regions 0 … 2 can be linked to, elements below 2^30 - 1.
    std::uint8_t degree = 0;
    std::vector<std::uint32_t> links;  ///< degree * count values

    /// Where not empty: element e lies at byte e * stride of these pages in a row. base and degree are 0 then, and the
    /// stride is a power of two, at most a page, and may be less than the size of an element.
    PageTable pages = {};

    std::uint64_t address(std::uint32_t element) const {
        const std::uint64_t byte = std::uint64_t{element} * stride;
        return pages.empty() ? base + byte : pages.address(byte);
    }
    bool operator==(const Region&) const = default;
};

/// How the trace was made, in the words of the command line. Free of anything that does not change the records
/// (thread count, output name, time of day), so equal inputs give equal bytes.
struct Provenance {
    std::string program;           ///< "raycache 0.2.0"
    std::string command;           ///< every option that shapes the records, spelled out
    std::string scene;             ///< file name without folder, or the built-in scene's name and detail
    std::uint64_t scene_hash = 0;  ///< XXH3-64 of the scene's content
    std::string camera;
    std::string sequence;       ///< "sobol"
    std::string decorrelation;  ///< "micro-jitter"; the table calls it the strategy
    std::string parameters;     ///< "K=2.5 s=2 mu=0.078125"; empty if the decorrelation has none
    std::string thread_map;     ///< "tile", "samples", "rows", "classes:8"
    std::string layout;         ///< "bvh2"
    std::uint64_t spp = 0;      ///< N, size of the sample set
    std::uint64_t seed = 0;
    std::uint32_t width = 0, height = 0;  ///< pixels
    std::uint32_t bounces = 0;
    std::string execution = "megakernel";  ///< or "wavefront"
    std::string order = "none";            ///< of the rays of a wavefront

    bool operator==(const Provenance&) const = default;
};

struct Header {
    Provenance provenance;
    std::vector<Region> regions;          ///< 1 … 254
    std::vector<std::uint32_t> launches;  ///< first sample index of each launch
    std::uint32_t warps_per_launch = 0;
    /// Kernels of a launch, one after the other, each with the same number of warps: a kernel begins when its
    /// predecessor has ended, and sees what that wrote. Divides warps_per_launch.
    std::uint32_t kernels_per_launch = 1;
    bool issue = false;  ///< warps say what they wait for, and what they issue beside accesses (WarpTrace::issue)

    std::uint32_t warps_per_kernel() const { return warps_per_launch / kernels_per_launch; }
    bool operator==(const Header&) const = default;
};

}  // namespace raycache::traces
