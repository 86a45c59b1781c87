#!/usr/bin/env bash
# Installs what is missing, builds everything, runs all tests on the system's Vulkan driver and, where setup.sh found
# it, on the newer one beside it. Usage: cmake/test.sh [options of ctest]
set -euo pipefail
cd "$(dirname "$0")/.."
cmake/setup.sh
extra_icd=build/mesa-25/lvp.json
# Several sources a compilation: less CPU time for a build from scratch, more after a change.
cmake --preset release -DTACHYLITE_EXTRA_ICD="$([ -f $extra_icd ] && echo "$PWD/$extra_icd")" \
      -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=8
cmake --build --preset release
ctest --preset release -j "$(nproc)" "$@"
