// A glTF file taken apart: its structures, its buffers in memory, and its images still encoded.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tracer/scene/gltf_container.hpp"
#include "tracer/scene/gltf_model.hpp"
#include "tracer/scene/gltf_report.hpp"

namespace raycache::tracer {

/// Where the bytes of one image are.
struct GltfImage {
    std::string name;                ///< its name or URI, for messages
    std::optional<int> view;         ///< in a buffer view,
    std::optional<std::string> uri;  ///< or behind a URI
};

struct GltfDocument {
    GltfContainer container;
    /// Without buffers, images, animations and extras: the first two are below, the others have no use here. Primitives
    /// that were compressed have accessors and buffer views of their own, behind those of the file.
    tinygltf::Model model;
    std::vector<std::span<const std::uint8_t>> buffers;        ///< one per buffer, exactly its byteLength
    std::vector<std::vector<std::uint8_t>> owned_buffers;      ///< what data: URIs and external files held, and
    std::vector<std::span<const std::uint8_t>> decoded_views;  ///< what compressed views did; by view, may be shorter
    std::vector<std::span<const std::uint8_t>> external_buffers;  ///< those of `owned_buffers` that were files,
    std::vector<std::string> files;                               ///< and these files
    std::vector<GltfImage> images;
};

/// Reads the file and its buffers. Throws Error as load_gltf() does; also for a required extension we lack.
GltfDocument read_gltf_document(const GltfReport&);

/// `length` bytes from `offset` of a buffer; throws Error "WHERE: …" unless it has them.
std::span<const std::uint8_t> bytes_of_buffer(const GltfDocument&, int index, std::uint64_t offset,
                                              std::uint64_t length, const std::string& where, const GltfReport&);

/// The bytes of buffer view `index`; throws Error "WHERE: …" unless they lie within a buffer.
std::span<const std::uint8_t> buffer_view_bytes(const GltfDocument&, int index, const std::string& where,
                                                const GltfReport&);

}  // namespace raycache::tracer
