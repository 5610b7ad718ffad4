#!/usr/bin/env bash
# record.sh [OPTION ...] [NAME ...]: frames of Debian's OpenGL programs as draw traces, each of them checked, and a table.
#   NAME           of the programs that --list shows (default: all)
#   --out DIR      where they go (default build/samples): DIR/NAME.rtrace, one frame; DIR/whole/NAME.rtrace, as recorded
#   --ropsim FILE  the program to record with (default build/release/bin/ropsim)
#   --list         name, package, frames and command of each program
#   --no-packages  do not look for Debian packages
set -euo pipefail

root=$(cd "$(dirname "$(readlink -f "$0")")/../.." && pwd)
source "$root/cmake/packages.sh"

out=$root/build/samples
ropsim=$root/build/release/bin/ropsim
packages=yes
list=no
names=()
while [[ $# -gt 0 ]]; do
    case $1 in
        --out) out=${2:?--out: expected a folder} && shift ;;
        --ropsim) ropsim=${2:?--ropsim: expected a program} && shift ;;
        --list) list=yes ;;
        --no-packages) packages=no ;;
        -h | --help) sed -n '2,7s/^# *//p' "$0" && exit 0 ;;
        -*) stop "unknown option $1 (there are --out, --ropsim, --list and --no-packages)" ;;
        *) names+=("$1") ;;
    esac
    shift
done

# ETR is in its menus until keys are pressed; it has them where the pointer is. It fills the screen.
through_menus='etr & while kill -0 $! 2>/dev/null; do sleep 0.4; xdotool mousemove 2 2 key Return || true; done; wait'
small_screen=(xvfb-run -a -s '-screen 0 320x240x24')

# Calls $1 with each: NAME PACKAGE FRAMES LICENCE COMMAND... The windows are small, as a replay takes time for each pixel.
each_program() {
    local scene
    "$1" glxgears mesa-utils-bin 10:12 'MIT (Mesa demos), Brian Paul' glxgears -geometry 160x120
    for scene in buffer:interleave=true build:model=horse bump:bump-render=high-poly desktop:effect=shadow:windows=4 \
        effect2d function ideas jellyfish pulsar:quads=5:texture=true:light=true refract shading:shading=phong:model=cat \
        shadow terrain texture; do
        "$1" "glmark2-${scene%%:*}" glmark2-x11 10:12 'GPL-3+, glmark2 developers' \
            glmark2 --size 160x120 -b "$scene:duration=60"
    done
    "$1" neverball neverball 60:62 'GPL-2+, Robert Kooima and others' neverball --level map-easy/coins.sol
    "$1" etr extremetuxracer 600:602 'GPL-2+, Extreme Tux Racer team' bash -c "$through_menus"
    "$1" gtk4-gears gtk-4-examples 2:4 'LGPL-2.1+, GTK developers' gtk4-demo --run=gears # OpenGL 3.2, core profile
}

show() {
    printf '%-18s %-16s %-8s' "$1" "$2" "$3"
    printf ' %q' "${@:5}"
    echo
}
known=" $(each_program echo | cut -d' ' -f1 | paste -sd' ') "
for name in "${names[@]}"; do
    [[ $known == *" $name "* ]] || stop "unknown program $name (there are:${known% })"
done
if [[ $list == yes ]]; then
    each_program show
    exit 0
fi
[[ $packages == no ]] || install_packages samples
[[ -x $ropsim ]] || stop "$ropsim is missing: ./demo builds it, or --ropsim names another one"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$out/whole"
failed=()

# What the programs read: small windows, no sound. ETR looks into the account's own home directory, whatever HOME says.
export PATH=$PATH:/usr/games HOME=$work/home XDG_CONFIG_HOME=$work/home/.config XDG_CACHE_HOME=$work/home/.cache
export SDL_AUDIODRIVER=dummy ALSOFT_DRIVERS=null GDK_BACKEND=x11 GSK_RENDERER=gl
unset DISPLAY WAYLAND_DISPLAY # ropsim record starts an X server, where no window manager changes sizes
mkdir -p "$HOME/.neverball"
printf '%s\n' 'fullscreen 0' 'width 320' 'height 240' 'multisample 0' 'reflection 1' 'vsync 0' >"$HOME/.neverball/neverballrc"

# Records two frames, and keeps the second one: what it reads of the first stays in front of it.
record() {
    local name=$1 frames=$3 licence=$4 log=$work/$1.log whole=$out/whole/$1.rtrace file=$out/$1.rtrace
    local last=$((${frames#*:} - 1)) display=()
    [[ $name != etr ]] || display=("${small_screen[@]}")
    [[ ${#names[@]} -eq 0 || " ${names[*]} " == *" $name "* ]] || return 0
    if ! {
        timeout --foreground 600 "${display[@]}" "$ropsim" record --frames "$frames" --name "$name" --licence "$licence" -o "$whole" -- "${@:5}" &&
            "$ropsim" trace validate "$whole" &&
            "$ropsim" trace cut "$whole" --frames "$last:$((last + 1))" -o "$file" &&
            "$ropsim" trace validate "$file"
    } </dev/null >"$log" 2>&1; then
        echo "$name: $(grep '^ropsim:' "$log" | tail -n1 || tail -n1 "$log")" >&2
        failed+=("$name")
        return 0
    fi
    "$ropsim" trace info --json "$file" >"$work/$name.json"
    printf '%s\t%s\t%s\t%s\n' "$name" "$(dpkg-query -W -f='${Version}' "$2" 2>/dev/null)" "$(stat -c %s "$whole")" \
        "$work/$name.json" >>"$work/rows"
}
each_program record

[[ ! -e $work/rows ]] || python3 - "$work/rows" <<'PYTHON'
import json, sys
row = "{:18} {:20} {:>6} {:>9} {:>6} {:>9} {:>10} {:>10} {:>10}  {}".format
print(row("program", "version", "frame", "size", "draws", "vertices", "primitives", "2 frames", "bytes", "not recorded"))
for line in open(sys.argv[1]):
    name, version, whole, file = line.rstrip("\n").split("\t")
    facts = json.load(open(file))
    frame = facts["frames"][-1]
    missing = ", ".join(f"{one['call']} ({one['times']})" for one in facts["not_recorded"]) or "nothing"
    print(row(name, version, frame["number"], f"{frame['width']}x{frame['height']}", frame["draws"], frame["vertices"],
              frame["primitives"], whole, facts["bytes"], missing))
PYTHON
[[ ${#failed[@]} -eq 0 ]] || stop "not recorded: ${failed[*]}"
