#!/usr/bin/env bash
# compilers_agree.sh BUILD_DIR BUILD_DIR: two builds of ropsim, by different compilers, must report the same results.
set -euo pipefail

[[ $# -eq 2 ]] || { echo "usage: compilers_agree.sh BUILD_DIR BUILD_DIR" >&2; exit 2; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# A result may differ in `host` (seconds) and in what it says about the build.
result() {
    for scene in gen:discs gen:grass?blades=200 gen:grid-soup?boxes=40; do result_of "$1" "$scene"; done
}
result_of() {
    local how=(compare "$2" --size 128x128)
    [[ ${3-} != replay ]] || how=(replay "$2")
    "$1/bin/ropsim" "${how[@]}" --json >"$work/raw.json" || { echo "$1/bin/ropsim failed" >&2; exit 1; }
    python3 -c 'import json, sys
document = json.load(sys.stdin)
document.pop("host")
document.pop("ropsim")
print(json.dumps(document, indent=1, sort_keys=True))' <"$work/raw.json"
}

result "$1" >"$work/first.json"
result "$2" >"$work/second.json"
diff -u "$work/first.json" "$work/second.json" | head -40
cmp -s "$work/first.json" "$work/second.json"

# A trace is the same file, and what one build captured the other replays to the same result.
"$1/bin/ropsim" capture gen:csg --size 64x64 -o "$work/first.rtrace" >/dev/null
"$2/bin/ropsim" capture gen:csg --size 64x64 -o "$work/second.rtrace" >/dev/null
cmp "$work/first.rtrace" "$work/second.rtrace"
result_of "$1" "$work/first.rtrace" replay >"$work/first.txt"
result_of "$2" "$work/first.rtrace" replay >"$work/second.txt"
cmp "$work/first.txt" "$work/second.txt"
echo "the results of $1 and $2 are equal ($(wc -l <"$work/first.json") lines)"
