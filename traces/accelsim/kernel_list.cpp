#include "traces/accelsim/kernel_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "traces/accelsim/text_lines.hpp"
#include "traces/error.hpp"
#include "traces/format.hpp"

namespace raycache::traces {
namespace {

constexpr const char* list_name = "kernelslist.g";
constexpr std::array<std::string_view, 8> endings{".traceg",     ".tracez", ".traceg.xz", ".traceg.gz",
                                                  ".traceg.zst", ".trace",  ".trace.xz",  ".trace.gz"};

/// Copies of memory, and of collective communication, between kernels.
bool is_command(std::string_view line) {
    return line.starts_with("Memcpy") || line.starts_with("nccl") || line.starts_with('#');
}

bool is_kernel_name(std::string_view line) {
    return line.find_first_of("\t,=") == std::string_view::npos &&
           std::any_of(endings.begin(), endings.end(), [&](std::string_view end) { return line.ends_with(end); });
}

std::string_view trimmed(std::string_view line) {
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    return line.substr(0, line.find_last_not_of(" \t\r") + 1);
}

}  // namespace

bool looks_like_kernel_list(const std::string& path) {
    std::error_code error;
    if (std::filesystem::is_directory(path, error)) return true;
    constexpr std::size_t enough = 4096;
    std::string_view rest;
    const std::string text = first_bytes(path, enough);
    for (rest = text; !rest.empty();) {
        const std::string_view line = trimmed(rest.substr(0, rest.find('\n')));
        rest.remove_prefix(std::min(rest.find('\n'), rest.size() - 1) + 1);
        if (line.empty() || is_command(line)) continue;
        return is_kernel_name(line);
    }
    return text.find("Memcpy") != std::string::npos;
}

std::vector<std::string> read_kernel_list(const std::string& path) {
    std::filesystem::path list = path;
    std::error_code error;
    if (std::filesystem::is_directory(list, error)) {
        list /= list_name;
        if (!std::filesystem::exists(list, error))
            throw Error(
                fmt::format("{}: expected a folder with a {}, found none there; name a kernel's .traceg or "
                            ".tracez, or run post-traces-processing on the tracer's kernelslist",
                            path, list_name));
    }
    TextLines lines(list.string());
    std::vector<std::string> kernels;
    for (std::string_view line; lines.next(line);) {
        line = trimmed(line);
        if (line.empty() || is_command(line)) continue;
        const std::filesystem::path kernel = list.parent_path() / line;
        if (!std::filesystem::is_regular_file(kernel, error))
            lines.refuse("kernel", "the name of a file beside the list, or Memcpy…", line,
                         "put the kernels' files beside it");
        if (kernels.size() == format::max_launches)
            lines.refuse("kernel", fmt::format("at most {}", format::max_launches), "more", "split the list");
        kernels.push_back(kernel.string());
    }
    if (kernels.empty())
        throw Error(
            fmt::format("{}: expected names of kernels' files, found none; write the list again", list.string()));
    return kernels;
}

}  // namespace raycache::traces
