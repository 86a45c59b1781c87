#!/usr/bin/env bash
# Installs what is missing, builds everything, runs all tests on the system's Vulkan driver and, where setup.sh found
# it, on the newer one beside it. Usage: cmake/test.sh [options of ctest]
set -euo pipefail
cd "$(dirname "$0")/.."
cmake/setup.sh
extra_icd=build/mesa-25/lvp.json
cmake --preset release -DTACHYLITE_EXTRA_ICD="$([ -f $extra_icd ] && echo "$PWD/$extra_icd")"
cmake --build --preset release
ctest --preset release -j "$(nproc)" "$@"
