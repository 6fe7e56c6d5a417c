// How the program ends when it is told to (Ctrl-C, kill, a closed terminal) or when what it writes to goes away.
#pragma once

#include <string>

namespace raycache::tools {

/// First thing in main(), before any thread: SIGINT, SIGTERM and SIGHUP end the program by that signal, but remove
/// unfinished files first and say on stderr what remains. One that the parent process ignores (nohup) stays ignored.
/// Writing to a pipe that nobody reads, or beyond a size limit, becomes an error of that write. A standard stream that
/// is closed is replaced by one that fails, so that no file takes its number.
void handle_signals();

/// What the user can do after an interruption, said as the last words: "…; run the same command again". Replaces what
/// was said before.
void advise_if_interrupted(std::string advice);

}  // namespace raycache::tools
