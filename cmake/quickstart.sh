#!/usr/bin/env bash
# From a fresh Debian 12 to a picture: installs, builds, renders a scene to EXR and PNG.
# Usage: cmake/quickstart.sh [SCENE.xml [further options of `tachylite render`]]
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)
"$here/cmake/setup.sh"
(cd "$here" && cmake --preset release && cmake --build --preset release --target tachylite)
if [ $# = 0 ]; then
  set -- "$here/scenes/cornell-box/scene.xml" --spp 64 -o cornell-box.exr -o cornell-box.png
fi
"$here/build/release/tachylite" render "$@"
