#include "tracer/quality/reference_file.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>

#include "traces/error.hpp"

namespace raycache::tracer {

namespace {

constexpr std::array<const char*, 6> names{
    "R", "G", "B", "half_difference.R", "half_difference.G", "half_difference.B"};
constexpr const char *key_attribute = "raycache:reference", *checksum_attribute = "raycache:checksum";

std::string checksum(const std::vector<Channel>& channels) {
    XXH64_hash_t sum = 0;
    for (const Channel& c : channels) sum = XXH3_64bits_withSeed(c.values.data(), c.values.size() * sizeof(float), sum);
    return fmt::format("{:016x}", sum);
}

[[noreturn]] void refuse_file(const std::string& path, const std::string& expected, const std::string& found) {
    throw Error(fmt::format("{}: expected {}, found {}; remove it or name another file", path, expected, found));
}

const Channel& find_channel(const std::string& path, const ChannelFile& file, const char* name) {
    for (const Channel& channel : file.channels)
        if (channel.name == name) return channel;
    refuse_file(path, fmt::format("a channel {}", name), "none");
}

/// Radiance is finite and not negative, in the mean as in either half, mean ± half difference.
void check_values(const std::string& path, const std::vector<Channel>& channels, std::uint32_t width) {
    constexpr float rounding = 1e-4F;
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t p = 0; p < channels[c].values.size(); ++p) {
            const float mean = channels[c].values[p], half = channels[c + 3].values[p];
            const auto at = [&](const char* name) {
                return fmt::format("{} in channel {} at pixel {}, {}", name == names[c] ? mean : half, name, p % width,
                                   p / width);
            };
            if (!std::isfinite(mean) || mean < 0) refuse_file(path, "finite values of 0 or more", at(names[c]));
            if (!(std::abs(half) <= mean * (1 + rounding) + std::numeric_limits<float>::min()))
                refuse_file(path, fmt::format("half differences of at most the mean, here {}", mean), at(names[c + 3]));
        }
    }
}

}  // namespace

void write_reference(const std::string& path, const Reference& reference) {
    std::vector<Channel> channels;
    for (std::size_t c = 0; c < names.size(); ++c) {
        Channel& channel = channels.emplace_back(Channel{names[c], {}});
        for (const Vec3 pixel : (c < 3 ? reference.mean : reference.half_difference).pixels)
            channel.values.push_back(pixel[static_cast<int>(c % 3)]);
    }
    write_channels(path, reference.mean.width, reference.mean.height, channels,
                   {{key_attribute, reference.key}, {checksum_attribute, checksum(channels)}});
}

Reference read_reference(const std::string& path, const std::string& key, ImageSize size) {
    const auto check_header = [&](const ChannelFile& header) {
        const std::string& found_key = header.attributes[0].second;
        if (found_key.empty()) refuse_file(path, "a reference that raycache wrote", "an image without its mark");
        if (found_key != key)
            refuse_file(path, fmt::format("the reference \"{}\"", key), fmt::format("\"{}\"", found_key));
        if (header.width != size.width || header.height != size.height)
            refuse_file(path, fmt::format("{} x {} pixels", size.width, size.height),
                        fmt::format("{} x {}", header.width, header.height));
        if (header.channels.size() != names.size())
            refuse_file(path, fmt::format("{} channels", names.size()), fmt::format("{}", header.channels.size()));
        for (const char* name : names) find_channel(path, header, name);
    };
    const ChannelFile file = read_channels(path, {key_attribute, checksum_attribute}, check_header);
    std::vector<Channel> channels;
    for (const char* name : names) channels.push_back(find_channel(path, file, name));
    if (checksum(channels) != file.attributes[1].second)
        refuse_file(path, fmt::format("pixels with checksum {}", file.attributes[1].second), checksum(channels));
    check_values(path, channels, file.width);

    Reference reference{{file.width, file.height, {}}, {file.width, file.height, {}}, key};
    for (std::size_t p = 0; p < channels[0].values.size(); ++p) {
        reference.mean.pixels.push_back({channels[0].values[p], channels[1].values[p], channels[2].values[p]});
        reference.half_difference.pixels.push_back(
            {channels[3].values[p], channels[4].values[p], channels[5].values[p]});
    }
    return reference;
}

std::string cached_reference_path(const std::string& key) {
    std::filesystem::path folder;
    const char *cache = std::getenv("XDG_CACHE_HOME"), *home = std::getenv("HOME");
    if (cache && *cache == '/')  // the XDG base directory specification ignores relative paths
        folder = cache;
    else if (home && *home)
        folder = std::filesystem::path(home) / ".cache";
    else
        return {};
    const std::string name = fmt::format("{:016x}.exr", XXH3_64bits(key.data(), key.size()));
    return (folder / "raycache" / "references" / name).string();
}

}  // namespace raycache::tracer
