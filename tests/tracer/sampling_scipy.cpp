// Sobol and Halton against an independent implementation: SciPy, run when the test runs.
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <numeric>
#include <string>
#include <vector>

#include "tests/skip.hpp"
#include "tracer/sampling/sequence.hpp"

using namespace raycache::tracer;

namespace {

constexpr std::uint32_t points = 1024;
constexpr int no_scipy = 77;

/// Runs a Python program that writes doubles to stdout. Where Python or SciPy is missing the test is skipped, and the
/// result empty; a program that fails for another reason fails the test.
std::vector<double> run_python(const std::string& program) {
    const std::string command = "/usr/bin/python3 -c '" + program + "'";
    std::FILE* pipe = popen(command.c_str(), "r");
    REQUIRE(pipe != nullptr);
    std::vector<double> values;
    double buffer[4096];
    for (std::size_t n; (n = std::fread(buffer, sizeof(double), std::size(buffer), pipe)) > 0;) {
        values.insert(values.end(), buffer, buffer + n);
    }
    const int status = pclose(pipe);
    REQUIRE(WIFEXITED(status));
    if (WEXITSTATUS(status) == no_scipy || WEXITSTATUS(status) == 127) {
        raycache::test::skip("/usr/bin/python3 with SciPy is absent", "apt-get install python3-scipy");
        return {};
    }
    REQUIRE(WEXITSTATUS(status) == 0);
    return values;
}

/// The first 1024 points of a SciPy engine, then points 2^10, 2^11, … below 2^`last_bit`; [point * dimensions +
/// dimension].
std::vector<double> scipy_points(const std::string& engine, unsigned last_bit = 10) {
    return run_python(
        "import sys\n"
        "try:\n"
        "    from scipy.stats import qmc\n"
        "except ImportError:\n"
        "    sys.exit(" +
        std::to_string(no_scipy) +
        ")\n"
        "engine = qmc." +
        engine +
        "\n"
        "sys.stdout.buffer.write(engine.random(1024).tobytes())\n"
        "for bit in range(10, " +
        std::to_string(last_bit) +
        "):\n"
        "    engine.fast_forward((1 << bit) - engine.num_generated)\n"
        "    sys.stdout.buffer.write(engine.random(1).tobytes())\n");
}

}  // namespace

TEST_CASE("sampling: Sobol equals SciPy exactly on 1024 points in all 1024 dimensions, and on points 2^10 to 2^16") {
    // The later points reach the direction numbers that the first 1024 do not: the table has up to 13 of a dimension.
    constexpr std::uint32_t dimensions = 1024;
    constexpr unsigned last_bit = 17;
    const auto reference = scipy_points("Sobol(" + std::to_string(dimensions) + ", scramble=False, bits=32)", last_bit);
    if (reference.empty()) return;
    std::vector<std::uint32_t> order(points);
    std::iota(order.begin(), order.end(), 0U);
    for (unsigned bit = 10; bit < last_bit; ++bit) order.push_back(1U << bit);
    REQUIRE(reference.size() == order.size() * dimensions);
    const auto sobol = make_sequence("sobol");
    std::size_t different = 0;
    for (std::size_t row = 0; row < order.size(); ++row) {
        const std::uint32_t gray = order[row] ^ (order[row] >> 1);  // what SciPy calls point order[row]
        for (std::uint32_t d = 0; d < dimensions; ++d) {
            if (sobol->sample(gray, d) * 0x1p-32 != reference[row * dimensions + d]) ++different;
        }
    }
    CHECK(different == 0);
}

TEST_CASE("sampling: Halton equals SciPy rounded down to 32 bits on 1024 points in 256 dimensions") {
    constexpr std::uint32_t dimensions = 256;
    const auto reference = scipy_points("Halton(" + std::to_string(dimensions) + ", scramble=False)");
    if (reference.empty()) return;
    REQUIRE(reference.size() == std::size_t{points} * dimensions);
    const auto halton = make_sequence("halton");
    constexpr double float_error = 1e-14;  // SciPy adds up digits in double precision
    std::size_t different = 0;
    for (std::uint32_t i = 0; i < points; ++i) {
        for (std::uint32_t d = 0; d < dimensions; ++d) {
            const double lost = reference[std::size_t{i} * dimensions + d] - halton->sample(i, d) * 0x1p-32;
            if (lost < -float_error || lost >= 0x1p-32 + float_error) ++different;
        }
    }
    CHECK(different == 0);
}
