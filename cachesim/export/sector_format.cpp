#include "cachesim/export/sector_format.hpp"

#include <fmt/format.h>

#include <iterator>

namespace raycache::cachesim {
namespace {

const char* name_of(traces::RayType ray) {
    switch (ray) {
        case traces::RayType::camera:
            return "camera";
        case traces::RayType::bounce:
            return "bounce";
        case traces::RayType::shadow:
            return "shadow";
    }
    return "?";
}

void append_dinero(const SectorAccess& a, std::string& out) {
    fmt::format_to(std::back_inserter(out), "0 {:x}\n", a.address);
}

void append_u64(const SectorAccess& a, std::string& out) {
    for (int shift = 0; shift < 64; shift += 8) out += static_cast<char>(a.address >> shift & 0xff);
}

void append_csv(const SectorAccess& a, std::string& out) {
    fmt::format_to(std::back_inserter(out), "{},{},{},{},{},{}\n", a.address, a.cache, name_of(a.ray), a.bounce,
                   name_of(a.kind), a.hit ? 1 : 0);
}

}  // namespace

const std::vector<SectorFormat>& sector_formats() {
    static const std::vector<SectorFormat> formats{
        {"dinero", "read records of Dinero IV's \"din\" input: 0 and the address in hexadecimal", "", false,
         append_dinero},
        {"u64", "byte addresses of 8 bytes each, little-endian", "", false, append_u64},
        {"csv", "a table with ray, bounce, kind of object and hit", "address,cache,ray,bounce,kind,hit\n", true,
         append_csv}};
    return formats;
}

}  // namespace raycache::cachesim
