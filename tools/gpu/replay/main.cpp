#include <iostream>

#include "tools/gpu/replay/replay.hpp"

int main(int count, char** words) { return raycache::gpu::replay_main(count, words, std::cout, std::cerr); }
