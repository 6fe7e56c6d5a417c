// What `ncu --csv` prints, in both forms, and what is no such table.
#include "cachesim/report/nsight_csv.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::cachesim;

namespace {

const std::string wide =
    "Scene loaded, \"IDs\" and all\n==PROF== Connected to process 7\n"
    "\"ID\",\"Process ID\",\"Kernel Name\",\"dram__bytes_read.sum\",\"launch__grid_size\"\n"
    "\"\",\"\",\"\",\"Mbyte\",\"\"\n\"0\",\"7\",\"trace<float, \"\"4\"\">\",\"1,234.5\",\"64\"\n"
    "==PROF== Disconnected\n\"1\",\"7\",\"shade\",\"n/a\",\"64\"\n";
const std::string narrow =
    "\"ID\",\"Process ID\",\"Kernel Name\",\"Section Name\",\"Metric Name\",\"Metric Unit\",\"Metric Value\"\r\n"
    "\"0\",\"7\",\"trace\",\"Command line profiler metrics\",\"dram__bytes_read.sum\",\"byte\",\"64\"\r\n"
    "\"0\",\"7\",\"trace\",\"\",\"\",\"\",\"\"\r\n"
    "\"0\",\"7\",\"trace\",\"Memory\",\"L2 Hit Rate\",\"%\",\"12.5\"\r\n"
    "\"0\",\"8\",\"trace\",\"\",\"gpu__time_duration.sum\",\"us\",\"2\"";

std::string refusal(const std::string& text) {
    try {
        read_nsight_csv(text, "p.csv");
    } catch (const Error& error) {
        const std::string line = error.what();
        CHECK(line.find('\n') == std::string::npos);
        CHECK(line.starts_with("p.csv: "));
        return line;
    }
    return "taken";
}

double value(const std::string& text, const std::string& unit, const char* wanted) {
    return measured_value({"m", unit, text, 3}, wanted, "p.csv");
}

}  // namespace

TEST_CASE("a profile with a launch a line has its units below the titles") {
    const NsightProfile profile = read_nsight_csv(wide, "p.csv");
    REQUIRE(profile.launches.size() == 2);
    CHECK(profile.launches[0].kernel == "trace<float, \"4\">");
    REQUIRE(profile.launches[0].metrics.size() == 2);
    CHECK(profile.launches[0].metrics[0].name == "dram__bytes_read.sum");
    CHECK(profile.launches[0].metrics[0].line == 5);
    CHECK(measured_value(profile.launches[0].metrics[0], "byte", "p.csv") == 1234500000);
    CHECK(std::isnan(measured_value(profile.launches[1].metrics[0], "byte", "p.csv")));
}

TEST_CASE("a profile with a metric a line has launches by process and number") {
    const NsightProfile profile = read_nsight_csv(narrow, "p.csv");
    REQUIRE(profile.launches.size() == 2);
    REQUIRE(profile.launches[0].metrics.size() == 2);
    CHECK(profile.launches[0].metrics[1].name == "L2 Hit Rate");
    CHECK(profile.launches[1].process == "8");
    CHECK(measured_value(profile.launches[1].metrics[0], "nsecond", "p.csv") == Approx(2000));
}

TEST_CASE("what is no profile is refused in one line that says what to do") {
    CHECK_THAT(refusal(""), Catch::Contains("empty") && Catch::Contains("ncu --csv"));
    CHECK_THAT(refusal(std::string("NVR\0\1", 5)), Catch::Contains("binary") && Catch::Contains("--import"));
    CHECK_THAT(refusal("Time (%),Total Time (ns),Name\n1,2,k\n"), Catch::Contains("titles"));
    CHECK_THAT(refusal(wide.substr(0, wide.find("\"64\"") + 2)), Catch::Contains("line 5") && Catch::Contains("quote"));
    CHECK_THAT(refusal(wide + "\"2\",\"7\"\n"),
               Catch::Contains("line 8: expected 5 fields") && Catch::Contains("found 2"));
    CHECK_THAT(refusal("\"ID\",\"Kernel Name\",\"Metric Name\",\"Minimum\"\n\"0\",\"k\",\"m\",\"1\"\n"),
               Catch::Contains("Metric Value") && Catch::Contains("--print-summary"));
    CHECK_THAT(refusal(wide.substr(0, wide.find("\"0\",")) + "==ERROR== ERR_NVGPUCTRPERM\n"),
               Catch::Contains("no launch"));
    CHECK(refusal(wide) == "taken");
}

TEST_CASE("values and units of a profile become plain numbers, or are refused") {
    CHECK(value("1,234,567", "sector", "sector") == 1234567);
    CHECK(value("12", "Ksector", "sector") == 12000);
    CHECK(value("2.5", "Gbyte/second", "byte/second") == Approx(2.5e9));
    CHECK(value("2.5", "Gbyte/s", "byte/second") == Approx(2.5e9));
    CHECK(value("3", "byte/nsecond", "byte/second") == Approx(3e9));
    CHECK(value("7", "msecond", "nsecond") == Approx(7e6));
    CHECK(value("7", "s", "nsecond") == Approx(7e9));
    CHECK(value("81.5", "%", "%") == 81.5);
    CHECK(std::isnan(value("(!) n/a", "", "byte")));
    for (const auto& [text, unit] : {std::pair{"1,23", "byte"},
                                     {"1.234,5", "byte"},
                                     {"12x", "byte"},
                                     {"-1", "byte"},
                                     {"1", "sector"},
                                     {"1", "Kfurlong"},
                                     {"inf", "byte"},
                                     {",123", "byte"}})
        CHECK_THROWS_WITH(value(text, unit, "byte"), Catch::Contains("p.csv: line 3: m: expected"));
}
