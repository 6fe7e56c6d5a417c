// Groups of strategies.
#include "tracer/strategy_groups.hpp"

#include <catch2/catch.hpp>

#include "tracer/sampling/decorrelation.hpp"
#include "tracer/strategy_name.hpp"

namespace raycache::tracer {
namespace {

TEST_CASE("every member of a group is a strategy, and no group is called as one") {
    for (const StrategyGroup& group : strategy_groups()) {
        CHECK(group.members.size() > 1);
        for (const std::string& member : group.members) {
            CHECK_NOTHROW(check_strategy_name(parse_strategy_name(member)));
            CHECK(to_string(parse_strategy_name(member)) == member);
        }
        for (const DecorrelationEntry& entry : decorrelations()) CHECK(entry.name != group.name);
    }
}

TEST_CASE("a group in a list stands for its members, each once, and its first is the baseline if there is no other") {
    const std::vector<std::string> cycles = find_strategy_group("cycles")->members;
    std::vector<std::string> expected = cycles;
    expected.insert(expected.begin(), "coherent");
    CHECK(expand_groups({"coherent", "cycles", cycles.back()}) == expected);
    CHECK(expand_groups({"owen"}) == std::vector<std::string>{"owen"});
    CHECK(baseline_of_groups({"coherent", "cycles"}) == cycles.front());
    CHECK(baseline_of_groups({"cranley-patterson", "cycles"}) == std::nullopt);
    CHECK(baseline_of_groups({"coherent"}) == std::nullopt);
    CHECK(find_strategy_group("owen") == nullptr);
}

TEST_CASE("a misspelt group is named, and a misspelt strategy is left to what knows strategies") {
    CHECK_THROWS_WITH(expand_groups({"cycle"}), Catch::Contains("did you mean 'cycles'?"));
    CHECK_THROWS_WITH(expand_groups({"coherent", "Cylces@rows"}), Catch::Contains("did you mean 'cycles'?"));
    CHECK_THROWS_WITH(expand_groups({"cycles:k=1"}), Catch::Contains("expected 'cycles' alone"));
    CHECK_THROWS_WITH(expand_groups({"cycles@rows"}), Catch::Contains("expected 'cycles' alone"));
    CHECK(expand_groups({"oven", "xyz"}) == std::vector<std::string>{"oven", "xyz"});
}

}  // namespace
}  // namespace raycache::tracer
