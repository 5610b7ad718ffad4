#!/usr/bin/env python3
"""Shows that each case of `ropsim stability` fails when its guard is broken.

    mutate.py [--work DIR] [--only IDS] [--report] [--no-build]

mutations.toml lists guards: an expression or statement `from` of a file, what it becomes (`to`), and the cases that
have to fail then. Where more than one guard stands before a case, `also` lists what is replaced with the first. This
script copies the tree, rewrites every `from` into a choice between both that an environment variable takes at run time,
builds ropsim once, and runs the named cases with each mutation active. With none active all cases must pass. A mutation
that crashes or hangs counts as caught. The tree itself has no trace of any of this.

--report   runs the whole catalogue with each mutation and prints what fails: for whoever adds a mutation
--only     mutations by id, separated by commas
"""
import argparse
import fnmatch
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tomllib
from concurrent.futures import ThreadPoolExecutor

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ["sim", "pipeline", "models", "traces", "reports", "cli", "cmake"]
SECONDS = 300  # of a run, after which a mutation counts as one that hangs

HEADER = """// Which of the mutations is active: ROPSIM_MUTANT of the environment.
#pragma once
#include <cstdlib>
inline int ropsim_active_mutant() {
    static const int number = [] {
        const char* text = std::getenv("ROPSIM_MUTANT");
        return text == nullptr ? 0 : std::atoi(text);
    }();
    return number;
}
constexpr bool ropsim_mutant(int number) {
    return !__builtin_is_constant_evaluated() && ropsim_active_mutant() == number;
}
"""


def load():
    with open(ROOT / "tests/stability/mutations.toml", "rb") as file:
        table = tomllib.load(file)
    for number, mutation in enumerate(table["mutation"], 1):
        mutation["number"] = number
    return table


def replacements(mutations):
    """Each `from` of each mutation, with the mutation's id and number."""
    return [dict(one, id=m["id"], number=m["number"]) for m in mutations for one in [m, *m.get("also", [])]]


def place_of(text, mutation):
    """Where `from` begins; it occurs once, or `occurrence` says which one is meant."""
    wanted = mutation.get("occurrence")
    places = []
    at = text.find(mutation["from"])
    while at >= 0:
        places.append(at)
        at = text.find(mutation["from"], at + 1)
    if not places or (wanted is None and len(places) != 1) or (wanted is not None and wanted > len(places)):
        sys.exit(f"{mutation['id']}: {mutation['file']} has {len(places)} of: {mutation['from']}")
    return places[(wanted or 1) - 1]


def is_statement(source):
    return source.rstrip().endswith((";", "}"))


def choice(original, group):
    if is_statement(original):
        text = "".join(f"if (ropsim_mutant({m['number']})) {{ {m['to']} }} else " for m in group)
        return f"{text}{{ {original} }}"
    text = "".join(f"ropsim_mutant({m['number']}) ? ({m['to']}) : " for m in group)
    return f"({text}({original}))"


def rewrite(tree, mutations):
    by_file = {}
    for mutation in replacements(mutations):
        by_file.setdefault(mutation["file"], []).append(mutation)
    for name, group in by_file.items():
        path = tree / name
        text = (ROOT / name).read_text()
        places = {}
        for mutation in group:
            places.setdefault((place_of(text, mutation), mutation["from"]), []).append(mutation)
        end = len(text) + 1
        for (begin, source), here in sorted(places.items(), reverse=True):
            if begin + len(source) > end:
                sys.exit(f"{here[0]['id']}: overlaps another mutation of {name}")
            end = begin
            text = text[:begin] + choice(source, here) + text[begin + len(source):]
        if not path.exists() or path.read_text() != text:
            path.write_text(text)


def copy_tree(tree):
    """Files that did not change keep their time, so that a second build is short."""
    tree.mkdir(parents=True, exist_ok=True)
    wanted = set()
    for folder in FOLDERS:
        for source in (ROOT / folder).rglob("*"):
            if source.is_file():
                wanted.add(source.relative_to(ROOT))
    wanted |= {pathlib.Path(n) for n in ("CMakeLists.txt", "CMakePresets.json", "LICENSE", "README.md", "packages.txt")}
    for old in [p for p in tree.rglob("*") if p.is_file() and "build" not in p.relative_to(tree).parts[:1]]:
        if old.relative_to(tree) not in wanted:
            old.unlink()
    return wanted


def prepare(tree, mutations):
    wanted = copy_tree(tree)
    mutated = {pathlib.Path(one["file"]) for one in replacements(mutations)}
    for name in sorted(wanted):
        target = tree / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if name in mutated:
            continue
        if not target.exists() or target.read_bytes() != (ROOT / name).read_bytes():
            shutil.copy(ROOT / name, target)
    rewrite(tree, mutations)
    header = tree / "ropsim_mutant.hpp"
    if not header.exists() or header.read_text() != HEADER:
        header.write_text(HEADER)


def build(tree):
    output = tree / "build"
    environment = dict(os.environ, CCACHE_BASEDIR=str(tree))
    subprocess.run(["cmake", "-S", str(tree), "-B", str(output), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                    "-DROPSIM_TESTS=OFF", "-DROPSIM_UNITY=ON", "-DROPSIM_WERROR=OFF", "-DROPSIM_RAYS=OFF",
                    f"-DCMAKE_CXX_FLAGS=-w -include {header_of(tree)}"], check=True, env=environment)
    subprocess.run(["cmake", "--build", str(output), "--target", "ropsim", "-j", str(os.cpu_count())], check=True,
                   env=environment)
    return output / "bin/ropsim"


def header_of(tree):
    return tree / "ropsim_mutant.hpp"


def run(program, number, patterns):
    """Ids of the cases that failed, and of those that ran; None for all of them when the program did not end well."""
    command = [str(program), "stability", "--json"] + (["--filter", ",".join(patterns)] if patterns else [])
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS,
                              env=dict(os.environ, ROPSIM_MUTANT=str(number)))
        cases = json.loads(done.stdout)["cases"]
    except (subprocess.TimeoutExpired, json.JSONDecodeError):
        return None, None
    return {c["id"] for c in cases if not c["ok"]}, {c["id"] for c in cases}


def caught(program, mutation, catalogue):
    """The named cases that did not fail. One crash hides its neighbours, so each then runs alone."""
    named = [c for pattern in mutation["cases"] for c in fnmatch.filter(catalogue, pattern)]
    failed, _ = run(program, mutation["number"], named)
    if failed is not None:
        return sorted(set(named) - failed)
    alone = [(case, run(program, mutation["number"], [case])[0]) for case in named]
    return [case for case, failing in alone if failing is not None and case not in failing]


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--work", default=str(ROOT / "build/mutants"))
    arguments.add_argument("--only", default="")
    arguments.add_argument("--report", action="store_true")
    arguments.add_argument("--no-build", action="store_true")
    arguments.add_argument("--program", help="of a build that was rewritten before")
    options = arguments.parse_args()
    mutations = load()["mutation"]
    tree = pathlib.Path(options.work).resolve()
    program = pathlib.Path(options.program) if options.program else tree / "build/bin/ropsim"
    if not options.no_build:
        prepare(tree, mutations)
        program = build(tree)
    failed, catalogue = run(program, 0, [])
    if failed is None or failed:
        sys.exit(f"cases fail without any mutation: {failed}")
    if options.only:
        mutations = [m for m in mutations if m["id"] in options.only.split(",")]
    survived = 0
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        if options.report:
            for mutation, outcome in zip(mutations, pool.map(lambda m: run(program, m["number"], [])[0], mutations)):
                print(f"{mutation['id']}: {'crashes' if outcome is None else ' '.join(sorted(outcome)) or 'NOTHING'}",
                      flush=True)
            return
        for mutation, missed in zip(mutations, pool.map(lambda m: caught(program, m, catalogue), mutations)):
            survived += len(missed)
            print(f"{mutation['id']}: {'caught' if not missed else 'FAILED: not noticed by ' + ' '.join(missed)}",
                  flush=True)
    print(f"{len(mutations)} mutations, {survived} cases that did not notice")
    sys.exit(1 if survived else 0)


if __name__ == "__main__":
    main()
