#include "tracer/bvh/layouts/child_ref.hpp"

namespace raycache::tracer {

traces::Region node_region_of(std::size_t count, std::uint32_t bytes, std::uint8_t degree) {
    traces::Region region;
    region.kind = traces::ObjectKind::node;
    region.base = 0x10'0000'0000;
    region.element_size = region.stride = bytes;
    region.count = static_cast<std::uint32_t>(count);
    region.degree = degree;
    region.links.reserve(count * degree);
    return region;
}

std::uint32_t node_link(std::uint32_t element) { return element; }
std::uint32_t triangle_link(std::uint32_t element) { return (1U << 30) | element; }

std::uint32_t link_of(std::uint32_t ref) {
    if (ref == ChildRef::nothing) return traces::no_link;
    return ChildRef::is_leaf(ref) ? triangle_link(ChildRef::first(ref)) : node_link(ref);
}

}  // namespace raycache::tracer
