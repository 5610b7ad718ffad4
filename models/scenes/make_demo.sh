#!/usr/bin/env bash
# make_demo.sh OUT.glb: the demo scene, from the models of Debian's glmark2-data (see README.md).
set -euo pipefail

out=${1:?usage: make_demo.sh OUT.glb}
here=$(cd "$(dirname "$0")" && pwd)
models=${GLMARK2_MODELS:-/usr/share/glmark2/models}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

for file in bunny.obj cat.3ds horse.3ds asteroid-high.3ds; do
    [[ -e $models/$file ]] || { echo "make_demo: $models/$file is missing (Debian package glmark2-data)" >&2; exit 1; }
    # Smooth normals; the triangles stay in the order of the file.
    assimp export "$models/$file" "$work/${file%.*}.glb" -fglb2 -tri -gsn >"$work/log" || { cat "$work/log" >&2; exit 1; }
done
mkdir -p "$(dirname "$out")"
python3 "$here/merge_models.py" "$work" "$out"
