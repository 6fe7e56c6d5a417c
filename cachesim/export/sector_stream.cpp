#include "cachesim/export/sector_stream.hpp"

#include <bit>
#include <utility>

namespace raycache::cachesim {

namespace {
constexpr std::size_t piece_bytes = std::size_t{1} << 16;
}

SectorStream::SectorStream(Choice choice, const SectorFormat& format, std::uint32_t sector_bytes,
                           std::function<void(std::string_view)> write)
    : choice_(choice), format_(format), sector_bytes_(sector_bytes), write_(std::move(write)), pending_(format.head) {}

void SectorStream::served(std::size_t /*level*/, std::span<const ServedRequest> requests) {
    for (const ServedRequest& request : requests) write(request);
}

void SectorStream::write(const ServedRequest& request) {
    if (choice_.l1 && *choice_.l1 != request.cache) return;
    for (std::uint32_t left = request.asked; left != 0; left &= left - 1) {
        const auto sector = static_cast<unsigned>(std::countr_zero(left));
        format_.append({request.address + std::uint64_t{sector} * sector_bytes_, request.cache, request.ray,
                        request.bounce, request.kind, (request.missing >> sector & 1) == 0},
                       pending_);
    }
    if (pending_.size() >= piece_bytes) flush();
}

void SectorStream::flush() {
    write_(pending_);
    pending_.clear();
}

}  // namespace raycache::cachesim
