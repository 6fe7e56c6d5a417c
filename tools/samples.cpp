// raycache samples: where a strategy's samples lie, and what that does to an integral.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>

#include "tools/commands.hpp"
#include "tools/console.hpp"
#include "tools/options.hpp"
#include "tools/samples_report.hpp"
#include "tools/samples_tables.hpp"
#include "traces/error.hpp"
#include "traces/output_file.hpp"

namespace raycache::tools {
namespace {

struct Options {
    SamplingOptions sampling;
    ThreadOptions threads;
    std::string sequence = "sobol", strategy = "micro-jitter", table, picture, csv;
    std::uint64_t spp = 64;
    std::uint32_t copies = 150;
    std::vector<std::uint32_t> dimensions{0, 1};
    bool json = false;
};

/// Four panels: the base points, windows of half the side that closes the holes, the strategy asked for, and
/// Cranley–Patterson.
void write_picture(const std::string& path, const SamplesRequest& request, const SamplesReport& asked) {
    const auto variant = [&](const char* decorrelation, std::optional<double> mu) {
        SamplesRequest other = request;
        other.strategy.decorrelation = decorrelation;
        other.strategy.parameters.mu = mu;
        other.strategy.parameters.cycles_mu = false;
        return sample(other).panel;
    };
    SamplePanel base = variant("coherent", std::nullopt);
    base.title = fmt::format("{} points of {}", request.strategy.parameters.spp, request.strategy.sequence);
    base.subtitle = fmt::format("least K without a hole: {:.2f}", asked.hole_free_k());
    base.mu = 1;  // no shading: all of it would be a hole
    base.points = base.base;
    base.index.clear();
    for (std::uint32_t i = 0; i < base.points.size(); ++i) base.index.push_back(i);
    const auto panels = {base, variant("micro-jitter", asked.base_hole / 2), asked.panel,
                         variant("cranley-patterson", std::nullopt)};
    tracer::write_screen_image(path, draw_samples(panels, request.strategy.parameters.spp));
}

void run(const Options& o) {
    const auto limit = o.threads.apply();
    if (!o.table.empty()) {
        const auto tables = make_samples_tables(o.table, o.sequence, o.sampling.seed);
        print(o.json ? to_json(tables) : to_text(tables));
        return;
    }
    if (o.dimensions.size() != 2)
        throw UsageError(fmt::format("--dimensions with {} numbers; expected two such as 0,1", o.dimensions.size()));
    if (!o.picture.empty() && !o.picture.ends_with(".png"))
        throw UsageError(fmt::format("--picture '{}'; expected a name that ends in .png", o.picture));
    SamplesRequest request;
    request.strategy = o.sampling.strategy(o.sequence, o.strategy, o.spp);
    request.copies = o.copies;
    request.first = o.dimensions[0];
    request.second = o.dimensions[1];
    const SamplesReport report = sample(request);
    if (!report.warning.empty()) warn(report.warning);
    if (!o.csv.empty()) {
        traces::OutputFile file(o.csv);
        file.write(to_csv(report));
        file.commit();
    }
    if (!o.picture.empty()) write_picture(o.picture, request, report);
    print(o.json ? to_json(report) : to_text(report));
}

}  // namespace

void add_samples(CLI::App& app) {
    auto o = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "samples", "Show where a strategy's samples lie: holes, density, discrepancy; or tables of all strategies");
    command->add_option("--sequence", o->sequence, "see 'raycache list sequences'")->capture_default_str();
    command->add_option("--strategy", o->strategy, "see 'raycache list strategies'")->capture_default_str();
    command->add_option("--spp", o->spp, "N, the samples of a pixel")->capture_default_str();
    command->add_option("--copies", o->copies, "pixels whose samples are taken together")->capture_default_str();
    command->add_option("--dimensions", o->dimensions, "two dimensions of the samples, from 0")
        ->delimiter(',')
        ->capture_default_str();
    o->sampling.add_strategy(*command);
    command->add_option("--picture", o->picture, "write a .png: base points, holes, the strategy, Cranley-Patterson");
    command->add_option("--csv", o->csv, "write all samples: copy,index,x,y");
    command->add_option(
        "--table", o->table,
        fmt::format("a table of all sequences or strategies instead: {}", fmt::join(samples_tables(), ", ")));
    command->add_flag("--json", o->json, "print JSON");
    o->threads.add(*command);
    command->footer(
        "Examples:\n"
        "  raycache samples --sequence halton --spp 128 --copies 150 --picture figure2.png\n"
        "  raycache samples --sequence sobol --spp 1024 --dimensions 4,5 --mu cycles --json\n"
        "  raycache samples --table holes\n"
        "  raycache samples --table errors --sequence sobol");
    command->callback([o] { run(*o); });
}

}  // namespace raycache::tools
