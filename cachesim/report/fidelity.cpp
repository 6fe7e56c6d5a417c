#include "cachesim/report/fidelity.hpp"

#include <fmt/format.h>

#include "cachesim/report/format.hpp"
#include "cachesim/report/json_parts.hpp"
#include "cachesim/report/table.hpp"

namespace raycache::cachesim {
namespace {

using Align = TextTable::Align;

std::string blocks_text(std::uint32_t blocks) { return blocks == 0 ? std::string("all") : fmt::format("{}", blocks); }

std::string levels_table(const FidelityChoice& choice, std::size_t width) {
    TextTable table;
    table.column("level", Align::left);
    for (const char* title : {"blocks in time", "blocks of work", "CPU s"}) table.column(title, Align::right);
    table.column("reaches the target", Align::left);
    for (const FidelityChoice::Level& level : choice.levels)
        table.row({level.name, blocks_text(level.timed_blocks), blocks_text(level.blocks), figure(level.seconds),
                   level.suffices ? "yes" : "no"});
    return table.text(width);
}

std::string pilots_table(const FidelityChoice& choice, std::size_t width) {
    TextTable table;
    table.subject("strategy", Align::left);
    table.subject("N", Align::right);
    table.subject("GPU", Align::left);
    for (const char* title : {"by work", "by time", "time/work"}) table.column(title, Align::right);
    for (const FidelityChoice::Pilot& pilot : choice.pilots)
        table.row({pilot.strategy, fmt::format("{}", pilot.spp), pilot.gpu, with_interval(pilot.by_work, 3),
                   with_interval(pilot.by_time, 3), with_interval(pilot.difference, 3)});
    return table.text(width);
}

}  // namespace

std::string to_text(const FidelityChoice& choice, std::size_t width) {
    std::string text =
        fmt::format("\nFidelity: {}, to ±{:g} % of every speed-up\n\n", choice.picked, 100 * choice.target);
    if (!choice.pilots.empty()) text += pilots_table(choice, width) + '\n';
    text += levels_table(choice, width) + '\n' + paragraph(choice.reason + '.');
    const std::string pilot =
        choice.pilots.empty()
            ? std::string("no pilot was run")
            : fmt::format(
                  "the first table is of the pilot of {} blocks, {} CPU s: speed-ups by work alone (the "
                  "instructions that traversal issues), by windows in time, and one over the other",
                  choice.pilot_blocks, figure(choice.pilot_seconds));
    return text + paragraph(fmt::format(
                      "Seconds are modelled from counts, of one thread, beyond the pilot's; so the choice is the same "
                      "on every machine. {}.",
                      pilot));
}

Json to_json_value(const FidelityChoice& choice) {
    Json json{{"picked", choice.picked},
              {"reason", choice.reason},
              {"target_error", json_of(choice.target)},
              {"pilot_blocks", choice.pilot_blocks},
              {"pilot_cpu_seconds", json_of(choice.pilot_seconds)},
              {"levels", Json::array()},
              {"pilot", Json::array()}};
    for (const FidelityChoice::Level& level : choice.levels)
        json["levels"].push_back({{"level", level.name},
                                  {"timed_blocks", level.timed_blocks ? Json(level.timed_blocks) : Json(nullptr)},
                                  {"blocks", level.blocks ? Json(level.blocks) : Json(nullptr)},
                                  {"cpu_seconds", json_of(level.seconds)},
                                  {"reaches_target", level.suffices}});
    for (const FidelityChoice::Pilot& pilot : choice.pilots)
        json["pilot"].push_back({{"strategy", pilot.strategy},
                                 {"gpu", pilot.gpu},
                                 {"spp", pilot.spp},
                                 {"by_work", json_of(pilot.by_work)},
                                 {"by_time", json_of(pilot.by_time)},
                                 {"time_over_work", json_of(pilot.difference)}});
    return json;
}

}  // namespace raycache::cachesim
