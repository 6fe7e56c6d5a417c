#include "tracer/scene/gltf_meshopt.hpp"

#include <fmt/format.h>
#include <meshoptimizer.h>

namespace raycache::tracer {

namespace {

/// Vertices are at least 1/64 byte each, indices one byte a triangle: what claims to be more is no stream.
constexpr std::uint64_t most_elements_of_byte = 64;

void check_members(const MeshoptView& view, std::size_t compressed, const std::string& where,
                   const GltfReport& report) {
    const bool vertices = view.mode == "ATTRIBUTES";
    const std::uint64_t stride = view.byte_stride;
    const auto expect = [&](bool holds, const char* member, const std::string& expected, const std::string& found) {
        if (!holds) report.fail(where + "." + member, expected, found);
    };
    if (vertices)
        expect(stride % 4 == 0 && stride >= 4 && stride <= 256, "byteStride", "a multiple of 4 up to 256",
               fmt::format("{}", stride));
    else
        expect(stride == 2 || stride == 4, "byteStride", "2 or 4", fmt::format("{}", stride));
    if (view.mode == "TRIANGLES")
        expect(view.count % 3 == 0, "count", "a multiple of 3", fmt::format("{}", view.count));
    expect(view.count <= most_elements_of_byte * compressed + most_elements_of_byte, "count",
           fmt::format("at most {} elements in {} bytes", most_elements_of_byte * (compressed + 1), compressed),
           fmt::format("{}", view.count));
    const bool eight = view.filter == "OCTAHEDRAL" || view.filter == "QUATERNION";
    expect(view.filter == "NONE" || vertices, "filter", "none but of ATTRIBUTES", view.filter);
    expect(!eight || stride == 8 || (stride == 4 && view.filter == "OCTAHEDRAL"), "byteStride",
           "8 (OCTAHEDRAL: or 4) for this filter", fmt::format("{}", stride));
}

}  // namespace

std::vector<std::uint8_t> decode_meshopt(const MeshoptView& view, std::span<const std::uint8_t> compressed,
                                         const std::string& where, const GltfReport& report) {
    check_members(view, compressed.size(), where, report);
    report.charge(view.count * view.byte_stride, where);
    std::vector<std::uint8_t> result(view.count * view.byte_stride);
    int problem = 0;
    if (view.mode == "ATTRIBUTES")
        problem = meshopt_decodeVertexBuffer(result.data(), view.count, view.byte_stride, compressed.data(),
                                             compressed.size());
    else if (view.mode == "TRIANGLES")
        problem = meshopt_decodeIndexBuffer(result.data(), view.count, view.byte_stride, compressed.data(),
                                            compressed.size());
    else
        problem = meshopt_decodeIndexSequence(result.data(), view.count, view.byte_stride, compressed.data(),
                                              compressed.size());
    if (problem != 0)
        report.fail(where, fmt::format("a stream of mode {} with {} elements", view.mode, view.count),
                    fmt::format("{} bytes that are none (meshoptimizer says {})", compressed.size(), problem),
                    "copy the file again, or decompress it with `gltf-transform copy IN OUT`");
    if (view.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(result.data(), view.count, view.byte_stride);
    if (view.filter == "QUATERNION") meshopt_decodeFilterQuat(result.data(), view.count, view.byte_stride);
    if (view.filter == "EXPONENTIAL") meshopt_decodeFilterExp(result.data(), view.count, view.byte_stride);
    return result;
}

}  // namespace raycache::tracer
