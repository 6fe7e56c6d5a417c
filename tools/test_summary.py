#!/usr/bin/python3
"""Adds up the test cases of all test programs in ctest's JUnit file; fails if any failed or none ran.

Usage: tools/test_summary.py RESULTS.xml
"""
import re
import sys
import xml.etree.ElementTree as ElementTree


def number(pattern, text):
    found = re.findall(pattern, text)
    return int(found[-1]) if found else 0


def counts(output):
    """(passed, failed, skipped) of one program, from the last lines of Catch2 or unittest; None if they are absent."""
    if re.search(r"All tests passed \(", output):
        return number(r"in (\d+) test cases?\)", output), 0, 0
    if re.search(r"test cases: +\d+ \|", output):
        line = re.findall(r"test cases: .*", output)[-1]
        return number(r"(\d+) passed", line), number(r"(\d+) failed", line), 0
    if re.search(r"No test(s ran| cases matched)", output):
        return 0, 0, 0
    if re.search(r"^Ran \d+ tests? in ", output, re.MULTILINE):
        failed = number(r"failures=(\d+)", output) + number(r"errors=(\d+)", output)
        skipped = number(r"skipped=(\d+)", output)
        return max(0, number(r"Ran (\d+) tests?", output) - failed - skipped), failed, skipped
    return None


def main(path):
    passed = failed = skipped = 0
    try:
        programs = list(ElementTree.parse(path).getroot().iter("testcase"))
    except (OSError, ElementTree.ParseError) as error:
        print(f"tools/test_summary.py: error: cannot read the results in {path}: {error}", file=sys.stderr)
        programs = []
    for program in programs:
        went_wrong = program.get("status") not in ("run", "disabled")
        found = counts(program.findtext("system-out") or "")
        p, f, s = found if found else (int(not went_wrong), 0, 0)
        if went_wrong and f == 0:  # a crash, a timeout, a program that was not built
            f = 1
            print(f"{program.get('name')}: did not end well: {program.get('status')}", file=sys.stderr)
        passed, failed, skipped = passed + p, failed + f, skipped + s
    if skipped:
        print(f"{skipped} skipped: something they need is not on this machine")
    print(f"{passed} passed, {failed} failed")
    return 0 if failed == 0 and passed > 0 else 1


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: tools/test_summary.py RESULTS.xml")
    sys.exit(main(sys.argv[1]))
