// Names of strategies: NAME[+ORDER][@MAP][/LAYOUT], taken apart, checked and put together.
#include "tracer/strategy_name.hpp"

#include <catch2/catch.hpp>

#include "traces/error.hpp"

namespace raycache::tracer {
namespace {

using Catch::Matchers::Contains;

TEST_CASE("A strategy's name is a decorrelation, an order, a thread map and a layout, and prints as it was typed") {
    const auto [text, name] = GENERATE(table<std::string, StrategyName>({
        {"owen", {"owen"}},
        {"micro-jitter+morton", {"micro-jitter", "morton"}},
        {"micro-jitter+wavefront", {"micro-jitter", "wavefront"}},
        {"owen@samples", {"owen", {}, "samples"}},
        {"owen+meister@tile", {"owen", "meister", "tile"}},
        {"", {""}},
        {"+@", {"", "", ""}},
        {"a@b+c", {"a", {}, "b+c"}},
        {"owen/cwbvh8", {"owen", {}, {}, "cwbvh8"}},
        {"owen+morton@tile/bvh2", {"owen", "morton", "tile", "bvh2"}},
        {"a/b@c", {"a", {}, {}, "b@c"}},
        {"micro-jitter:k=1", {"micro-jitter", {}, {}, {}, {"k=1"}}},
        {"micro-jitter:k=1:s=full+morton@rows/bvh4", {"micro-jitter", "morton", "rows", "bvh4", {"k=1", "s=full"}}},
        {"net-micro-jitter:share=camera+light0@rows", {"net-micro-jitter", {}, "rows", {}, {"share=camera+light0"}}},
        {"net-micro-jitter:share=camera+light0+morton",
         {"net-micro-jitter", "morton", {}, {}, {"share=camera+light0"}}},
        {"a::", {"a", {}, {}, {}, {"", ""}}},
    }));
    CHECK(parse_strategy_name(text) == name);
    CHECK(to_string(name) == text);
}

TEST_CASE("A part that a name may not have is a letter of its decorrelation") {
    CHECK(parse_strategy_name("owen+morton@tile", {false, false}) == StrategyName{"owen+morton@tile"});
    CHECK(parse_strategy_name("owen+morton@tile", {false, true}) == StrategyName{"owen+morton", {}, "tile"});
    CHECK(parse_strategy_name("owen+morton@tile", {true, false}) == StrategyName{"owen", "morton@tile"});
    CHECK(parse_strategy_name("owen/bvh4", {true, true, false}) == StrategyName{"owen/bvh4"});
    CHECK(parse_strategy_name("owen:k=1", {true, true, true, false}) == StrategyName{"owen:k=1"});
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
    for (const char* valid :
         {"owen", "owen+none", "owen+wavefront", "owen@classes", "owen+morton@samples", "owen@tile/cwbvh8"})
        CHECK(refusal(valid) == "");
    CHECK_THAT(refusal("oven+morton"), Contains("unknown strategy 'oven'") && Contains("did you mean 'owen'?"));
    CHECK_THAT(refusal("owen+mortn@tile"),
               Contains("strategy 'owen+mortn@tile': unknown ray order 'mortn'") && Contains("did you mean 'morton'?"));
    CHECK_THAT(refusal("owen@sample"), Contains("unknown thread map 'sample'") && Contains("did you mean 'samples'?"));
    CHECK_THAT(refusal("owen/cwbvh"), Contains("unknown layout 'cwbvh'") && Contains("did you mean 'cwbvh8'?"));
    CHECK_THAT(refusal("owen+"), Contains("unknown ray order ''"));
    CHECK_THAT(refusal("owen@"), Contains("unknown thread map ''"));
    CHECK_THAT(refusal(""), Contains("unknown strategy ''"));
    for (const char* valid : {"micro-jitter:k=1:s=full", "scrambling-distance:cycles-multiplier=0.5@rows"})
        CHECK(refusal(valid) == "");
    CHECK_THAT(refusal("micro-jitter:kk=1"), Contains("unknown parameter 'kk'") && Contains("mu, k, s"));
    CHECK_THAT(refusal("owen:k=1"), Contains("owen has no parameters, found 'k'"));
    CHECK_THAT(refusal("micro-jitter:k"), Contains("':k'; expected :PARAMETER=VALUE"));
    CHECK_THAT(refusal("micro-jitter:"), Contains("':'; expected :PARAMETER=VALUE"));
    CHECK_THAT(refusal("micro-jitter:k=-1"), Contains("K must be") && Contains("-1"));
    CHECK_THAT(refusal("micro-jitter:k=1:k=2"), Contains("k is given twice"));
    CHECK_THAT(refusal("scrambling-distance:mu=0.1+mortn"), Contains("0.1+mortn"));
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

TEST_CASE(
    "A trace's strategy is named after its decorrelation, of a wavefront its order, and a layout unless it is the "
    "default") {
    traces::Provenance p;
    p.decorrelation = "owen";
    p.layout = "bvh2";
    CHECK(to_string(strategy_name(p)) == "owen");
    p.execution = "wavefront";
    CHECK(to_string(strategy_name(p)) == "owen+wavefront");
    p.order = "morton";
    CHECK(to_string(strategy_name(p)) == "owen+morton");
    p.layout = "bvh2";
    CHECK(to_string(strategy_name(p)) == "owen+morton");
    p.layout = "cwbvh8";
    CHECK(to_string(strategy_name(p)) == "owen+morton/cwbvh8");
}

}  // namespace
}  // namespace raycache::tracer
