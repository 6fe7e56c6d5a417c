#include "tools/jobs/export_accel_sim.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "tools/jobs/observer.hpp"
#include "tools/jobs/outputs.hpp"
#include "traces/accelsim/xz_file.hpp"
#include "traces/error.hpp"
#include "traces/read_launch.hpp"

namespace raycache::tools {
namespace {

void write_kernel(const traces::Reader& reader, std::uint32_t launch, const traces::TracegSettings& settings,
                  const std::string& path, Observer& observer) {
    if (reader.header().issue)
        observer.warn(
            "the trace says what its loads wait for and what other instructions there are; exported, each object waits "
            "for the one before, and loads are all there is");
    traces::XzFile file(path);
    traces::TracegText text(reader.header(), settings, [&](std::string_view piece) { file.write(piece); });
    const Stage stage(observer, "write", reader.header().warps_per_launch, "warps");
    traces::read_launch(reader, launch, [&](const traces::WarpTrace& warp) {
        text.add(warp);
        stage.add(1, 1);
    });
    text.finish();
    file.commit();
}

constexpr const char *kernel_name = "kernel-1.traceg", *list_name = "kernelslist.g";

/// Whether the output is the kernel itself, not a folder for it.
bool is_kernel(const std::string& output) {
    std::error_code error;
    return output == "-" || output.ends_with(".traceg") || output.ends_with(".traceg.xz") ||
           std::filesystem::is_other(output, error);
}

}  // namespace

std::vector<std::string> accel_sim_files(const std::string& output) {
    if (is_kernel(output)) return {output};
    const std::filesystem::path folder = output;
    return {(folder / kernel_name).string(), (folder / list_name).string()};
}

void export_accel_sim(const traces::Reader& reader, std::uint32_t launch, const traces::TracegSettings& settings,
                      const std::string& output, Observer& observer) {
    if (is_kernel(output)) {
        check_outputs({output}, observer.warning());
        return write_kernel(reader, launch, settings, output, observer);
    }
    std::error_code error;
    const bool made = std::filesystem::create_directory(output, error);
    if (error || !std::filesystem::is_directory(output, error))
        throw Error(
            fmt::format("{}: expected a folder or room for a new one, found {}; name another folder, or a file that "
                        "ends in .traceg "
                        "or .traceg.xz",
                        output, error ? fmt::format("\"{}\"", error.message()) : std::string("a file")));
    const std::filesystem::path folder = output;
    try {
        check_outputs(accel_sim_files(output), observer.warning());
        write_kernel(reader, launch, settings, folder / kernel_name, observer);
        write_text(folder / list_name, fmt::format("{}\n", kernel_name));
    } catch (...) {
        if (made) std::filesystem::remove(folder, error);  // if it is empty
        throw;
    }
}

}  // namespace raycache::tools
