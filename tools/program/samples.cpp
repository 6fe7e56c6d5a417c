// raycache samples: the points that all pixels together take, their holes and density, and the tables about them.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tools/jobs/outputs.hpp"
#include "tools/jobs/samples_job.hpp"
#include "tools/jobs/samples_picture.hpp"
#include "tools/jobs/samples_tables.hpp"
#include "tools/program/commands.hpp"
#include "tools/program/console.hpp"
#include "tools/program/idle_options.hpp"
#include "tools/program/json_output.hpp"
#include "tools/program/options.hpp"
#include "tools/program/program.hpp"
#include "tools/program/progress.hpp"
#include "tracer/drawing.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

struct SamplesArguments {
    std::string sequence = "halton", strategy = "micro-jitter";
    std::uint64_t spp = 128, copies = 150;
    std::vector<std::uint32_t> dimensions{0, 1};
    SamplingOptions sampling;
    std::string csv, picture, figure2, table;
    JsonOption json;
    ThreadOptions threads;
};

SamplesJob job_of(const SamplesArguments& o) {
    return {o.sampling, {{o.strategy}, o.sequence, o.spp, {}, {}}, {o.dimensions[0], o.dimensions[1]}, o.copies};
}

SampleUnion make(SamplesJob job, const std::string& strategy, std::optional<double> k) {
    job.strategy.strategy = {strategy};
    if (k) {
        job.sampling.k = fmt::format("{}", *k);
        job.sampling.s = "2";
        job.sampling.mu.clear();
        job.sampling.parameters.clear();
    }
    Observer silent;  // of these panels nobody asked
    return run(job, silent).samples;
}

void check_picture_name(const char* option, const std::string& path) {
    if (!path.empty() && !path.ends_with(".png"))
        throw UsageError(fmt::format("{} '{}'; expected a file name that ends in .png", option, path));
}

std::string subject(const SamplesArguments& o) {
    return fmt::format("{} dimensions {},{}, N {}, {} copies", o.sequence, o.dimensions[0], o.dimensions[1], o.spp,
                       o.copies);
}

/// For an N that the star discrepancy is known of. K below the hole-free one by half leaves holes; the paper's own K
/// comes from the star discrepancy.
void write_figure2(const SamplesArguments& o) {
    const SamplesJob job = job_of(o);
    const SampleUnion coherent = make(job, "coherent", {});
    const double from_discrepancy = coherent.k_from_discrepancy().value(), small = coherent.hole_free_k / 2;
    const SampleUnion narrow = make(job, "micro-jitter", small), right = make(job, "micro-jitter", from_discrepancy),
                      rotated = make(job, "cranley-patterson", {});
    tracer::write_screen_image(
        o.figure2, draw_samples(subject(o), {{"coherent", &coherent},
                                             {fmt::format("micro-jitter, mu too small, K {:.2f}", small), &narrow},
                                             {fmt::format("micro-jitter, K {:.2f}", from_discrepancy), &right},
                                             {"cranley-patterson", &rotated}}));
}

void run(const SamplesArguments& o, const Command& command) {
    check_outputs({o.csv, o.picture, o.figure2}, warn);
    if (!o.picture.empty() || !o.figure2.empty()) tracer::check_drawing();
    const auto limit = o.threads.apply();
    Progress progress("samples");
    const SamplesJob job = job_of(o);
    tracer::CaptureSettings one;
    one.strategy = job.settings();
    for (const std::string& line : idle_options(command, {&one, 1}, {false, "only points are shown"})) warn(line);
    const SampleUnion samples = run(job, progress).samples;
    Deliveries deliveries;
    deliveries.attempt([&] { print(o.json ? o.json.document(to_json(samples)) : to_text(samples)); });
    if (!o.csv.empty()) deliveries.attempt([&] { write_text(o.csv, to_csv(samples)); });
    const std::string title = o.strategy + (samples.parameters.empty() ? "" : " ") + samples.parameters;
    if (!o.picture.empty())
        deliveries.attempt([&] {
            tracer::write_screen_image(o.picture, draw_samples(subject(o), {{title, &samples}}));
        });
    if (!o.figure2.empty()) deliveries.attempt([&] { write_figure2(o); });
    deliveries.finish(say_failure);
}

void run_table(const SamplesArguments& o, const Command& command) {
    const std::vector<std::string> read{"--table", "--json", "--threads"};
    for (const std::string& line : idle_besides(command, read, "a table has settings of its own")) warn(line);
    const auto limit = o.threads.apply();
    Progress progress("samples");
    const Stage stage(progress, "points");
    const SamplesTable table = make_samples_table(o.table);
    print(o.json ? o.json.document(table.json()) : table.text());
}

Action plan(const std::shared_ptr<const SamplesArguments>& o, const Command* command) {
    if (!o->table.empty()) return [o, command] { run_table(*o, *command); };
    refuse_stdout("--csv", o->csv);
    check_picture_name("--picture", o->picture);
    check_picture_name("--figure2", o->figure2);
    if (!o->figure2.empty() && o->spp > tracer::max_star_discrepancy_points)
        throw UsageError(
            fmt::format("--figure2 with --spp {}; expected at most {}", o->spp, tracer::max_star_discrepancy_points));
    return [o, command] { run(*o, *command); };
}

}  // namespace

void add_samples(Program& program) {
    auto o = std::make_shared<SamplesArguments>();
    Command* command = program.add_subcommand(
        "samples", "Show the points of all pixels in two dimensions of a strategy: holes, density, picture");
    command->add_option("--sequence", o->sequence, "low-discrepancy sequence (see 'raycache list sequences')")
        ->choices("sequence", sequence_names());
    command->add_option("--strategy", o->strategy, "decorrelation (see 'raycache list strategies')")
        ->choices("strategy", strategy_names());
    add_spp(*command, o->spp, "N, points of one pixel");
    command->add_option("--copies", o->copies, "how many pixels")->range(std::uint64_t{1}, std::uint64_t{1} << 32);
    command->add_option("--dimensions", o->dimensions, "which two dimensions")->count(2)->type_name("A,B");
    command->add_option("--csv", o->csv, "write all points: copy, sample, x, y")->type_name("FILE");
    command->add_option("--picture", o->picture, "draw all points")->type_name("FILE.png");
    command
        ->add_option("--figure2", o->figure2,
                     "draw four panels: coherent, mu too small, mu from the star discrepancy, cranley-patterson")
        ->type_name("FILE.png");
    command
        ->add_option("--table", o->table,
                     fmt::format("instead of one strategy, a table of docs/sampling.md: {}",
                                 fmt::join(samples_table_names(), ", ")))
        ->choices("table", samples_table_names())
        ->excludes({"--csv", "--picture", "--figure2"});
    o->json.add(*command);
    o->threads.add(*command);
    o->sampling.add_strategy(*command);
    command->examples(
        {"raycache samples --sequence halton --strategy micro-jitter --spp 128 --copies 150 --k 1 --picture holes.png",
         "raycache samples --sequence sobol --spp 1024 --dimensions 2,3 --mu 0.05 --csv points.csv --json",
         "raycache samples --figure2 figure2.png", "raycache samples --table bias"});
    command->plan([o, command] { return plan(o, command); });
}

}  // namespace raycache::tools
