#!/usr/bin/env bash
# install_test.sh BUILD_DIR: installs the build into a fresh folder, runs the program from there, and builds and runs a
# small project that finds it with find_package(ropsim).
set -euo pipefail

build=$(cd "${1:?usage: install_test.sh BUILD_DIR}" && pwd)
here=$(cd "$(dirname "$0")" && pwd)
compiler=$(sed -n 's/^CMAKE_CXX_COMPILER:[^=]*=//p' "$build/CMakeCache.txt")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "install_test: $*" >&2; exit 1; }

cmake --install "$build" --prefix "$work/prefix" >"$work/install.log" || { cat "$work/install.log"; fail "cmake --install"; }
for file in bin/ropsim lib/ropsim/ropsim_images.so lib/ropsim/ropsim_rays.so share/ropsim/models/gpus/neutral.toml \
    share/ropsim/models/programs/nearest_k.kb share/ropsim/models/programs/nearest_k.glsl \
    share/ropsim/reports/result.schema.json share/bash-completion/completions/ropsim include/ropsim/sim/channel.hpp; do
    [[ -e $work/prefix/$file ]] || fail "$file is not installed"
done

# Moved away from where it was installed, and out of reach of this source tree by its relative search path alone.
mv "$work/prefix" "$work/moved"
"$work/moved/bin/ropsim" --version || fail "the installed program does not start"
"$work/moved/bin/ropsim" trace validate "$work/moved/share/ropsim/traces/samples/glxgears.rtrace" || fail "the samples"

cmake -G Ninja -S "$here/consumer" -B "$work/consumer" -DCMAKE_CXX_COMPILER="$compiler" \
    -DCMAKE_PREFIX_PATH="$work/moved" >"$work/configure.log" || { cat "$work/configure.log"; fail "find_package(ropsim)"; }
cmake --build "$work/consumer" >"$work/build.log" || { cat "$work/build.log"; fail "the consumer does not build"; }
ROPSIM_DATA_DIR="$work/moved/share/ropsim" "$work/consumer/consumer" || fail "the consumer does not run"
