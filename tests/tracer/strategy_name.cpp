// Names of strategies: NAME[+ORDER][@MAP], taken apart, checked and put together.
#include "tracer/strategy_name.hpp"

#include <catch2/catch.hpp>

#include "traces/error.hpp"

namespace raycache::tracer {
namespace {

using Catch::Matchers::Contains;

TEST_CASE("A strategy's name is a decorrelation, an order and a thread map, and prints as it was typed") {
    const auto [text, name] = GENERATE(table<std::string, StrategyName>({
        {"owen", {"owen"}},
        {"micro-jitter+morton", {"micro-jitter", "morton"}},
        {"micro-jitter+wavefront", {"micro-jitter", "wavefront"}},
        {"owen@samples", {"owen", {}, "samples"}},
        {"owen+meister@tile", {"owen", "meister", "tile"}},
        {"", {""}},
        {"+@", {"", "", ""}},
        {"a@b+c", {"a", {}, "b+c"}},
    }));
    CHECK(parse_strategy_name(text) == name);
    CHECK(to_string(name) == text);
}

TEST_CASE("A part that a name may not have is a letter of its decorrelation") {
    CHECK(parse_strategy_name("owen+morton@tile", {false, false}) == StrategyName{"owen+morton@tile"});
    CHECK(parse_strategy_name("owen+morton@tile", {false, true}) == StrategyName{"owen+morton", {}, "tile"});
    CHECK(parse_strategy_name("owen+morton@tile", {true, false}) == StrategyName{"owen", "morton@tile"});
}

TEST_CASE("A part of a name that no registry has is refused with the closest one") {
    const auto refusal = [](const std::string& text) {
        try {
            check_strategy_name(parse_strategy_name(text));
            return std::string();
        } catch (const UsageError& e) {
            return std::string(e.what());
        }
    };
    for (const char* valid : {"owen", "owen+none", "owen+wavefront", "owen@classes", "owen+morton@samples"})
        CHECK(refusal(valid) == "");
    CHECK_THAT(refusal("oven+morton"), Contains("unknown strategy 'oven'") && Contains("did you mean 'owen'?"));
    CHECK_THAT(refusal("owen+mortn@tile"),
               Contains("strategy 'owen+mortn@tile': unknown ray order 'mortn'") && Contains("did you mean 'morton'?"));
    CHECK_THAT(refusal("owen@sample"), Contains("unknown thread map 'sample'") && Contains("did you mean 'samples'?"));
    CHECK_THAT(refusal("owen+"), Contains("unknown ray order ''"));
    CHECK_THAT(refusal("owen@"), Contains("unknown thread map ''"));
    CHECK_THAT(refusal(""), Contains("unknown strategy ''"));
}

TEST_CASE("What a name does not say, the other settings say") {
    const ExecutionSettings sorted{Execution::wavefront, "moon"};
    CHECK(execution_of({"owen"}, {}).execution == Execution::megakernel);
    CHECK(execution_of({"owen"}, sorted).order == "moon");
    CHECK(execution_of({"owen", "wavefront"}, sorted).order == "none");
    CHECK(execution_of({"owen", "morton"}, {}).execution == Execution::wavefront);
    CHECK(execution_of({"owen", "morton"}, {}).order == "morton");
    CHECK(thread_map_of({"owen"}, "") == ThreadMap::tile);
    CHECK(thread_map_of({"interleaved"}, "") == ThreadMap::classes);
    CHECK(thread_map_of({"interleaved"}, "samples") == ThreadMap::samples);
    CHECK(thread_map_of({"interleaved", {}, "tile"}, "samples") == ThreadMap::tile);
    CHECK_THROWS_AS(thread_map_of({"owen", {}, "tiles"}, ""), UsageError);
}

TEST_CASE("A trace's strategy is named after its decorrelation and, of a wavefront, its order") {
    traces::Provenance p;
    p.decorrelation = "owen";
    CHECK(to_string(strategy_name(p)) == "owen");
    p.execution = "wavefront";
    CHECK(to_string(strategy_name(p)) == "owen+wavefront");
    p.order = "morton";
    CHECK(to_string(strategy_name(p)) == "owen+morton");
}

}  // namespace
}  // namespace raycache::tracer
