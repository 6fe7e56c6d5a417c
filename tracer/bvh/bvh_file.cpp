#include "tracer/bvh/bvh_file.hpp"

#include <fmt/format.h>
#include <xxhash.h>
#include <zstd.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <string_view>

#include "traces/bytes.hpp"
#include "traces/error.hpp"
#include "traces/output_file.hpp"
#include "traces/printable.hpp"
#include "traces/regular_file.hpp"

namespace raycache::tracer {
namespace {

using traces::Bytes;

static_assert(std::endian::native == std::endian::little, "the frame holds numbers as they lie in memory");
static_assert(sizeof(Box) == 24);

constexpr std::string_view magic{"rcbvh\r\n\0", 8};
constexpr unsigned version = 1;
constexpr int zstd_level = 1;  // higher ones take longer and save nothing
constexpr std::size_t checksum_bytes = 8;

std::size_t head_bytes(const std::string& key) { return magic.size() + 4 + key.size() + 8 + 8 + 1; }

/// Of the frame's content.
std::size_t content_bytes(std::size_t nodes, std::size_t entries, bool boxes) {
    return nodes + sizeof(std::uint32_t) * entries + (boxes ? sizeof(Box) * nodes : 0);
}

[[noreturn]] void refuse(const std::string& path, const std::string& expected, const std::string& found) {
    throw Error(printable_line(fmt::format("{}: expected {}, found {}", path, expected, found)));
}

/// Of a node, as it follows from its triangles or its children's boxes; so are those of trees without spatial splits.
Box box_from_below(const Bvh& bvh, std::size_t index, const Scene& scene) {
    const Bvh::Node& node = bvh.nodes[index];
    Box box;
    if (!node.is_leaf()) {
        box = bvh.nodes[index + 1].box;
        box.add(bvh.nodes[node.first].box);
    }
    for (std::uint32_t k = 0; k < node.count; ++k) {
        const std::uint32_t* vertex = &scene.indices[3 * std::size_t{bvh.triangles[node.first + k]}];
        for (int corner = 0; corner < 3; ++corner) box.add(scene.positions[vertex[corner]]);
    }
    return box;
}

/// Bit by bit: 0 and -0 are not the same here.
bool boxes_follow(const Bvh& bvh, const Scene& scene) {
    for (std::size_t i = 0; i < bvh.nodes.size(); ++i) {
        const Box box = box_from_below(bvh, i, scene);
        if (std::memcmp(&box, &bvh.nodes[i].box, sizeof box) != 0) return false;
    }
    return true;
}

/// Depth, links and leaves from the counts alone, which stand in `nodes`; false where they make no tree of so many
/// leaf entries.
bool link(Bvh& bvh, std::size_t entries, std::uint32_t max_leaf_size) {
    struct Open {
        std::uint32_t node, depth;
    };
    std::vector<Open> open;  // inner nodes whose second child is to come
    std::uint32_t depth = 0;
    std::size_t next_entry = 0;
    for (std::uint32_t i = 0; i < bvh.nodes.size(); ++i) {
        Bvh::Node& node = bvh.nodes[i];
        bvh.depth = std::max(bvh.depth, depth);
        if (!node.is_leaf()) {
            open.push_back({i, depth++});
            continue;
        }
        if (node.count > max_leaf_size || node.count > entries - next_entry) return false;
        node.first = static_cast<std::uint32_t>(next_entry);
        next_entry += node.count;
        if (open.empty()) return i + 1 == bvh.nodes.size() && next_entry == entries;
        bvh.nodes[open.back().node].first = i + 1;
        depth = open.back().depth + 1;
        open.pop_back();
    }
    return false;
}

/// Whether every triangle of the scene stands in a leaf: in one alone, unless with spatial splits.
bool holds_all(const Bvh& bvh, std::size_t triangles, bool spatial_splits) {
    std::vector<bool> seen(triangles);
    std::size_t found = 0;
    for (const std::uint32_t t : bvh.triangles) {
        if (t >= triangles || (seen[t] && !spatial_splits)) return false;
        found += seen[t] ? 0 : 1;
        seen[t] = true;
    }
    return found == triangles;
}

}  // namespace

std::string bvh_key(const Scene& scene, const BvhSettings& settings) {
    const auto& [max_leaf_size, spatial_splits] = settings;  // a new field would have to be part of the key
    const auto hash = [](const auto& list) { return XXH3_64bits(list.data(), list.size() * sizeof(list[0])); };
    return fmt::format("raycache BVH {}; {} vertices {:016x}, {} triangles {:016x}; leaves of at most {}{}; {}",
                       version, scene.positions.size(), hash(scene.positions), scene.triangle_count(),
                       hash(scene.indices), max_leaf_size, spatial_splits ? ", spatial splits" : "", bvh_builder());
}

std::string bvh_file_name(const std::string& key) {
    return fmt::format("{:016x}.bvh", XXH3_64bits(key.data(), key.size()));
}

void write_bvh(const std::string& path, const Bvh& bvh, const Scene& scene, const std::string& key) {
    const bool boxes = !boxes_follow(bvh, scene);
    Bytes content;
    content.reserve(content_bytes(bvh.nodes.size(), bvh.triangles.size(), boxes));
    for (const Bvh::Node& node : bvh.nodes) content.push_back(static_cast<std::uint8_t>(node.count));
    const auto add = [&](const auto* values, std::size_t count) {
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(values);
        content.insert(content.end(), bytes, bytes + count * sizeof *values);
    };
    add(bvh.triangles.data(), bvh.triangles.size());
    for (std::size_t i = 0; boxes && i < bvh.nodes.size(); ++i) add(&bvh.nodes[i].box, 1);

    Bytes file;
    file.reserve(head_bytes(key) + ZSTD_compressBound(content.size()) + checksum_bytes);
    traces::append(file, magic);
    traces::append(file, static_cast<std::uint32_t>(key.size()));
    traces::append(file, key);
    traces::append(file, std::uint64_t{bvh.nodes.size()});
    traces::append(file, std::uint64_t{bvh.triangles.size()});
    file.push_back(boxes ? 1 : 0);
    const std::size_t head = file.size();
    file.resize(head + ZSTD_compressBound(content.size()));
    const std::size_t size =
        ZSTD_compress(file.data() + head, file.size() - head, content.data(), content.size(), zstd_level);
    if (ZSTD_isError(size)) throw Error(fmt::format("{}: zstd: {}", path, ZSTD_getErrorName(size)));
    file.resize(head + size);
    traces::append(file, std::uint64_t{XXH3_64bits(file.data(), file.size())});
    traces::OutputFile out(path);
    out.write(file);
    out.commit();
}

Bvh read_bvh(const std::string& path, const Scene& scene, const BvhSettings& settings, const std::string& key) {
    const std::size_t triangles = scene.triangle_count();
    const std::size_t most_entries = most_leaf_entries(triangles, settings), most_nodes = 2 * most_entries - 1;
    const std::size_t most_bytes =
        head_bytes(key) + ZSTD_compressBound(content_bytes(most_nodes, most_entries, true)) + checksum_bytes;
    const Bytes file = read_regular_file(path, "BVH", nullptr, most_bytes);
    if (!traces::starts_with(file, magic)) refuse(path, "a BVH that raycache wrote", "something else");
    const auto damaged = [&] { refuse(path, "a whole file with its checksum", "a damaged one"); };
    const std::size_t key_head = magic.size() + 4;
    if (file.size() < key_head + checksum_bytes) damaged();
    const std::size_t body = file.size() - checksum_bytes;
    if (traces::load<std::uint64_t>(&file[body]) != XXH3_64bits(file.data(), body)) damaged();
    const std::size_t key_bytes = traces::load<std::uint32_t>(&file[magic.size()]);
    const std::string_view found_key(reinterpret_cast<const char*>(&file[key_head]),
                                     std::min(key_bytes, body - key_head));
    if (found_key != key) refuse(path, fmt::format("the tree \"{}\"", key), fmt::format("\"{}\"", found_key));
    const std::size_t head = head_bytes(key);
    if (body < head) damaged();
    const std::uint8_t* const at = &file[key_head + key.size()];
    const auto nodes = traces::load<std::uint64_t>(at), entries = traces::load<std::uint64_t>(at + 8);
    const bool boxes = at[16] != 0;
    if (nodes < 1 || nodes > most_nodes || entries < triangles || entries > most_entries)
        refuse(path, fmt::format("1 to {} nodes, {} to {} leaf entries", most_nodes, triangles, most_entries),
               fmt::format("{} and {}", nodes, entries));

    Bytes content(content_bytes(nodes, entries, boxes));
    const std::size_t size = ZSTD_decompress(content.data(), content.size(), file.data() + head, body - head);
    if (size != content.size())
        refuse(path, fmt::format("{} bytes of content", content.size()),
               ZSTD_isError(size) ? ZSTD_getErrorName(size) : fmt::format("{}", size));
    Bvh bvh;
    bvh.nodes.resize(nodes);
    for (std::size_t i = 0; i < nodes; ++i) bvh.nodes[i].count = content[i];
    bvh.triangles.resize(entries);
    std::memcpy(bvh.triangles.data(), &content[nodes], sizeof(std::uint32_t) * entries);
    if (!link(bvh, entries, settings.max_leaf_size) || !holds_all(bvh, triangles, settings.spatial_splits))
        refuse(path, fmt::format("a tree over the {} triangles of the scene", triangles), "none");
    const std::uint8_t* const stored_boxes = content.data() + content_bytes(nodes, entries, false);
    for (std::size_t i = nodes; i-- > 0;) {  // children stand behind their parents
        if (boxes)
            std::memcpy(&bvh.nodes[i].box, stored_boxes + sizeof(Box) * i, sizeof(Box));
        else
            bvh.nodes[i].box = box_from_below(bvh, i, scene);
    }
    return bvh;
}

}  // namespace raycache::tracer
