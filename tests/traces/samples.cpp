#include "samples.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <deque>
#include <span>

#include "traces/reader.hpp"
#include "traces/writer.hpp"

using namespace raycache::traces;

namespace {

Provenance provenance(const char* scene, const Shape& shape) {
    Provenance p;
    p.program = "raycache 0.1.0";
    p.command = "trace --scene \"é\"";
    p.scene = scene;
    p.scene_hash = 0xfedcba9876543210u;
    p.camera = "front";
    p.sequence = "sobol";
    p.decorrelation = "cranley-patterson";
    p.thread_map = "tile";
    p.layout = "bvh2";
    p.spp = 64;
    p.seed = shape.seed;
    p.width = 8;
    p.height = 4;
    p.bounces = 1;
    return p;
}

Header header_of(const char* scene, const Shape& shape) {
    Header header;
    header.provenance = provenance(scene, shape);
    header.warps_per_launch = shape.warps;
    for (std::uint32_t i = 0; i < shape.launches; ++i) header.launches.push_back(7 * i);
    return header;
}

struct Leaf {
    std::uint32_t first = 0, triangles = 0;
};

struct Tree {
    std::vector<std::array<std::uint32_t, 16>> children;  ///< link words
    std::vector<Leaf> leaves;
    std::uint32_t triangles = 0;
};

/// Splits `leaves` leaves among the children of new nodes, depth or breadth first.
Tree random_tree(const Shape& shape, Random& random) {
    Tree tree;
    struct Work {
        std::uint32_t leaves, parent;
        unsigned slot;
    };
    std::deque<Work> work{{std::max(shape.leaves, 2u), no_link, 0}};
    while (!work.empty()) {
        const Work now = shape.breadth_first ? work.front() : work.back();
        shape.breadth_first ? work.pop_front() : work.pop_back();
        std::uint32_t word;
        if (now.leaves == 1) {
            const std::uint32_t size = 1 + random.below(4);
            word = 1u << 30 | tree.triangles;
            tree.leaves.push_back({tree.triangles, size});
            tree.triangles += size;
        } else {
            word = static_cast<std::uint32_t>(tree.children.size());
            tree.children.emplace_back().fill(no_link);
            std::vector<std::uint32_t> parts(std::min<std::uint32_t>(shape.degree, now.leaves), 1);
            for (std::uint32_t rest = now.leaves - static_cast<std::uint32_t>(parts.size()); rest > 0;) {
                const std::uint32_t some = 1 + random.below(rest);
                parts[random.below(static_cast<std::uint32_t>(parts.size()))] += some;
                rest -= some;
            }
            for (unsigned i = 0; i < parts.size(); ++i) {
                const auto slot = shape.breadth_first ? i : static_cast<unsigned>(parts.size()) - 1 - i;
                work.push_back({parts[slot], word, slot});
            }
        }
        if (now.parent != no_link) tree.children[now.parent][now.slot] = word;
    }
    return tree;
}

void add(WarpTrace& warp, std::uint32_t mask, std::uint8_t region, RayType ray, unsigned bounce) {
    warp.records.push_back({mask, region, ray, static_cast<std::uint8_t>(bounce), 0});
}

/// One ray per lane of `mask`, in lock step: nodes while any lane has one, then one leaf each.
void walk(const Tree& tree, unsigned degree, WarpTrace& warp, std::uint32_t mask, RayType ray, unsigned bounce,
          Random& random) {
    add(warp, mask, ray_start, ray, bounce);
    std::array<std::vector<std::uint32_t>, warp_lanes> stack;
    for (unsigned lane = 0; lane < warp_lanes; ++lane)
        if (mask >> lane & 1) stack[lane] = {0};
    const auto at = [&](bool leaf) {
        std::uint32_t lanes = 0;
        for (unsigned lane = 0; lane < warp_lanes; ++lane)
            lanes |= std::uint32_t{!stack[lane].empty() && (stack[lane].back() >> 30 != 0) == leaf} << lane;
        return lanes;
    };
    for (;;) {
        while (const std::uint32_t nodes = at(false)) {
            add(warp, nodes, 0, ray, bounce);
            for (std::uint32_t left = nodes; left != 0; left &= left - 1) {
                auto& own = stack[static_cast<unsigned>(std::countr_zero(left))];
                const std::uint32_t node = own.back();
                own.pop_back();
                warp.elements.push_back(node);
                const unsigned turn = random.below(degree);
                for (unsigned i = 0; i < degree; ++i) {
                    const std::uint32_t child = tree.children[node][(i + turn) % degree];
                    if (child != no_link && random.chance(60)) own.push_back(child);
                }
            }
        }
        const std::uint32_t leaves = at(true);
        if (leaves == 0) return;
        std::array<Leaf, warp_lanes> leaf{};
        std::uint32_t active = leaves;
        for (std::uint32_t left = leaves; left != 0; left &= left - 1) {
            const auto lane = static_cast<unsigned>(std::countr_zero(left));
            const std::uint32_t first = stack[lane].back() & 0x3fffffffu;
            stack[lane].pop_back();
            leaf[lane] = *std::ranges::lower_bound(tree.leaves, first, {}, &Leaf::first);
        }
        while (active != 0) {
            add(warp, active, 1, ray, bounce);
            for (std::uint32_t left = active; left != 0; left &= left - 1) {
                const auto lane = static_cast<unsigned>(std::countr_zero(left));
                warp.elements.push_back(leaf[lane].first++);
                if (--leaf[lane].triangles == 0) active &= ~(1u << lane);
            }
        }
    }
}

template <class Fill>
std::vector<WarpTrace> warps_of(const Shape& shape, Fill fill) {
    std::vector<WarpTrace> warps;
    for (std::uint32_t launch = 0; launch < shape.launches; ++launch)
        for (std::uint32_t warp = 0; warp < shape.warps; ++warp) {
            warps.push_back({launch, warp, {}, {}});
            fill(warps.back());
        }
    return warps;
}

}  // namespace

Sample bvh_walks(const Shape& shape) {
    Random random(shape.seed);
    Tree tree = random_tree(shape, random);
    // A leaf's triangles get their numbers when the leaf is met; look-up needs them in order.
    std::ranges::sort(tree.leaves, {}, &Leaf::first);
    Sample sample{header_of("random tree", shape), {}};
    Region nodes{ObjectKind::node,
                 0x7f5000000000u,
                 32 * shape.degree,
                 32 * shape.degree,
                 static_cast<std::uint32_t>(tree.children.size()),
                 static_cast<std::uint8_t>(shape.degree),
                 {}};
    for (const auto& children : tree.children)
        nodes.links.insert(nodes.links.end(), children.begin(), children.begin() + shape.degree);
    sample.header.regions = {nodes, {ObjectKind::triangle, 0x7f6000000000u, 48, 48, tree.triangles, 0, {}}};
    sample.warps = warps_of(shape, [&](WarpTrace& warp) {
        std::uint32_t alive = 0xffffffffu;
        walk(tree, shape.degree, warp, alive, RayType::camera, 0, random);
        if ((alive &= random.bits() | random.bits()) == 0) return;
        walk(tree, shape.degree, warp, alive, RayType::shadow, 0, random);
        walk(tree, shape.degree, warp, alive, RayType::bounce, 1, random);
    });
    return sample;
}

Sample noise(const Shape& shape) {
    Random random(shape.seed);
    Sample sample{header_of("noise", shape), {}};
    for (unsigned i = 0, count = 1 + random.below(6); i < count; ++i) {
        Region region{static_cast<ObjectKind>(random.below(object_kinds_of(1))),
                      std::uint64_t{i} << 32,
                      16,
                      16,
                      1 + random.below(random.chance(50) ? 5 : 1000),
                      static_cast<std::uint8_t>(random.below(6)),
                      {}};
        if (random.chance(10)) region.count = 0x3fffffffu, region.degree = 0;
        sample.header.regions.push_back(region);
    }
    for (Region& region : sample.header.regions)
        for (std::uint32_t i = 0; i < region.degree * region.count; ++i) {
            const auto to =
                random.below(std::min<std::uint32_t>(3, static_cast<std::uint32_t>(sample.header.regions.size())));
            region.links.push_back(random.chance(20) ? no_link
                                                     : to << 30 | random.below(sample.header.regions[to].count));
        }
    sample.warps = warps_of(shape, [&](WarpTrace& warp) {
        for (std::uint32_t n = random.below(200); n > 0; --n) {
            const std::uint32_t mask = random.chance(50) ? random.bits() & random.bits() : random.bits();
            if (mask == 0) continue;
            const auto region = static_cast<std::uint8_t>(
                random.chance(10) ? ray_start : random.below(static_cast<std::uint32_t>(sample.header.regions.size())));
            const unsigned bounce = random.below(max_bounce + 1);  // drawn first, whatever the compiler
            add(warp, mask, region, static_cast<RayType>(random.below(ray_types)), bounce);
            if (region == ray_start) continue;
            const std::uint32_t count = sample.header.regions[region].count;
            std::uint32_t element = random.below(count);
            for (int lane = std::popcount(mask); lane > 0; --lane) {
                warp.elements.push_back(element);
                element = random.chance(50) ? (element + 1) % count : random.below(count);
            }
        }
    });
    return sample;
}

Sample texel_reads(const Shape& shape) {
    Random random(shape.seed);
    Sample sample{header_of("depth buffer", shape), {}};
    constexpr std::uint32_t width = 512, height = 256, radius = 20;
    sample.header.regions = {{ObjectKind::texel, 0x7f7000000000u, 4, 4, width * height, 0, {}}};
    sample.warps = warps_of(shape, [&](WarpTrace& warp) {
        add(warp, 0xffffffffu, ray_start, RayType::camera, 0);
        for (unsigned read = 0; read < 16; ++read) {
            add(warp, 0xffffffffu, 0, RayType::camera, 0);
            for (unsigned lane = 0; lane < warp_lanes; ++lane) {
                const std::uint32_t row = 100 + lane / 8 + random.below(radius);
                warp.elements.push_back(row * width + 8 * warp.warp + lane % 8 + random.below(radius));
            }
        }
    });
    return sample;
}

Sample wavefront_buffers(const Shape& shape) {
    Random random(shape.seed);
    Sample sample{header_of("wavefront", shape), {}};
    Header& header = sample.header;
    header.provenance.execution = "wavefront";
    header.provenance.order = "morton";
    header.warps_per_launch = 2 * shape.warps;
    header.kernels_per_launch = 2;
    constexpr std::uint32_t slots = 300;
    for (unsigned kind = 0; kind < object_kinds_of(2); ++kind) {
        const std::uint64_t buffer = kind == 6 || kind == 7 || kind == 8 ? kind - 3 : kind;  // shares its addresses
        header.regions.push_back({static_cast<ObjectKind>(kind), buffer << 32, 32, 32, slots, 0, {}});
    }
    Shape all = shape;
    all.warps = header.warps_per_launch;
    sample.warps = warps_of(all, [&](WarpTrace& warp) {
        if (warp.warp % 3 == 2) return;  // no work left
        const std::uint32_t mask = random.bits() | 1;
        const auto access = [&](std::uint8_t region) {
            add(warp, mask, region, RayType::bounce, 1);
            for (int lane = std::popcount(mask); lane > 0; --lane) warp.elements.push_back(random.below(slots));
        };
        for (const std::uint8_t region : {9, 5, 3}) access(region);
        add(warp, mask, ray_start, RayType::bounce, 1);
        for (const std::uint8_t region : {0, 0, 1, 4, 6, 7, 8}) access(region);
    });
    return sample;
}

void write_sample(const Sample& sample, const std::string& path, std::size_t per_block) {
    Writer writer(path, sample.header);
    const std::size_t warps = sample.header.warps_per_launch;
    for (std::size_t launch = 0; launch < sample.header.launches.size(); ++launch)
        for (std::size_t warp = 0; warp < warps; warp += per_block)
            writer.append(encode_block(
                sample.header,
                std::span(sample.warps).subspan(launch * warps + warp, std::min(per_block, warps - warp))));
    writer.finish();
}

std::vector<WarpTrace> read_all(const std::string& path) {
    const Reader reader(path);
    std::vector<WarpTrace> all, block;
    for (std::size_t i = 0; i < reader.blocks().size(); ++i) {
        reader.read_block(i, block);
        all.insert(all.end(), block.begin(), block.end());
    }
    return all;
}
