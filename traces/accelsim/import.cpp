#include "traces/accelsim/import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "traces/accelsim/kernel_list.hpp"
#include "traces/loads/load_writer.hpp"

namespace raycache::traces {
namespace {

/// The different texts, in order of their first.
template <class Text>
std::string different(const std::vector<ImportedKernel>& kernels, Text text) {
    constexpr std::size_t most = 4;
    std::vector<std::string> found;
    for (const ImportedKernel& k : kernels) {
        const std::string next = text(k.kernel);
        if (std::find(found.begin(), found.end(), next) == found.end()) found.push_back(next);
    }
    const std::size_t more = found.size() > most ? found.size() - most : 0;
    found.resize(found.size() - more);
    return fmt::format("{}{}", fmt::join(found, ","), more > 0 ? fmt::format(" and {} more", more) : "");
}

std::string file_name(const std::string& path) {
    const std::filesystem::path named = path;
    return (named.has_filename() ? named : named.parent_path()).filename().string();
}

}  // namespace

std::vector<ImportedKernel> import_traceg(const std::string& input, const std::string& output,
                                          const ImportSettings& settings) {
    std::vector<ImportedKernel> kernels;
    if (looks_like_kernel_list(input))
        for (std::string& file : read_kernel_list(input)) kernels.push_back({std::move(file), {}});
    else
        kernels.push_back({input, {}});

    LoadPass pass;
    pass.file = input;
    pass.launches = kernels.size();
    pass.kernel = [&](std::size_t launch) {
        const TracegKernel& kernel = kernels[launch].kernel;
        return LoadKernel{kernel.ctas * kernel.warps_per_cta, kernel.warps_per_cta};
    };
    pass.read = [&](std::size_t launch, const LoadPass::Use& use) {
        ImportedKernel& kernel = kernels[launch];
        AccessFuser fuser(settings.fuse);
        TracegOptions options;
        options.null_lanes = settings.null_lanes;
        options.stores = settings.stores;
        options.number_by_place = !kernel.kernel.in_order;
        if (!settings.traversal)
            options.warp_end = [&](std::uint64_t warp, std::vector<LoadStep>&& steps) {
                fuser.end_warp(warp, steps, use);
            };
        const bool in_order = kernel.kernel.in_order;
        TracegKernel found = parse_traceg(
            kernel.file,
            [&](std::uint64_t warp, GlobalLoad& load) {
                if (settings.traversal) load.steps.clear();
                fuser.add(warp, load, use);
            },
            options);
        fuser.flush(use);
        kernel.kernel = std::move(found);
        kernel.kernel.in_order &= in_order;
    };

    Header header;
    header.issue = !settings.traversal;
    header.provenance.program = settings.program;
    header.provenance.command = settings.command;
    header.provenance.decorrelation = file_name(input);
    pass.finish = [&](Header& head) {
        head.provenance.scene = different(kernels, [](const TracegKernel& k) { return k.name; });
        head.provenance.parameters =
            "warps/CTA=" + different(kernels, [](const TracegKernel& k) { return fmt::format("{}", k.warps_per_cta); });
    };
    write_loads(pass, std::move(header), output);
    return kernels;
}

}  // namespace raycache::traces
