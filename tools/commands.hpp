// The subcommands. Each adds itself to the program: its options, its help, and what runs when it is chosen.
#pragma once

namespace CLI {
class App;
}

namespace raycache::tools {

void add_render(CLI::App&);
void add_capture(CLI::App&);
void add_info(CLI::App&);
void add_verify(CLI::App&);
void add_replay(CLI::App&);
void add_compare(CLI::App&);
void add_explain(CLI::App&);
void add_quality(CLI::App&);
void add_sweep(CLI::App&);
void add_export(CLI::App&);
void add_import(CLI::App&);
void add_samples(CLI::App&);
void add_list(CLI::App&);
void add_completion(CLI::App&);

}  // namespace raycache::tools
