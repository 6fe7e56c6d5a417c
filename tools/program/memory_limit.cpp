#include "tools/program/memory_limit.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <string_view>
#include <utility>

#include "tools/program/program.hpp"
#include "traces/error.hpp"
#include "traces/memory_budget.hpp"

namespace raycache::tools {

std::uint64_t parse_size(const std::string& text, const std::string& option) {
    constexpr std::array<std::pair<std::string_view, unsigned>, 5> units{
        {{"", 0}, {"KiB", 10}, {"MiB", 20}, {"GiB", 30}, {"TiB", 40}}};
    std::uint64_t number = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    for (const auto& [unit, shift] : units)
        if (error == std::errc{} && number != 0 && std::string_view(stop, end) == unit &&
            number <= ~std::uint64_t{0} >> shift)
            return number << shift;
    throw UsageError(fmt::format(
        "{} '{}'; expected a size above 0 and below 16 EiB, such as 4GiB or 512MiB (units KiB, MiB, GiB, TiB, or none "
        "for bytes)",
        option, text));
}

void add_memory_limit(Program& program) {
    for (const auto& command : program.commands()) {
        const std::string& name = command->name();
        if (name == "list" || name == "completion" || name == "samples") continue;
        const auto limit = std::make_shared<std::string>();
        command
            ->add_option(
                "--memory-limit", *limit,
                "most memory that one input (a trace, a scene with all it refers to) or picture may take, such "
                "as 4GiB or 512MiB; default: a quarter of the machine's")
            ->check([limit](std::string& text) { set_memory_limit(parse_size(text, "--memory-limit")); })
            ->type_name("SIZE");
    }
}

}  // namespace raycache::tools
