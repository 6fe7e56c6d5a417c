#include "tracer/scene/gltf_textures.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "tracer/scene/gltf_uri.hpp"
#include "traces/error.hpp"
#include "traces/printable.hpp"
#include "traces/regular_file.hpp"

namespace raycache::tracer {

namespace {

/// 2 GiB of texels. A few bytes of PNG can ask for far more.
constexpr std::uint64_t max_total_texels = 1ULL << 29;

void read_image(const GltfDocument& document, const GltfImage& image, GltfImageBytes& result,
                const GltfReport& report) {
    if (image.view) {
        result.bytes = buffer_view_bytes(document, *image.view, result.name, report);
        return;
    }
    if (!image.uri) throw Error("it has neither a URI nor a buffer view");
    if (is_data_uri(*image.uri)) {
        report.charge(image.uri->size() / 4 * 3, result.name);
        auto bytes = decode_data_uri(*image.uri);
        if (!bytes) throw Error("its data: URI is not base64");
        result.owned = std::move(*bytes);
    } else {
        const UriFile file = find_uri_file(report.path(), *image.uri);
        if (file.path.empty()) throw Error("its URI is not a relative path; " + file.remedy);
        if (!file.exists && !file.remedy.empty()) throw Error("there is no such file; " + file.remedy);
        result.owned = read_regular_file(file.path, "image", report.memory().get());
        result.file = file.path;
        if (!file.note.empty()) report.warning(fmt::format("image {}: the URI {}", result.name, file.note));
    }
    result.bytes = result.owned;
}

/// Leaves an image without bytes where its header is bad, and once those before it fill what a picture may take.
void enforce_budget(std::vector<GltfImageBytes>& images, const GltfReport& report) {
    std::uint64_t texels = 0;
    for (GltfImageBytes& image : images) {
        if (image.bytes.empty()) continue;
        std::uint64_t more = 0;
        try {
            const ImageSize size = image_size(image.bytes, image.name);
            more = std::uint64_t{size.width} * size.height;
            if (texels + more > max_total_texels)
                throw Error(
                    fmt::format("{}: textures need more than {} texels; reduce them", image.name, max_total_texels));
        } catch (const Error& e) {
            image.problem = e.what();
            image.bytes = {};
            continue;
        }
        texels += more;
        report.charge(4 * more, fmt::format("texels of {}", image.name));
    }
}

}  // namespace

std::vector<GltfImageBytes> read_gltf_images(const GltfDocument& document, const std::vector<int>& images,
                                             const GltfReport& report) {
    std::vector<GltfImageBytes> result(images.size());
    for (std::size_t i = 0; i < images.size(); ++i) {
        const GltfImage& image = document.images[static_cast<std::size_t>(images[i])];
        result[i].name = printable_line(image.name);
        try {
            read_image(document, image, result[i], report);
            if (result[i].bytes.empty()) throw Error("it is empty");
        } catch (const MemoryError&) {
            throw;
        } catch (const Error& e) {
            result[i].problem = e.what();
        }
    }
    enforce_budget(result, report);
    return result;
}

std::vector<Texture> decode_gltf_textures(const std::vector<GltfImageBytes>& images, std::vector<Material>& materials,
                                          const GltfReport& report) {
    std::vector<Texture> decoded(images.size());
    std::vector<std::string> problems(images.size());
    tbb::parallel_for(std::size_t{0}, images.size(), [&](std::size_t i) {
        problems[i] = images[i].problem;
        if (images[i].bytes.empty()) return;
        try {
            decoded[i] = decode_image(images[i].bytes, images[i].name);
        } catch (const Error& e) {
            problems[i] = e.what();
        }
    });

    std::vector<Texture> result;
    std::vector<int> index_of(images.size(), -1);
    std::size_t failed = 0, first_failed = 0;
    for (std::size_t i = 0; i < images.size(); ++i) {
        if (decoded[i].rgba.empty()) {
            if (failed++ == 0) first_failed = i;
            continue;
        }
        index_of[i] = static_cast<int>(result.size());
        result.push_back(std::move(decoded[i]));
    }
    for (Material& material : materials)
        for (int* slot :
             {&material.base_color_texture, &material.metallic_roughness_texture, &material.emission_texture})
            if (*slot >= 0) *slot = index_of[static_cast<std::size_t>(*slot)];
    if (failed > 0)
        report.warning(
            fmt::format("{} textures cannot be used and the material's factors alone are; the first is {} ({})", failed,
                        images[first_failed].name, problems[first_failed]));
    return result;
}

}  // namespace raycache::tracer
