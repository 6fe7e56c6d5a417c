// A replay package: what a GPU needs to walk the rays of a capture through its BVH, and what must come out. A folder of
// files, docs/gpu_package.md has their bytes: bvh.rcgp, and launch-N.rcgp for each launch. Written by `raycache capture
// --gpu-package DIR`, read by tools/gpu/.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tools/gpu/walk_ray.hpp"

namespace raycache::gpu {

/// How nodes lie in memory: by the number of children. Stored in the file.
enum class TreeKind : std::uint32_t { bvh2 = 2, bvh4 = 4, cwbvh8 = 8 };

/// Rays that the lanes of one warp start together, lowest lane first. Stored in the file.
struct Batch {
    std::uint32_t mask;       ///< lanes; never 0
    std::uint32_t first_ray;  ///< entry of the launch's rays: that of the lowest lane
    std::uint32_t warp;       ///< of the launch; of a wavefront, of its kernel
    std::uint8_t type;        ///< traces::RayType: 0 camera, 1 bounce, 2 shadow
    std::uint8_t bounce;
    std::uint16_t reserved;  ///< 0

    bool any_hit() const { return type == 2; }
    bool operator==(const Batch&) const = default;
};
static_assert(sizeof(Batch) == 16, "as in the file");
static_assert(sizeof(Hit) == 8, "as in the file");

/// In the order of their files' sections.
struct BvhPart {
    std::span<const std::uint8_t> nodes, triangles;
};
struct LaunchPart {
    std::span<const Batch> batches;  ///< in the order in which warps start them
    std::span<const PackedRay> rays;
    std::span<const Hit> hits;                   ///< expected of each ray
    std::span<const std::uint32_t> hole_firsts;  ///< one more than rays: see HoleList
    std::span<const std::uint32_t> hole_triangles;
};

/// What the head of bvh.rcgp says.
struct PackageHead {
    std::uint64_t id = 0;  ///< of all files of a package, and of no other: XXH3-64 of provenance and buffers
    std::uint32_t launches = 0;
    TreeKind tree = TreeKind::bvh2;
    bool wavefront = false;  ///< warps are those of kernels; a megakernel's paths are not in it
    std::string provenance;  ///< JSON: traces[] of docs/json.md
};

struct LaunchHead {
    std::uint32_t ordinal = 0, first_index = 0;  ///< first_index: its (first) sample index
    std::uint32_t warps = 0;                     ///< of a megakernel's launch, or of each kernel of a wavefront
};

inline constexpr const char* bvh_file = "bvh.rcgp";
std::string launch_file(std::uint32_t ordinal);  ///< "launch-3.rcgp"
/// All files of a package, in the order in which they are written: the BVH last, without which there is none.
std::vector<std::string> package_files(const std::string& folder, std::uint32_t launches);

/// `name`: of the layout whose nodes they are (LayoutMemory::tree). Throws Error for one without a walk here.
TreeKind tree_kind(const std::string& name);
std::string to_string(TreeKind);

/// Writes id.
void identify(PackageHead&, const BvhPart&);

/// Each writes one whole file or none. Throw Error.
void write_launch(const std::string& folder, const PackageHead&, const LaunchHead&, const LaunchPart&);
void write_bvh_part(const std::string& folder, const PackageHead&, const BvhPart&);

/// A file read as a whole; the parts point into it.
class PackageFile {
public:
    /// Throws Error where it is none of this version, not whole, or damaged. `kind`: file_kind_….
    PackageFile(const std::string& path, std::uint32_t kind);

    std::uint64_t id() const { return id_; }
    std::uint32_t number(unsigned i) const { return numbers_[i]; }
    const std::string& text() const { return text_; }
    std::span<const std::uint8_t> section(unsigned i) const { return sections_[i]; }
    const std::string& path() const { return path_; }
    std::uint64_t bytes() const { return bytes_.size(); }

private:
    std::string path_, text_;
    std::vector<std::uint8_t> bytes_;
    std::uint64_t id_ = 0;
    std::array<std::uint32_t, 4> numbers_{};
    std::vector<std::span<const std::uint8_t>> sections_;
};

/// The BVH of a package, checked: whole, and a tree, so that a walk ends.
class BvhFile {
public:
    explicit BvhFile(const std::string& folder);  ///< throws Error
    const PackageHead& head() const { return head_; }
    const BvhPart& part() const { return part_; }
    /// Entries of the walk's stack that this tree can need.
    std::uint32_t stack_entries() const { return stack_entries_; }

private:
    PackageFile file_;
    PackageHead head_;
    BvhPart part_;
    std::uint32_t stack_entries_ = 0;
};

/// A launch of it, checked: whole, of that package, and every batch within its rays.
class LaunchFile {
public:
    LaunchFile(const std::string& folder, const BvhFile&, std::uint32_t ordinal);  ///< throws Error
    const LaunchHead& head() const { return head_; }
    const LaunchPart& part() const { return part_; }

private:
    PackageFile file_;
    LaunchHead head_;
    LaunchPart part_;
};

}  // namespace raycache::gpu
