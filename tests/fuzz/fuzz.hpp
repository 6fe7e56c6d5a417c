// What the fuzz targets share. Each file beside this one is a target: a program of libFuzzer that feeds one part of
// raycache with bytes. A refusal, an Error of one line, is fine; a crash, a hang or a broken promise is not.
// docs/testing.md says how to run them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/traces/files.hpp"
#include "traces/error.hpp"

/// Of libFuzzer: changes `size` bytes in place, to at most `max_size`; returns the new size.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace raycache::fuzz {

using Bytes = std::vector<std::uint8_t>;

/// Stops the fuzzer, which keeps the input, if a promise is broken.
inline void require(bool kept, const char* promise) {
    if (kept) return;
    std::fprintf(stderr, "broken promise: %s\n", promise);
    std::abort();
}

/// Runs `action`; an Error must be one line. Returns whether it was not refused.
template <class Action>
bool accepts(Action action) {
    try {
        action();
        return true;
    } catch (const Error& e) {
        const std::string what = e.what();
        require(!what.empty() && what.find('\n') == std::string::npos, "a refusal is one line");
    }
    return false;
}

/// A file that holds the input, in memory where possible, overwritten by the next.
inline std::string input_file(const std::string& name, const std::uint8_t* data, std::size_t size) {
    static const TemporaryFolder folder;
    const std::string path = folder / name;
    write_file(path, Bytes(data, data + size));
    return path;
}

/// LLVMFuzzerMutate() on bytes of their own.
inline void mutate(Bytes& bytes, std::size_t max_size) {
    const std::size_t size = bytes.size();
    bytes.resize(std::max(size, max_size));
    bytes.resize(LLVMFuzzerMutate(bytes.data(), size, bytes.size()));
}

/// What a custom mutator returns: `bytes` copied to `data` if they fit, else the input as it was.
inline std::size_t hand_back(const Bytes& bytes, std::uint8_t* data, std::size_t size, std::size_t max_size) {
    if (bytes.empty() || bytes.size() > max_size) return size;
    std::copy(bytes.begin(), bytes.end(), data);
    return bytes.size();
}

}  // namespace raycache::fuzz
