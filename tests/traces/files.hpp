// Files of the tests: a folder of their own, whole contents, the message of a refusal.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "traces/error.hpp"

/// A folder that goes away with the object.
class TemporaryFolder {
public:
    TemporaryFolder() {
        // In memory where there is such a folder: the tests write tens of thousands of small files.
        const std::filesystem::path memory = "/dev/shm";
        const bool usable = ::access(memory.c_str(), W_OK) == 0;
        std::string name = (usable ? memory : std::filesystem::temp_directory_path()) / "raycache_traces_XXXXXX";
        if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
        path_ = name;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    std::string operator/(const std::string& name) const { return (path_ / name).string(); }
    std::filesystem::path path() const { return path_; }

private:
    std::filesystem::path path_;
};

inline std::vector<std::uint8_t> read_file(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline void write_file(const std::string& path, const std::vector<std::uint8_t>& bytes) {
    std::ofstream out(path, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

/// The message of the Error that `action` throws; empty if it throws none.
template <class Action>
std::string refusal(Action action) {
    try {
        action();
    } catch (const raycache::Error& error) {
        return error.what();
    }
    return {};
}
