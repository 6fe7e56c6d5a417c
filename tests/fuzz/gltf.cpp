// glTF scenes with their images: loading, and where that succeeds the BVH, Embree's scene and a few paths. Mutations
// keep the frame of a .glb whole and change values of its JSON; blind ones would nearly all end at the first bracket.
#include <tbb/global_control.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <span>

#include "tests/fuzz/fuzz.hpp"
#include "tracer/capture.hpp"
#include "tracer/prepared_scene.hpp"
#include "traces/bytes.hpp"

using namespace raycache;
using namespace raycache::tracer;
using fuzz::Bytes;
using nlohmann::json;

namespace {

struct Glb {
    std::string text;  ///< its JSON
    Bytes bin;
};

std::optional<Glb> take_apart(std::span<const std::uint8_t> file) {
    const auto u32 = [&](std::size_t at) { return traces::load<std::uint32_t>(file.data() + at); };
    if (file.size() < 20 || u32(0) != 0x46546C67 || u32(12) > file.size() - 20) return std::nullopt;
    const std::size_t end = 20 + u32(12);
    Glb glb{{file.begin() + 20, file.begin() + static_cast<std::ptrdiff_t>(end)}, {}};
    if (end + 8 <= file.size()) glb.bin.assign(file.begin() + static_cast<std::ptrdiff_t>(end) + 8, file.end());
    return glb;
}

Bytes put_together(Glb glb) {
    glb.text.resize((glb.text.size() + 3) / 4 * 4, ' ');
    glb.bin.resize((glb.bin.size() + 3) / 4 * 4);
    Bytes file;
    const auto put = [&](std::size_t value) { traces::append(file, static_cast<std::uint32_t>(value)); };
    put(0x46546C67), put(2), put(20 + glb.text.size() + (glb.bin.empty() ? 0 : 8 + glb.bin.size()));
    put(glb.text.size()), put(0x4E4F534A);
    traces::append(file, std::string_view(glb.text));
    if (glb.bin.empty()) return file;
    put(glb.bin.size()), put(0x004E4942);
    traces::append(file, std::span<const std::uint8_t>(glb.bin));
    return file;
}

json odd_value(std::mt19937& random) {
    switch (random() % 12) {
        case 0:
            return -1;
        case 1:
            return random() % 8;
        case 2:
            return 4294967295u;
        case 3:
            return 1e39;
        case 4:
            return -1e-40;
        case 5:
            return random() % 100000;
        case 6:
            return nullptr;
        case 7:
            return std::string("data:application/octet-stream;base64,AAAA");
        case 8:
            return json::array({0, 1, 2});
        case 9:
            return json::object();
        case 10:
            return 5120 + random() % 8;  // near the component types
        default:
            return std::ldexp(1.0, static_cast<int>(random() % 140) - 10);
    }
}

/// Changes, removes or doubles one value somewhere in `node`.
void change(json& node, std::mt19937& random) {
    if (!node.is_structured() || node.empty() || random() % 16 == 0) {
        node = odd_value(random);
        return;
    }
    auto at = node.begin();
    std::advance(at, static_cast<std::ptrdiff_t>(random() % node.size()));
    if (random() % 24 == 0) {
        node.erase(at);
    } else if (node.is_array() && random() % 24 == 0) {
        node.push_back(json(*at));
    } else {
        change(*at, random);
    }
}

void check_scene(const Scene& scene) {
    const std::size_t vertices = scene.positions.size();
    fuzz::require(scene.triangle_count() > 0 && scene.indices.size() == 3 * scene.triangle_count(), "triangles");
    fuzz::require(!scene.cameras.empty(), "a scene has a camera");
    for (const std::uint32_t i : scene.indices) fuzz::require(i < vertices, "indices name vertices");
    for (const std::uint16_t m : scene.material_of) fuzz::require(m < scene.materials.size(), "materials exist");
    for (const Vec3 p : scene.positions) fuzz::require(is_finite(p), "positions are finite");
    fuzz::require(scene.colors.empty() || scene.colors.size() == vertices, "a colour per vertex");
    for (const auto& layer : scene.more_texcoords) fuzz::require(layer.size() == vertices, "coordinates per vertex");
    for (const Material& m : scene.materials)
        fuzz::require(m.base_color_texture < static_cast<int>(scene.textures.size()), "textures exist");
}

void trace_paths(Scene scene) {
    const PreparedScene prepared(std::move(scene), {});
    CaptureSettings settings;
    settings.width = settings.height = 8;
    settings.trace_samples = 1;
    const Capture capture(prepared, settings);
    const auto worker = capture.make_worker();
    traces::WarpTrace warp;
    capture.trace_warp(*worker, 0, 0, warp);
    prepared.embree();
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
    std::mt19937 random(seed);
    const unsigned kind = random() % 10;
    auto glb = take_apart({data, size});
    if (!glb || kind == 0) return LLVMFuzzerMutate(data, size, max_size);
    json document = kind < 3 ? json() : json::parse(glb->text, nullptr, false);
    if (kind < 3 && !glb->bin.empty()) {
        fuzz::mutate(glb->bin, glb->bin.size() + 16);
    } else if (kind > 3 && !document.is_discarded()) {
        change(document, random);
        glb->text = document.dump(-1, ' ', false, json::error_handler_t::replace);
    } else {
        Bytes text(glb->text.begin(), glb->text.end());
        fuzz::mutate(text, text.size() + 16);
        glb->text.assign(text.begin(), text.end());
    }
    return fuzz::hand_back(put_together(std::move(*glb)), data, size, max_size);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    const std::string path = fuzz::input_file("scene.glb", data, size);
    fuzz::accepts([&] {
        SceneRequest request;
        request.source = path;
        Scene scene = load_scene(request, [](const std::string&) {});
        check_scene(scene);
        if (scene.triangle_count() <= 1000) trace_paths(std::move(scene));
    });
    return 0;
}
