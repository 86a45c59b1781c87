#!/bin/sh
# Renders one image with Blender's Cycles: cycles.sh SCENE.xml SAMPLES SEED OUT.exr [options of render.py]
# For: tachylite bench SCENE.xml --external "name=cycles;command=tests/bench/cycles/cycles.sh {scene} {samples} {seed} {out}{defines}"
set -eu
exec blender --background --factory-startup --python-exit-code 1 --python "$(dirname "$0")/render.py" -- "$@"
