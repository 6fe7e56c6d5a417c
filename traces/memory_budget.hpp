// What one input may make the program allocate. A file of a few bytes can ask for gigabytes: whoever reads one charges
// what its content needs before it is allocated, and an input that asks for too much is refused in one line.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>

#include "traces/error.hpp"

namespace raycache {

/// An input that asks for more than its budget.
struct MemoryError : Error {
    using Error::Error;
};

/// Bytes that an input may take unless set_memory_limit() said otherwise: a quarter of machine_memory().
std::uint64_t memory_limit();
/// For every MemoryBudget made from now on; at least 1.
void set_memory_limit(std::uint64_t bytes);
/// Bytes of memory that this process can have: the machine's, or what its control group leaves of it.
std::uint64_t machine_memory();

/// "1.5 GiB", "712 bytes".
std::string size_text(std::uint64_t bytes);

/// The sum over everything that one input, a file with all it refers to, has made the program allocate. Thread-safe.
class MemoryBudget {
public:
    explicit MemoryBudget(std::uint64_t limit = memory_limit()) : limit_(limit) {}
    MemoryBudget(const MemoryBudget&) = delete;
    MemoryBudget& operator=(const MemoryBudget&) = delete;

    /// To be called before `bytes` are allocated for `what` of the input `where`. Throws MemoryError "WHERE: WHAT:
    /// expected … at most X, found Y …" that names --memory-limit, and takes nothing then.
    void charge(std::uint64_t bytes, std::string_view where, std::string_view what);
    /// Of what was charged, for memory that is free again.
    void release(std::uint64_t bytes) noexcept { used_ -= bytes; }
    /// Throws as charge() does but takes nothing: for memory that is free again before more is asked for.
    void check(std::uint64_t bytes, std::string_view where, std::string_view what) const;

    std::uint64_t limit() const { return limit_; }
    std::uint64_t used() const { return used_; }
    std::uint64_t left() const;

private:
    std::uint64_t limit_;
    std::atomic<std::uint64_t> used_{0};
};

/// A charge for as long as the object lives.
class MemoryHold {
public:
    MemoryHold(MemoryBudget& budget, std::uint64_t bytes, std::string_view where, std::string_view what)
        : budget_(budget), bytes_(bytes) {
        budget.charge(bytes, where, what);
    }
    ~MemoryHold() { budget_.release(bytes_); }
    MemoryHold(const MemoryHold&) = delete;
    MemoryHold& operator=(const MemoryHold&) = delete;

private:
    MemoryBudget& budget_;
    std::uint64_t bytes_;
};

}  // namespace raycache
