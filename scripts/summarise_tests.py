#!/usr/bin/env python3
"""What a run of CTest tried, case by case: summarise_tests.py BUILD_FOLDER

CTest counts programs and calls one that skipped everything "passed". This reads the results that each program
wrote to BUILD_FOLDER/test_results, and CTest's own for programs that write none; prints what was skipped and why,
and a line of totals. Exits 1 if a case failed, or if an entry ran no case at all.
"""
import collections
import pathlib
import sys
import xml.etree.ElementTree


def cases_of(path):
    """(suite.case, "passed" | "failed" | "skipped", reason) for each case that ran."""
    for case in xml.etree.ElementTree.parse(path).getroot().iter("testcase"):
        if case.get("status") != "run":
            continue
        name = f"{case.get('classname')}.{case.get('name')}"
        skipped = case.find("skipped")
        if case.find("failure") is not None:
            yield name, "failed", ""
        elif skipped is not None:  # its first line is the place in the source
            yield name, "skipped", skipped.get("message", "").partition("\n")[2].strip()
        else:
            yield name, "passed", ""


def other_entries(folder):
    """(entry, "passed" | "failed" | "skipped", reason) for what CTest ran that wrote no results of its own."""
    path = folder / "ctest.junit"
    if not path.exists():
        return
    for case in xml.etree.ElementTree.parse(path).getroot().iter("testcase"):
        name = case.get("name")
        if (folder / f"{name}.xml").exists():
            continue
        result = {"run": "passed", "fail": "failed"}.get(case.get("status"), "skipped")
        said = (case.findtext("system-out") or "").strip().splitlines()
        yield name, result, said[-1] if said else "no reason given"


def main():
    folder = pathlib.Path(sys.argv[1]) / "test_results"
    counts = collections.Counter()
    skipped = collections.defaultdict(list)
    bad = []
    for path in sorted(folder.glob("*.xml")):
        cases = list(cases_of(path))
        if not cases:
            bad.append(f"{path.stem}: ran no case")
        for name, result, reason in cases:
            counts[result] += 1
            if result == "skipped":
                skipped[reason].append(f"{path.stem.split('.')[0]}.{name}")
            elif result == "failed":
                bad.append(f"{path.stem.split('.')[0]}.{name}: failed")
    for name, result, reason in other_entries(folder):
        counts[result] += 1
        if result == "skipped":
            skipped[reason].append(name)
        elif result == "failed":
            bad.append(f"{name}: failed")
    if not counts:
        bad.append(f"{folder}: found no results")
    for reason, names in sorted(skipped.items(), key=lambda item: -len(item[1])):
        shown = ", ".join(names[:4]) + (f" and {len(names) - 4} more" if len(names) > 4 else "")
        print(f"skipped, {len(names)}: {reason}\n    {shown}")
    for line in bad:
        print(line)
    print(f"{counts['passed']} passed, {counts['failed']} failed, {counts['skipped']} skipped")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
