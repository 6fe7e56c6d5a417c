// Sends what the caches of one SM, or the level that all SMs share, are asked during a replay to a text or byte stream.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "cachesim/export/sector_format.hpp"

namespace raycache::cachesim {

class SectorStream final : public RequestSink {
public:
    /// Whom to listen to.
    struct Choice {
        std::size_t level = 0;            ///< index into Gpu::levels
        std::uint32_t sm = 0;             ///< whose caches; 0 for the level that all share
        std::optional<std::uint32_t> l1;  ///< only this L1 of the SM; none: all of them, in the order of the replay
    };

    /// `write` gets the format's head, then the sectors, in pieces of about 64 KiB.
    SectorStream(Choice, const SectorFormat&, std::uint32_t sector_bytes, std::function<void(std::string_view)> write);

    bool wants(std::size_t level, std::uint32_t sm) const override {
        return level == choice_.level && sm == choice_.sm;
    }
    /// The sectors of each look-up in ascending order.
    void served(std::size_t level, std::span<const ServedRequest>) override;

    /// Writes what is left. Call after Replay::finish().
    void flush();

private:
    void write(const ServedRequest&);

    Choice choice_;
    const SectorFormat& format_;
    std::uint32_t sector_bytes_;
    std::function<void(std::string_view)> write_;
    std::string pending_;
};

}  // namespace raycache::cachesim
