// compare and explain: a scene or traces, told apart by what a file holds.
#include "tools/program/inputs.hpp"

#include <catch2/catch.hpp>

#include <fstream>

#include "tests/tools/command_line.hpp"

namespace raycache::tools {
namespace {

using Catch::Contains;
using test::refusal;
using test::words_of;

void write(const std::string& name, const std::string& text) { std::ofstream(name, std::ios::binary) << text; }

TEST_CASE("the content of a file tells a scene from a trace, whatever it is called") {
    const test::InFolder folder({"empty.glb", "empty.rct", "empty"});
    write("trace.glb", "RCTRACE\x1a\x01");
    write("scene.rct", "glTF\x02");
    write("text.scene", "\n {\"asset\": {}}");
    write("other", "hello");
    CHECK(kind_of_input("courtyard") == InputKind::scene);
    CHECK(kind_of_input("trace.glb") == InputKind::trace);
    CHECK(kind_of_input("scene.rct") == InputKind::scene);
    CHECK(kind_of_input("text.scene") == InputKind::scene);
    CHECK(kind_of_input("other") == InputKind::unknown);
    CHECK(kind_of_input("empty") == InputKind::unknown);
    CHECK(kind_of_input("empty.glb") == InputKind::scene);
    CHECK(kind_of_input("absent.gltf") == InputKind::scene);
    CHECK(kind_of_input("absent.rct") == InputKind::trace);
    CHECK(kind_of_input(".") == InputKind::unknown);
}

TEST_CASE("the scene is an argument of every command that takes one, and --scene says the same") {
    for (const char* command : {"compare", "explain", "sweep"})
        for (const char* scene : {"courtyard", "--scene courtyard"}) {
            INFO(command << ' ' << scene);
            CHECK(refusal(words_of(std::string("raycache ") + command + " " + scene + " --gpu h100")).empty());
        }
    for (const char* command : {"render -o a.png", "capture -o a.rct", "quality"})
        for (const char* scene : {"courtyard", "--scene courtyard"})
            CHECK(refusal(words_of(std::string("raycache ") + command + " " + scene)).empty());
}

TEST_CASE("scenes and traces together are refused in one line") {
    const test::InFolder folder({"a.glb", "other"});
    for (const char* command : {"compare", "explain"}) {
        const std::string start = std::string("raycache ") + command + " --gpu h100 ";
        CHECK_THAT(refusal(words_of(start)), Contains("INPUTS") && Contains("--scene"));
        CHECK_THAT(refusal(words_of(start + "courtyard a.rct")), Contains("courtyard") && Contains("a.rct"));
        CHECK_THAT(refusal(words_of(start + "a.rct --scene a.glb")), Contains("a.glb") && Contains("--scene"));
        CHECK_THAT(refusal(words_of(start + "courtyard a.glb")), Contains("both scenes"));
        CHECK_THAT(refusal(words_of(start + "courtyard --scene courtyard")), Contains("both scenes"));
    }
    CHECK_THAT(refusal(words_of("raycache explain a.rct --gpu h100")), Contains("1 trace file; expected two"));
}

}  // namespace
}  // namespace raycache::tools
