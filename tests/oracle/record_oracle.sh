#!/usr/bin/env bash
# What Mesa's llvmpipe says of an apitrace file, to compare a recording of it with: a picture of each frame, samples passed
# by draw, and the counters of each frame (HUD: where it gives a line). Needs apitrace and xvfb.
#   tests/oracle/record_oracle.sh app.trace FOLDER [--isotropic LIBRARY]
# With --isotropic, LIBRARY is ropsim_record.so, which makes samplers take one probe a texel.
set -euo pipefail

stop() {
    echo "record_oracle.sh: $*" >&2
    exit 1
}

[[ $# -eq 2 || ($# -eq 4 && $3 == --isotropic) ]] || stop "expected app.trace FOLDER [--isotropic LIBRARY]"
trace=$(realpath "$1")
[[ -r $trace ]] || stop "$1: expected a file that can be read"
command -v glretrace >/dev/null || stop "glretrace was not found: Debian package apitrace"
mkdir -p "$2"
folder=$(realpath "$2")

if [[ -z ${DISPLAY:-} ]]; then
    command -v Xvfb >/dev/null || stop "Xvfb was not found: Debian package xvfb"
    coproc display { exec Xvfb -displayfd 1 -screen 0 2560x1600x24 -nolisten tcp -noreset 2>/dev/null; }
    server=$display_PID
    trap 'kill "$server" 2>/dev/null || true' EXIT
    read -r -t 20 -u "${display[0]}" number || stop "Xvfb does not start"
    export DISPLAY=:$number
fi
export LIBGL_ALWAYS_SOFTWARE=1
isotropic=()
if [[ $# -eq 4 ]]; then
    # Frames that are never reached: samplers are changed, nothing is recorded.
    isotropic=(env "LD_PRELOAD=$(realpath "$4")" ROPSIM_RECORD=/dev/null ROPSIM_RECORD_FRAMES=4294967294:4294967294
        ROPSIM_RECORD_ISOTROPIC=1)
fi

"${isotropic[@]}" glretrace -b -s "$folder/frame." -S frame "$trace" >"$folder/pictures.log" 2>&1
# Column 11 of a draw's line is the number of samples that passed.
"${isotropic[@]}" glretrace -b --ppd "$trace" 2>/dev/null |
    awk '$1 == "call" && $NF ~ /^glDraw/ && $NF != "glDrawBuffers" { print $2, $NF, $11 }' >"$folder/samples_passed.txt"
GALLIUM_HUD=ia-vertices,ia-primitives,vs-invocations,clipper-invocations,clipper-primitives-generated,ps-invocations,samples-passed \
    GALLIUM_HUD_VISIBLE=false GALLIUM_HUD_PERIOD=0 GALLIUM_HUD_DUMP_DIR=$folder \
    "${isotropic[@]}" glretrace -b --loop=3 "$trace" >"$folder/counters.log" 2>&1 || true
awk '{ draws++; samples += $3 } END { printf "%d draws, %d samples passed\n", draws, samples }' "$folder/samples_passed.txt"
