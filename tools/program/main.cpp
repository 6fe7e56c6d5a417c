// raycache: parse, run, report. One subcommand per file.
#include <algorithm>
#include <exception>
#include <new>
#include <stdexcept>

#include "tools/program/console.hpp"
#include "tools/program/interruption.hpp"
#include "tools/program/program.hpp"
#include "traces/error.hpp"
#include "traces/partial_file.hpp"

int main(int argc, char** argv) {
    using namespace raycache;
    tools::handle_signals();
    traces::on_published(tools::say_written);
    try {
        tools::Program().parse({argv + std::min(argc, 1), argv + argc})();
        return 0;
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
