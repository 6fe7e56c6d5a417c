// What is misspelt is answered with what was meant, before anything is said to be missing.
#include <catch2/catch.hpp>

#include "cachesim/gpus/gpu.hpp"
#include "cachesim/gpus/gpu_name.hpp"
#include "tests/tools/command_line.hpp"
#include "traces/did_you_mean.hpp"

namespace raycache {
namespace {

using Catch::Contains;
using test::refusal;
using test::words_of;

void check_meant(const std::string& line, const std::string& meant) {
    INFO(line);
    CHECK_THAT(refusal(words_of(line)), Contains("did you mean '" + meant + "'?") && !Contains("missing"));
}

/// The word with two neighbouring letters swapped.
std::string swapped(std::string word) {
    const std::size_t at = word.size() / 2;
    std::swap(word[at], word[at - 1]);
    if (word[at] == word[at - 1]) word.erase(at, 1);
    return word;
}

TEST_CASE("the edit distance counts letters that are inserted, removed, replaced or swapped") {
    CHECK(edit_distance("", "abc") == 3);
    CHECK(edit_distance("replay", "replay") == 0);
    CHECK(edit_distance("reply", "replay") == 1);
    CHECK(edit_distance("relpay", "replay") == 1);
    CHECK(edit_distance("RTX_3070", "rtx-3070") == 0);
    CHECK(edit_distance("kitten", "sitting") == 3);
}

TEST_CASE("nothing is meant by a word that is like no name") {
    CHECK(closest_name("zzzzzz", {"sobol", "halton"}).empty());
    CHECK(closest_name("", {"sobol"}).empty());
    CHECK(closest_name(std::string(100000, 'a'), {std::string(100000, 'a')}).empty());
    CHECK(did_you_mean("sobel", {"halton", "sobol"}) == "; did you mean 'sobol'?");
    CHECK(closest_name("cranley", {"coherent", "cranley-patterson"}) == "cranley-patterson");
}

TEST_CASE("a misspelt command is answered with the command that was meant") {
    const tools::Program program;
    for (const auto& command : program.commands())
        if (!command->is_hidden()) check_meant("raycache " + swapped(command->name()) + " --gpu h100", command->name());
    CHECK_THAT(refusal({"frobnicate"}), Contains("unknown command 'frobnicate'") && Contains("replay"));
    CHECK_THAT(refusal({}), Contains("no command"));
}

TEST_CASE("a misspelt option of every command is answered with the option that was meant") {
    const tools::Program program;
    for (const auto& command : program.commands())
        for (const auto& option : command->options()) {
            if (option->is_positional() || option->name().size() < 6) continue;
            const std::string wrong = swapped(option->name());
            if (command->find_option(wrong)) continue;
            INFO(command->name() << ' ' << wrong);
            for (const std::string& line : {command->name() + ' ' + wrong + " 1", command->name() + ' ' + wrong + "=1"})
                CHECK_THAT(refusal(words_of("raycache " + line)), Contains("unknown option '" + wrong + "'") &&
                                                                      Contains("did you mean '") &&
                                                                      !Contains("missing"));
        }
    check_meant("raycache compare --stratgy coherent", "--strategy");
    check_meant("raycache replay -json", "--json");
    CHECK_THAT(refusal(words_of("raycache info a.rct b.rct")), Contains("unexpected argument 'b.rct'"));
}

TEST_CASE("a misspelt name is answered with the name that was meant, before anything is missing") {
    check_meant("raycache capture courtyrd", "courtyard");
    check_meant("raycache compare courtyrd", "courtyard");
    check_meant("raycache compare --strategy micro-jiter", "micro-jitter");
    check_meant("raycache compare --strategy coherent,microjitter", "micro-jitter");
    check_meant("raycache compare --strategy micro-jitter+meistr", "meister");
    check_meant("raycache compare --strategy micro-jitter+wavefrnt", "wavefront");
    check_meant("raycache compare --baseline cranley", "cranley-patterson");
    check_meant("raycache sweep --swept micro_jiter", "micro-jitter");
    check_meant("raycache quality --reference-strategy randm", "random");
    check_meant("raycache render --sequence soble", "sobol");
    check_meant("raycache capture --order miester", "meister");
    check_meant("raycache capture --execution wave-front", "wavefront");
    check_meant("raycache capture --thread-map tiles", "tile");
    check_meant("raycache capture --lights nees", "nee");
    check_meant("raycache capture --sky atuo", "auto");
    check_meant("raycache replay --by bounces", "bounce");
    check_meant("raycache explain --by rays", "ray");
    check_meant("raycache replay --counters nuc", "ncu");
    check_meant("raycache export --format dinaro", "dinero");
    check_meant("raycache export --level L2x", "l2");
    check_meant("raycache list stratgies", "strategies");
    check_meant("raycache list layout", "layouts");
    check_meant("raycache samples --table bais", "bias");
}

TEST_CASE("a GPU is found whatever the letters, and a part of its name is answered with the whole") {
    for (const auto& preset : cachesim::gpu_presets()) {
        std::string shouted, underlined, plain;
        for (const char c : preset.name) {
            shouted += static_cast<char>(std::toupper(c));
            underlined += c == '-' ? '_' : c;
            if (c != '-') plain += c;
        }
        for (const std::string& name : {preset.name, shouted, underlined, plain}) {
            CHECK(cachesim::find_gpu_name(name) == preset.name);
            CHECK(cachesim::load_gpu(name).name == preset.name);
        }
    }
    CHECK(refusal(words_of("raycache replay x.rct --gpu RTX_3070,Gtx980Ti")).empty());
    check_meant("raycache replay --gpu 3070", "rtx-3070");
    check_meant("raycache replay --gpu rtx-3071", "rtx-3070");
    check_meant("raycache replay --gpu GeForce_RTX_3070", "rtx-3070");
}

TEST_CASE("an option without a value does not take the next option for one") {
    CHECK_THAT(refusal(words_of("raycache replay x.rct --gpu --json")), Contains("--gpu") && Contains("--json"));
    CHECK_FALSE(refusal(words_of("raycache replay x.rct --gpu")).empty());
}

}  // namespace
}  // namespace raycache
