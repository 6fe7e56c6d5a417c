// How the glTF reader speaks to the user: every message is one line that begins with the file's path.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "tracer/scene/scene.hpp"
#include "traces/memory_budget.hpp"

namespace raycache::tracer {

class GltfReport {
public:
    GltfReport(std::string path, const Warn& warn)
        : path_(std::move(path)), warn_(warn), memory_(std::make_shared<MemoryBudget>()) {}

    const std::string& path() const { return path_; }

    /// Remedies: of bytes that are missing, and of a description that is not what glTF 2.0 allows.
    static constexpr const char* damaged = "the file is cut short or damaged: copy or export it again";
    static constexpr const char* invalid = "glTF 2.0 does not allow it: correct it or export the scene again";

    /// Throws Error "PATH: WHERE: expected EXPECTED, found FOUND; REMEDY".
    [[noreturn]] void fail(const std::string& where, const std::string& expected, const std::string& found,
                           const std::string& remedy = invalid) const;

    void warning(const std::string& text) const;

    /// What the file, with all that it refers to, has made us allocate; becomes the scene's.
    const std::shared_ptr<MemoryBudget>& memory() const { return memory_; }
    /// Before `bytes` are allocated. Throws Error as MemoryBudget::charge() does.
    void charge(std::uint64_t bytes, const std::string& what) const;

private:
    std::string path_;
    const Warn& warn_;
    std::shared_ptr<MemoryBudget> memory_;
};

}  // namespace raycache::tracer
