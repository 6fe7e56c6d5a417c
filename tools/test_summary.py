#!/usr/bin/python3
"""Adds up the test cases of all test programs in ctest's JUnit file; fails if any failed or none ran.

Usage: tools/test_summary.py RESULTS.xml

Prints what was skipped and how to get what it needs, then the line 'N passed, N failed, N skipped' alone. Test programs
say what they skip in lines 'SKIPPED {"test": ..., "missing": ..., "remedy": ...}' (tests/skip.hpp, tests/cli/support.py);
a test case of which any part was skipped counts as skipped.
"""
import json
import re
import sys
import xml.etree.ElementTree as ElementTree


def number(pattern, text):
    found = re.findall(pattern, text)
    return int(found[-1]) if found else 0


def skips(output):
    """What one program said it skips: a list of (test, missing, remedy)."""
    found = []
    for line in dict.fromkeys(re.findall(r"^SKIPPED (\{.*\})$", output, re.MULTILINE)):
        try:
            entry = json.loads(line)
            found.append((str(entry["test"]), str(entry["missing"]), str(entry["remedy"])))
        except (ValueError, KeyError):
            pass  # a line that only looks like one: the program's own counts decide
    return found


def counts(output):
    """(passed, failed, skipped) of one program, from the last lines of Catch2 or unittest; None if they are absent."""
    skipped = len({test for test, _, _ in skips(output)})
    if re.search(r"All tests passed \(", output):
        return max(0, number(r"in (\d+) test cases?\)", output) - skipped), 0, skipped
    if re.search(r"test cases: +\d+ \|", output):
        line = re.findall(r"test cases: .*", output)[-1]
        passed = number(r"(\d+) passed", line) + number(r"(\d+) failed as expected", line)
        return max(0, passed - skipped), number(r"(\d+) failed(?! as)", line), skipped
    if re.search(r"No test(s ran| cases matched)", output):
        return 0, 0, 0
    if re.search(r"^Ran \d+ tests? in ", output, re.MULTILINE):
        failed = number(r"failures=(\d+)", output) + number(r"errors=(\d+)", output)
        skipped = skipped or number(r"skipped=(\d+)", output)
        return max(0, number(r"Ran (\d+) tests?", output) - failed - skipped), failed, skipped
    return None


def print_skips(skipped):
    """`skipped`: a list of (program, test, missing, remedy). One paragraph for each remedy."""
    remedies = {}
    for program, test, missing, remedy in skipped:
        remedies.setdefault(remedy, {}).setdefault((program, test), []).append(missing)
    for remedy, tests in remedies.items():
        print(f"skipped; to run them, {remedy}:")
        for (program, test), missing in tests.items():
            print(f"  {program}: {test}: {'; '.join(missing)}")


def main(path):
    passed = failed = skipped = 0
    reasons = []
    try:
        programs = list(ElementTree.parse(path).getroot().iter("testcase"))
    except (OSError, ElementTree.ParseError) as error:
        print(f"tools/test_summary.py: error: cannot read the results in {path}: {error}", file=sys.stderr)
        programs = []
    for program in programs:
        went_wrong = program.get("status") not in ("run", "disabled")
        output = program.findtext("system-out") or ""
        found = counts(output)
        p, f, s = found if found else (int(not went_wrong), 0, 0)
        if went_wrong and f == 0:  # a crash, a timeout, a program that was not built
            f = 1
            print(f"{program.get('name')}: did not end well: {program.get('status')}", file=sys.stderr)
        passed, failed, skipped = passed + p, failed + f, skipped + s
        named = [(program.get("name"), *entry) for entry in skips(output)]
        if s and not named:
            named = [(program.get("name"), f"{s} tests", "no reason given", "see the program's output")]
        reasons += named
    print_skips(reasons)
    sys.stdout.flush()
    print(f"{passed} passed, {failed} failed, {skipped} skipped")
    return 0 if failed == 0 and passed + skipped > 0 else 1


if __name__ == "__main__":
    if len(sys.argv) != 2:
        print("usage: tools/test_summary.py RESULTS.xml", file=sys.stderr)
        sys.exit(2)
    sys.exit(main(sys.argv[1]))
