#include "traces/provenance.hpp"

#include <charconv>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

namespace raycache::traces {
namespace {

using nlohmann::json;

/// Calls visit(key, member) for every member that is stored under its own name.
template <class P, class Visit>
void each_member(P& provenance, std::uint32_t version, Visit visit) {
    visit("program", provenance.program);
    visit("command", provenance.command);
    visit("scene", provenance.scene);
    visit("camera", provenance.camera);
    visit("sequence", provenance.sequence);
    visit("decorrelation", provenance.decorrelation);
    visit("parameters", provenance.parameters);
    visit("thread_map", provenance.thread_map);
    visit("layout", provenance.layout);
    visit("spp", provenance.spp);
    visit("seed", provenance.seed);
    visit("width", provenance.width);
    visit("height", provenance.height);
    visit("bounces", provenance.bounces);
    if (version < 2) return;
    visit("execution", provenance.execution);
    visit("order", provenance.order);
}

[[noreturn]] void wrong(const Origin& origin, const std::string& what, const char* expected, const std::string& found) {
    refuse(origin, "provenance: " + what, expected, found, recapture);
}

const json& find(const json& object, const char* key, const Origin& origin) {
    const auto at = object.find(key);
    if (at == object.end()) wrong(origin, fmt::format("key \"{}\"", key), "a value", "none");
    return *at;
}

void read(const json& value, const char* key, std::string& out, const Origin& origin) {
    if (!value.is_string()) wrong(origin, key, "a string", value.type_name());
    out = value.get<std::string>();
}

template <class Unsigned>
void read(const json& value, const char* key, Unsigned& out, const Origin& origin) {
    if (!value.is_number_unsigned()) wrong(origin, key, "an unsigned number", value.type_name());
    const auto number = value.get<std::uint64_t>();
    if (number > std::numeric_limits<Unsigned>::max()) wrong(origin, key, "32 bits", fmt::format("{}", number));
    out = static_cast<Unsigned>(number);
}

}  // namespace

std::string provenance_to_json(const Provenance& provenance, std::uint32_t version) {
    json object;
    each_member(provenance, version, [&](const char* key, const auto& member) { object[key] = member; });
    // A string: a JSON number loses the low bits of 64 in many readers.
    object["scene_hash"] = hex64(provenance.scene_hash);
    try {
        return object.dump();
    } catch (const json::exception&) {
        throw Error(
            "provenance of the trace: expected UTF-8 text, found other bytes; use a scene and file name in UTF-8");
    }
}

Provenance provenance_from_json(std::string_view text, std::uint32_t version, const Origin& origin) {
    const json object = json::parse(text, nullptr, false);
    if (!object.is_object()) wrong(origin, "text", "a JSON object", "something else");
    Provenance provenance;
    std::size_t members = 1;  // scene_hash
    each_member(provenance, version, [&](const char* key, auto& member) {
        read(find(object, key, origin), key, member, origin);
        ++members;
    });
    std::string hash;
    read(find(object, "scene_hash", origin), "scene_hash", hash, origin);
    const char* end = hash.data() + hash.size();
    if (hash.size() != 18 || !hash.starts_with("0x") ||
        std::from_chars(hash.data() + 2, end, provenance.scene_hash, 16).ptr != end)
        wrong(origin, "scene_hash", "0x and 16 hexadecimal digits", "another string");
    if (object.size() != members)
        wrong(origin, "keys", fmt::format("{}", members).c_str(), fmt::format("{}", object.size()));
    return provenance;
}

}  // namespace raycache::traces
