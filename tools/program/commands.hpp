// The subcommands. Each adds itself to the program: its options, its help, and what runs when it is chosen.
#pragma once

namespace raycache::tools {

class Program;

void add_render(Program&);
void add_capture(Program&);
void add_info(Program&);
void add_verify(Program&);
void add_replay(Program&);
void add_compare(Program&);
void add_counters(Program&);
void add_explain(Program&);
void add_curve(Program&);
void add_measure(Program&);
void add_quality(Program&);
void add_sweep(Program&);
void add_sensitivity(Program&);
void add_export(Program&);
void add_import(Program&);
void add_samples(Program&);
void add_list(Program&);
void add_completion(Program&);

}  // namespace raycache::tools
