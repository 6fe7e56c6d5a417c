// Trees of more than two children: how the binary tree is collapsed, and what layouts bvh4 and cwbvh8 make of it.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "embree_comparison.hpp"
#include "tracer/bvh/layouts/bvh4.hpp"
#include "tracer/bvh/layouts/cwbvh8.hpp"
#include "tracer/bvh/layouts/node_order.hpp"
#include "tracer/bvh/wide_tree.hpp"
#include "tracer/simt/warp_traversal.hpp"
#include "traces/error.hpp"
#include "trees.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

double surface(const Box& box) {
    const Vec3 d = box.upper - box.lower;
    return double{d.x} * d.y + double{d.y} * d.z + double{d.z} * d.x;
}

/// A visit to a node, as to a triangle, costs its box's surface.
double cost(const Bvh& bvh, const WideTree& tree) {
    double sum = 0;
    for (const WideTree::Node& node : tree.nodes) sum += surface(bvh.nodes[node.node].box);
    for (const WideTree::Child& child : tree.children) sum += surface(bvh.nodes[child.node].box) * child.count;
    return sum;
}

std::uint32_t triangles_below(const Bvh& bvh, std::uint32_t node) {
    const Bvh::Node& n = bvh.nodes[node];
    return n.is_leaf() ? n.count : triangles_below(bvh, node + 1) + triangles_below(bvh, n.first);
}

/// Each inner node of the binary tree is kept, left out, or made a leaf with all below: the least cost of all ways that
/// leave no node with too many children.
double least_cost(const Bvh& bvh, unsigned width, std::uint32_t max_leaf_size) {
    std::vector<std::uint32_t> inner;
    for (std::uint32_t i = 1; i < bvh.nodes.size(); ++i)
        if (!bvh.nodes[i].is_leaf()) inner.push_back(i);
    std::vector<int> fate(bvh.nodes.size(), 0);  // 0: kept, 1: left out, 2: a leaf
    double best = std::numeric_limits<double>::infinity();
    const auto ways = static_cast<std::size_t>(std::pow(3.0, inner.size()));
    for (std::size_t way = 0; way < ways; ++way) {
        std::size_t rest = way;
        for (const std::uint32_t i : inner) {
            fate[i] = static_cast<int>(rest % 3);
            rest /= 3;
        }
        double sum = 0;
        bool allowed = true;
        // Returns the number of children that the node above gets.
        const std::function<unsigned(std::uint32_t)> visit = [&](std::uint32_t node) -> unsigned {
            const Bvh::Node& n = bvh.nodes[node];
            if (n.is_leaf() || fate[node] == 2) {
                const std::uint32_t count = triangles_below(bvh, node);
                allowed = allowed && count <= max_leaf_size;
                sum += surface(n.box) * count;
                return 1;
            }
            const unsigned children = visit(node + 1) + visit(n.first);
            if (fate[node] == 1) return children;
            allowed = allowed && children <= width;
            sum += surface(n.box);
            return 1;
        };
        visit(0);
        if (allowed) best = std::min(best, sum);
    }
    return best;
}

void check_whole(const Bvh& bvh, const WideTree& tree, unsigned width, std::uint32_t max_leaf_size) {
    std::vector<unsigned> seen(bvh.triangles.size(), 0), parents(tree.nodes.size(), 0);
    bool good = true;
    for (const WideTree::Node& node : tree.nodes) {
        good = good && node.count >= 1 && node.count <= width;
        std::uint32_t next = 0;
        for (std::uint32_t c = node.first; c < node.first + node.count; ++c) {
            const WideTree::Child& child = tree.children[c];
            good =
                good && contains(bvh.nodes[node.node].box, bvh.nodes[child.node].box) && child.count <= max_leaf_size;
            if (child.is_leaf()) {
                for (std::uint32_t t = child.first; t < child.first + child.count; ++t) ++seen[t];
            } else {
                good = good && (next == 0 || child.inner == next) && tree.nodes[child.inner].node == child.node;
                next = child.inner + 1;
                ++parents[child.inner];
            }
        }
    }
    CHECK(good);
    CHECK(std::all_of(seen.begin(), seen.end(), [](unsigned n) { return n == 1; }));
    CHECK(std::accumulate(parents.begin(), parents.end(), 0U) == tree.nodes.size() - 1);
    CHECK(std::all_of(parents.begin() + 1, parents.end(), [](unsigned n) { return n == 1; }));
}

template <class Layout>
std::uint32_t hit_of(const Layout& layout, const Scene& scene, Ray ray) {
    const TexelLayout texels(scene);
    NullRecorder recorder;
    WarpTraversal<Layout, NullRecorder> traversal(scene, layout, texels, recorder);
    std::vector<Ray> rays(32, ray);
    std::vector<Hit> hits(32);
    traversal.closest(~0U, traces::RayType::camera, 0, rays.data(), hits.data());
    CHECK(traversal.occluded(~0U, traces::RayType::shadow, 0, rays.data()) == (hits[31].found() ? ~0U : 0U));
    return hits[31].triangle;
}

}  // namespace

TEST_CASE("wide trees: what is left out makes the least cost of all ways to leave nodes out") {
    for (std::uint32_t seed = 1; seed <= 12; ++seed) {
        const Scene scene = soup(7 + seed % 3, 0.8F, seed);
        const Bvh bvh = build_bvh(scene, {1, false});
        for (const unsigned width : {2U, 3U, 4U, 8U})
            for (const std::uint32_t leaf : {1U, 3U}) {
                const WideTree tree = collapse(bvh, width, leaf);
                check_whole(bvh, tree, width, leaf);
                CHECK(cost(bvh, tree) == Approx(least_cost(bvh, width, leaf)).epsilon(1e-9));
            }
    }
}

TEST_CASE("wide trees: every triangle is in one leaf, every node below one other, and few are left") {
    const Bvh fine = build_bvh(soup(20000, 0.1F, 2), {1, false}), coarse = build_bvh(sticks(), {4, true});
    const WideTree eight = collapse(fine, 8, 3), four = collapse(coarse, 4, 7);
    check_whole(fine, eight, 8, 3);
    check_whole(coarse, four, 4, 7);
    CHECK(eight.nodes.size() < fine.nodes.size() / 8);
    CHECK(four.nodes.size() < coarse.nodes.size() / 4);
    CHECK(eight.depth < fine.depth);
    CHECK_THROWS_WITH(collapse(coarse, 8, 1), Catch::Contains("holds 1 in a leaf") && !Catch::Contains("\n"));
}

TEST_CASE("wide layouts: no triangle, no ray is lost where boxes are equal, flat, or trees as deep as they get") {
    const Scene scene = quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    Ray ray;
    ray.origin = {0.25F, 0.5F, 1};
    ray.direction = {0, 0, -1};
    for (const std::uint32_t levels : {0U, 1U, 2U, 64U, 96U}) {
        INFO(levels);
        const Bvh bvh = chain(scene, levels);
        const Bvh4 four = *Bvh4::make(bvh, scene);
        const Cwbvh8 eight = *Cwbvh8::make(bvh, scene);
        CHECK(hit_of(four, scene, ray) == 1);
        CHECK(hit_of(eight, scene, ray) == 1);
        CHECK(four.regions()[0].links.size() == 4 * four.nodes.size());
        CHECK(eight.regions()[0].links.size() == 8 * eight.nodes.size());
    }
    Scene same = mesh({}, {});
    for (int i = 0; i < 1000; ++i) append(same, mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2}));
    CHECK(hit_of(*Bvh4::make(build_bvh(same), same), same, {{0.2F, 0.2F, 1}, {0, 0, -1}}) == 0);
    CHECK(hit_of(*Cwbvh8::make(build_bvh(same, {1, false}), same), same, {{0.2F, 0.2F, 1}, {0, 0, -1}}) == 0);
    CHECK(hit_of(*Cwbvh8::make(build_bvh(same, {1, false}), same), same, {{0.8F, 0.8F, 1}, {0, 0, -1}}) == no_triangle);
}

TEST_CASE("wide layouts: hits are those of bvh2 bit by bit, at any scale, far from the origin, with spatial splits") {
    for (const auto& [scale, offset] : {std::pair{1e-6F, 0.0F}, {1.0F, 1000.0F}, {1e6F, 3e5F}, {1e-3F, 100.0F}})
        for (const bool splits : {false, true}) {
            const BvhSettings settings{4, splits};
            const Vec3 by{offset, -offset, offset / 3};
            const Scene scene = moved(sticks(), scale, by);
            const Box box{Vec3{-1.2F, -1.2F, -1.2F} * scale + by, Vec3{1.2F, 1.2F, 1.2F} * scale + by};
            const auto rays = random_rays(box, 4000, 5);
            const auto expected = closest_hits(PreparedScene(scene, settings), rays);
            const auto expected_any = any_hits(PreparedScene(scene, settings), rays);
            for (const char* layout : {"bvh4", "cwbvh8"}) {
                const PreparedScene wide(scene, settings, layout);
                const auto hits = closest_hits(wide, rays);
                std::size_t differ = 0;
                for (std::size_t i = 0; i < rays.size(); ++i)
                    differ += hits[i].triangle != expected[i].triangle || hits[i].t != expected[i].t;
                INFO(layout << ' ' << scale << ' ' << offset << ' ' << splits);
                CHECK(differ == 0);
                CHECK(any_hits(wide, rays) == expected_any);
            }
        }
}

TEST_CASE("cwbvh8: a quantised box holds the child's, whatever its size and place") {
    Random random(7);
    const auto number = [&](float most) {
        const float magnitude = std::ldexp(1.0F, static_cast<int>(random.below(60)) - 40) * random.between(1, 2);
        return std::min(magnitude, most) * (random.below(2) == 0 ? 1.0F : -1.0F);
    };
    std::size_t tight = 0, all = 0;
    for (int i = 0; i < 20000; ++i) {
        const float centre[3] = {number(1e6F), random.below(3) == 0 ? 0 : number(1e18F), number(1)};
        const float extent = std::fabs(number(1e5F));
        std::array<Box, 8> boxes;
        Box whole;
        for (Box& box : boxes) {
            if (random.below(5) == 0) continue;
            for (int corner = 0; corner < 2; ++corner) {
                const float flat = random.below(4) == 0 ? 0.0F : extent;
                box.add(Vec3{centre[0] + extent * random.unit(), centre[1] + flat * random.unit(),
                             centre[2] + extent * random.unit() * 1e-3F});
            }
            whole.add(box);
        }
        if (whole.lower.x > whole.upper.x) continue;
        Cwbvh8Node node{};
        quantise(whole, boxes, node);
        for (unsigned slot = 0; slot < 8; ++slot) {
            const Box decoded = node.box(slot), &box = boxes[slot];
            if (box.lower.x > box.upper.x) {
                REQUIRE(node.lower[0][slot] > node.upper[0][slot]);
                continue;
            }
            REQUIRE(contains(decoded, box));
            // No more than a step wider on either side; a step is less than a 127th of the node.
            const float most = (whole.upper.x - whole.lower.x) / 127 + 4e-7F * std::fabs(whole.upper.x);
            tight += decoded.upper.x - box.upper.x <= most && box.lower.x - decoded.lower.x <= most;
            ++all;
        }
    }
    CHECK(all > 100000);
    CHECK(tight == all);
}

TEST_CASE("cwbvh8: a plane so near to a step that doubles do not tell them apart takes the step on its outer side") {
    std::array<Box, 8> boxes;
    const float hair = 1e-30F;
    boxes[0] = {{-1, -1, -1}, {hair, hair, hair}};
    boxes[5] = {{-hair, -hair, -hair}, {1, 1, 1}};
    Cwbvh8Node node{};
    quantise({{-1, -1, -1}, {1, 1, 1}}, boxes, node);
    for (int axis = 0; axis < 3; ++axis) {
        CHECK(node.scale(axis) == 1.0F / 64);
        CHECK(node.upper[axis][0] == 65);
        CHECK(node.lower[axis][5] == 63);
    }
    CHECK(contains(node.box(0), boxes[0]));
    CHECK(contains(node.box(5), boxes[5]));
}

TEST_CASE("cwbvh8: children lie in the slots of their octants, and a node says where they are") {
    // One triangle in each octant of a cube, of eight that rays along the diagonals meet in an order that is known.
    Scene scene = mesh({}, {});
    for (const float x : {-1.0F, 1.0F})
        for (const float y : {-1.0F, 1.0F})
            for (const float z : {-1.0F, 1.0F})
                append(scene, mesh({{x, y, z}, {x + 0.1F, y, z}, {x, y + 0.1F, z + 0.1F}}, {0, 1, 2}));
    const Cwbvh8 bvh = *Cwbvh8::make(build_bvh(scene, {1, false}), scene);
    REQUIRE(bvh.nodes.size() == 1);
    const Cwbvh8Node& root = bvh.nodes[0];
    CHECK(root.inner == 0);
    for (unsigned slot = 0; slot < 8; ++slot) {
        CHECK(root.meta[slot] == (1U << 5 | slot));  // one triangle each, in the order of slots
        const LeafTriangle& t = bvh.triangles[slot];
        CHECK((t.x[0] > 0) == ((slot & 4) != 0));
        CHECK((t.y[0] > 0) == ((slot & 2) != 0));
        CHECK((t.z[0] > 0) == ((slot & 1) != 0));
    }
    const auto links = bvh.regions()[0].links;
    for (std::uint32_t slot = 0; slot < 8; ++slot) CHECK(links[slot] == (1U << 30 | slot));
    CHECK(bvh.regions()[0].element_size == 80);
    CHECK(bvh.regions()[0].degree == 8);
}

TEST_CASE("cwbvh8: of nodes that a ray hits it visits the near ones first") {
    // Eight far clusters, one in each octant, too large for one leaf, so that the root has eight nodes.
    Scene scene = mesh({}, {});
    for (unsigned slot = 0; slot < 8; ++slot)
        append(scene,
               moved(soup(30, 0.3F, slot + 1), 1,
                     {(slot & 4) != 0 ? 5.0F : -5.0F, (slot & 2) != 0 ? 5.0F : -5.0F, (slot & 1) != 0 ? 5.0F : -5.0F}));
    const Cwbvh8 bvh = *Cwbvh8::make(build_bvh(scene, {1, false}), scene);
    REQUIRE(bvh.nodes[0].inner == 0xff);
    for (const float sign : {1.0F, -1.0F}) {
        std::vector<Cwbvh8Lane::StackEntry> stack(bvh.stack_entries());
        Cwbvh8Lane lane;
        // From one corner through the middle to the other.
        lane.start({Vec3{-20, -20.01F, -19.99F} * sign, Vec3{1, 1, 1} * sign}, stack.data());
        std::vector<std::uint32_t> visited;
        for (LaneStep step = lane.visit_node(bvh.view()); !step.ended;) {
            if (step.at_node != 0) {
                if (lane.node() >= 1 && lane.node() <= 8) visited.push_back(lane.node() - 1);
                step = lane.visit_node(bvh.view());
            } else {
                while (lane.more_triangles()) lane.take_triangle();
                step = lane.leave_triangles();
            }
        }
        REQUIRE(visited.size() >= 2);
        CHECK(visited.front() == (sign > 0 ? 0U : 7U));
        CHECK(visited.back() == (sign > 0 ? 7U : 0U));
    }
}

TEST_CASE("node orders: van Emde Boas lays out the upper half of the levels, then each subtree in the same way") {
    // A complete tree of four levels of inner nodes, 15 of them: depth-first numbers of Bvh are 2, 3 … apart.
    Bvh bvh;
    const std::function<void(int)> grow = [&](int levels) {
        const std::size_t at = bvh.nodes.size();
        bvh.nodes.push_back({{}, 0, levels == 0 ? 1U : 0U});
        if (levels == 0) {
            bvh.nodes[at].first = static_cast<std::uint32_t>(bvh.triangles.size());
            bvh.triangles.push_back(0);
            return;
        }
        grow(levels - 1);
        bvh.nodes[at].first = static_cast<std::uint32_t>(bvh.nodes.size());
        grow(levels - 1);
    };
    grow(4);
    bvh.depth = 4;
    // Root, its children, then the four subtrees of three nodes each.
    CHECK(van_emde_boas(bvh) == std::vector<std::uint32_t>{0, 1, 16, 2, 3, 6, 9, 10, 13, 17, 18, 21, 24, 25, 28});
}

TEST_CASE("node orders: a treelet is connected, and the largest box below it is the next root") {
    const Scene scene = soup(3000, 0.1F, 3);
    const Bvh bvh = build_bvh(scene);
    const auto order = treelets(bvh);
    std::vector<std::uint32_t> parent(bvh.nodes.size(), 0), place(bvh.nodes.size(), 0);
    for (std::uint32_t i = 0; i < bvh.nodes.size(); ++i)
        if (!bvh.nodes[i].is_leaf()) parent[i + 1] = parent[bvh.nodes[i].first] = i;
    for (std::uint32_t i = 0; i < order.size(); ++i) place[order[i]] = i;
    for (std::uint32_t i = 1; i < 32; ++i) CHECK(place[parent[order[i]]] < i);
    double largest = 0;
    std::uint32_t root = 0;
    for (const std::uint32_t node : order)
        if (place[node] >= 32 && place[parent[node]] < 32 && surface(bvh.nodes[node].box) > largest) {
            largest = surface(bvh.nodes[node].box);
            root = node;
        }
    CHECK(order[32] == root);
}
