// raycache: parse, run, report. One subcommand per file.
#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdio>
#include <exception>
#include <new>
#include <sstream>
#include <stdexcept>

#include "tools/commands.hpp"
#include "tools/console.hpp"
#include "tools/interruption.hpp"
#include "tools/memory_limit.hpp"
#include "traces/error.hpp"
#include "traces/partial_file.hpp"

namespace {

/// CLI11 reads "-1" into an unsigned option as 2^64 - 1, and any number too large likewise.
std::string check_count(const std::string& text) {
    std::uint64_t value = 0;
    if (!text.empty() && text[0] == '-') return text + ": expected no negative number";
    if (std::from_chars(text.data(), text.data() + text.size(), value).ec == std::errc::result_out_of_range)
        return text + ": expected at most 18446744073709551615";
    return {};
}

void check_counts(CLI::App& app) {
    for (CLI::App* command : app.get_subcommands({}))
        for (CLI::Option* option : command->get_options())
            if (option->get_type_name().find("UINT") != std::string::npos) option->check(check_count);
}

/// --help or --version.
int print_help(const CLI::App& app, const CLI::ParseError& asked) {
    std::ostringstream out, err;
    const int code = app.exit(asked, out, err);
    try {
        raycache::tools::print(out.str());
    } catch (const raycache::Error& e) {
        return raycache::tools::fail(e.what(), 1);
    }
    return code;
}

}  // namespace

int main(int argc, char** argv) {
    using namespace raycache;
    tools::handle_signals();
    traces::on_published(tools::say_written);
    CLI::App app{"Explains why one sampling strategy makes GPU ray tracing faster than another, without a GPU.",
                 "raycache"};
    app.set_version_flag("--version", tools::program_name());
    app.require_subcommand(1);
    app.footer(
        "Examples:\n"
        "  raycache compare --scene courtyard --strategy coherent,cranley-patterson,micro-jitter --spp 64 --gpu "
        "gtx-980-ti\n"
        "  raycache render courtyard --spp 16 -o courtyard.png\n"
        "  raycache compare --help");
    tools::add_render(app);
    tools::add_capture(app);
    tools::add_info(app);
    tools::add_verify(app);
    tools::add_replay(app);
    tools::add_compare(app);
    tools::add_explain(app);
    tools::add_quality(app);
    tools::add_sweep(app);
    tools::add_export(app);
    tools::add_import(app);
    tools::add_samples(app);
    tools::add_list(app);
    tools::add_completion(app);
    tools::add_memory_limit(app);
    check_counts(app);
    try {
        app.parse(argc, argv);
        return 0;
    } catch (const CLI::ParseError& e) {
        if (e.get_exit_code() == 0) return print_help(app, e);
        return tools::fail(e.what(), 2);
    } catch (const UsageError& e) {
        return tools::fail(e.what(), 2);
    } catch (const std::bad_alloc&) {
        return tools::fail("out of memory; try a smaller input, resolution or --detail", 1);
    } catch (const std::length_error&) {
        return tools::fail("a size beyond any memory; try a smaller input, resolution or --detail", 1);
    } catch (const std::exception& e) {
        return tools::fail(e.what(), 1);
    }
}
