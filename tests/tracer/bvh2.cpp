// Layout bvh2: bytes, order, links.
#include <catch2/catch.hpp>
#include <cstddef>

#include "test_rays.hpp"
#include "tracer/bvh/layouts/bvh2.hpp"
#include "tracer/simt/warp_traversal.hpp"
#include "traces/error.hpp"
#include "trees.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

TEST_CASE("bvh2: a node takes 64 bytes with its boxes first, a triangle 48 with its axes at 0, 16, 32") {
    CHECK(sizeof(Bvh2Node) == 64);
    CHECK(offsetof(Bvh2Node, x) == 0);
    CHECK(offsetof(Bvh2Node, child) == 48);
    CHECK(sizeof(LeafTriangle) == 48);
    CHECK(offsetof(LeafTriangle, y) == 16);
    CHECK(offsetof(LeafTriangle, z) == 32);
}

TEST_CASE("bvh2: nodes and triangles are those of the tree, inner nodes in depth-first order") {
    const Scene scene = soup(3000, 0.2F, 1);
    for (const bool splits : {false, true}) {
        const Bvh bvh = build_bvh(scene, {4, splits});
        const Bvh2 made = *Bvh2::make(bvh, scene);
        REQUIRE(made.triangles.size() == bvh.triangles.size());
        for (std::size_t i = 0; i < made.triangles.size(); ++i) {
            const std::uint32_t t = bvh.triangles[i];
            REQUIRE(made.triangles[i].triangle == t);
            REQUIRE(made.triangles[i].vertex(0) == corner(scene, t, 0));
            REQUIRE(made.triangles[i].vertex(1) == corner(scene, t, 1));
            REQUIRE(made.triangles[i].vertex(2) == corner(scene, t, 2));
            REQUIRE(made.triangles[i].alpha == 0);
        }
        // Both trees side by side.
        struct Pair {
            std::uint32_t tree, ref;
        };
        std::vector<Pair> stack{{0, 0}};
        std::uint32_t expected = 0;
        while (!stack.empty()) {
            const Pair p = stack.back();
            stack.pop_back();
            const Bvh::Node& node = bvh.nodes[p.tree];
            if (node.is_leaf()) {
                REQUIRE(ChildRef::is_leaf(p.ref));
                REQUIRE(ChildRef::first(p.ref) == node.first);
                REQUIRE(ChildRef::count(p.ref) == node.count);
                continue;
            }
            REQUIRE(p.ref == expected++);
            const Bvh2Node& layout = made.nodes[p.ref];
            const std::uint32_t children[2] = {p.tree + 1, node.first};
            for (int c = 1; c >= 0; --c) {
                const Box& box = bvh.nodes[children[c]].box;
                REQUIRE(box.lower == Vec3{layout.x[c], layout.y[c], layout.z[c]});
                REQUIRE(box.upper == Vec3{layout.x[c + 2], layout.y[c + 2], layout.z[c + 2]});
                stack.push_back({children[c], layout.child[c]});
            }
        }
        CHECK(expected == made.nodes.size());
        CHECK(made.siblings >= bvh.depth);
    }
}

TEST_CASE("bvh2: the link table names each node's children and leads to every element once") {
    const Scene scene = soup(3000, 0.2F, 2);
    const Bvh2 bvh = *Bvh2::make(build_bvh(scene), scene);
    const auto regions = bvh.regions();
    REQUIRE(regions.size() == 2);
    CHECK(regions[Bvh2::node_region].kind == traces::ObjectKind::node);
    CHECK(regions[Bvh2::node_region].stride == 64);
    CHECK(regions[Bvh2::node_region].element_size == 64);
    CHECK(regions[Bvh2::node_region].count == bvh.nodes.size());
    CHECK(regions[Bvh2::node_region].degree == 2);
    CHECK(regions[Bvh2::triangle_region].kind == traces::ObjectKind::triangle);
    CHECK(regions[Bvh2::triangle_region].stride == 48);
    CHECK(regions[Bvh2::triangle_region].element_size == 48);
    CHECK(regions[Bvh2::triangle_region].count == bvh.triangles.size());
    CHECK(regions[Bvh2::triangle_region].links.empty());
    for (const auto& region : regions) CHECK(region.base % (2U << 20U) == 0);
    CHECK(regions[0].address(regions[0].count) <= regions[1].base);

    const auto& links = regions[Bvh2::node_region].links;
    REQUIRE(links.size() == 2 * bvh.nodes.size());
    std::vector<int> nodes(bvh.nodes.size()), triangles(bvh.triangles.size());
    for (std::size_t i = 0; i < links.size(); ++i) {
        const std::uint32_t ref = bvh.nodes[i / 2].child[i % 2], element = links[i] & 0x3fffffffU;
        if (ChildRef::is_leaf(ref)) {
            REQUIRE(links[i] >> 30 == Bvh2::triangle_region);
            REQUIRE(element == ChildRef::first(ref));
            for (std::uint32_t k = 0; k < ChildRef::count(ref); ++k) ++triangles.at(element + k);
        } else {
            REQUIRE(links[i] >> 30 == Bvh2::node_region);
            REQUIRE(element == ref);
            ++nodes.at(element);
        }
    }
    CHECK(nodes[0] == 0);
    CHECK(std::count(nodes.begin() + 1, nodes.end(), 1) == static_cast<std::ptrdiff_t>(nodes.size()) - 1);
    CHECK(std::count(triangles.begin(), triangles.end(), 1) == static_cast<std::ptrdiff_t>(triangles.size()));
}

TEST_CASE("bvh2: scenes of one to four triangles are a root with one or two children, and are hit") {
    for (std::uint32_t count = 1; count <= 4; ++count) {
        Scene scene = mesh({}, {});
        for (std::uint32_t i = 0; i < count; ++i) {
            const float z = static_cast<float>(i);
            append(scene, mesh({{-1, -1, z}, {1, -1, z}, {0, 1, z}}, {0, 1, 2}));
        }
        const PreparedScene prepared(std::move(scene), BvhSettings{});
        const auto regions = prepared.bvh().regions();
        std::uint32_t leaves = 0;
        for (const std::uint32_t link : regions[0].links) leaves += link != traces::no_link && link >> 30 == 1;
        CHECK(leaves >= 1);
        Ray ray;
        ray.origin = {0, 0, -1};
        ray.direction = {0, 0, 1};
        CHECK(closest_hits(prepared, std::vector<Ray>{ray})[0].triangle == 0);
        ray.origin = {0, 0, 9};
        ray.direction = {0, 0, -1};
        CHECK(closest_hits(prepared, std::vector<Ray>{ray})[0].triangle == count - 1);
        ray.origin = {3, 0, 9};
        CHECK_FALSE(closest_hits(prepared, std::vector<Ray>{ray})[0].found());
    }
}

TEST_CASE("bvh2: a scene that is one leaf has a second child that leads nowhere and is never visited") {
    const Scene scene = quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    Bvh one_leaf;
    one_leaf.nodes.push_back({scene.bounds(), 0, 2});
    one_leaf.triangles = {0, 1};
    const Bvh2 bvh = *Bvh2::make(one_leaf, scene);
    REQUIRE(bvh.nodes.size() == 1);
    CHECK(bvh.nodes[0].child[1] == ChildRef::nothing);
    CHECK(bvh.regions()[0].links == std::vector<std::uint32_t>{1U << 30, traces::no_link});
    const TexelLayout texels(scene);
    NullRecorder recorder;
    WarpTraversal<Bvh2, NullRecorder> traversal(scene, bvh, texels, recorder);
    std::vector<Ray> rays(32);
    for (Ray& ray : rays) {
        ray.origin = {0.25F, 0.5F, 1};
        ray.direction = {0, 0, -1};
    }
    std::vector<Hit> hits(32);
    traversal.closest(~0U, traces::RayType::camera, 0, rays.data(), hits.data());
    for (const Hit& hit : hits) CHECK(hit.t == 1);
    CHECK(traversal.occluded(~0U, traces::RayType::shadow, 0, rays.data()) == ~0U);
}

TEST_CASE("bvh2: only triangles whose material can have holes are marked") {
    Scene scene = soup(60, 0.2F, 3);
    scene.materials.resize(6);
    scene.materials[1].alpha_mask = true;  // alpha 1, no texture: solid
    scene.materials[2].alpha_mask = true;
    scene.materials[2].alpha = 0.25F;
    scene.materials[3].alpha_mask = true;
    scene.materials[3].base_color_texture = 0;
    scene.materials[4].base_color_texture = 0;
    scene.materials[5].alpha = 0;
    for (std::size_t t = 0; t < 60; ++t) scene.material_of[t] = static_cast<std::uint16_t>(t % 6);
    const Bvh2 bvh = *Bvh2::make(build_bvh(scene), scene);
    for (const LeafTriangle& t : bvh.triangles)
        CHECK(t.alpha == (t.triangle % 6 == 2 || t.triangle % 6 == 3 ? 1U : 0U));
}

TEST_CASE("bvh2: a tree too deep for the layout is refused in one line") {
    const Scene scene = quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    const Bvh deep = chain(scene, 97);
    CHECK_THROWS_AS(Bvh2::make(deep, scene), Error);
    CHECK_THROWS_WITH(Bvh2::make(deep, scene), Catch::Contains("97 levels") && !Catch::Contains("\n"));
    // One level less fits, and its stack is deep enough (AddressSanitizer looks on).
    const Bvh2 bvh = *Bvh2::make(chain(scene, 96), scene);
    const TexelLayout texels(scene);
    NullRecorder recorder;
    WarpTraversal<Bvh2, NullRecorder> traversal(scene, bvh, texels, recorder);
    std::vector<Ray> rays(32);
    for (Ray& ray : rays) {
        ray.origin = {0.75F, 0.25F, 1};
        ray.direction = {0, 0, -1};
    }
    std::vector<Hit> hits(32);
    traversal.closest(~0U, traces::RayType::camera, 0, rays.data(), hits.data());
    CHECK(hits[31].triangle == 0);
}
