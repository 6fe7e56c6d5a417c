#include "tests/skip.hpp"

#define CATCH_CONFIG_EXTERNAL_INTERFACES
#include <catch2/catch.hpp>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

namespace raycache::test {
namespace {

/// Of the running test case: what is missing, and the remedy. Catch2 runs a case once for each of its sections.
std::set<std::pair<std::string, std::string>>& left_out() {
    static std::set<std::pair<std::string, std::string>> all;
    return all;
}

std::string& tags_of_running_case() {
    static std::string tags;
    return tags;
}

class SkipListener : public Catch::TestEventListenerBase {
public:
    using TestEventListenerBase::TestEventListenerBase;

    void testCaseStarting(const Catch::TestCaseInfo& info) override {
        tags_of_running_case() = info.tagsAsString();
        left_out().clear();
    }

    void testCaseEnded(const Catch::TestCaseStats& stats) override {
        if (stats.totals.assertions.failed == 0)
            for (const auto& [missing, remedy] : left_out()) {
                const nlohmann::json line{{"test", stats.testInfo.name}, {"missing", missing}, {"remedy", remedy}};
                std::cout << "SKIPPED " << line.dump() << std::endl;
            }
        left_out().clear();
    }
};

CATCH_REGISTER_LISTENER(SkipListener)

}  // namespace

void skip(const std::string& missing, const std::string& remedy) { left_out().emplace(missing, remedy); }

void require_tag(const std::string& tag) {
    INFO("this test case needs the tag " << tag << "; it has " << tags_of_running_case());
    REQUIRE(tags_of_running_case().find(tag) != std::string::npos);
}

}  // namespace raycache::test
