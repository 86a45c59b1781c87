#!/usr/bin/env bash
# Installs what Tachylite needs on Debian 12, as root or through sudo; does nothing that is done already.
# Also unpacks the Mesa of bookworm-backports into build/mesa-25 (nothing of it is installed), so that tests can run on
# a second, newer Vulkan driver: build/mesa-25/lvp.json is its manifest. Without it they run on the system's alone.
set -euo pipefail
cd "$(dirname "$0")/.."

build=(g++ cmake ninja-build python3 glslang-tools spirv-tools libvulkan-dev libvulkan-volk-dev libglm-dev libstb-dev
       libopenexr-dev libtinyobjloader-dev libcli11-dev libpugixml-dev libfmt-dev libtbb-dev nlohmann-json3-dev)
run=(libvulkan1 mesa-vulkan-drivers)
test=(libgtest-dev libboost-dev libembree-dev vulkan-validationlayers)

missing=()
for package in "${build[@]}" "${run[@]}" "${test[@]}"; do
  [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
done
if [ ${#missing[@]} -gt 0 ]; then
  as_root=()
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || { echo "setup: run as root, or install: ${missing[*]}" >&2; exit 1; }
    as_root=(sudo)
  fi
  echo "setup: installing ${missing[*]}"
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
fi

unpack_mesa_25() {
  local folder="$PWD/build/mesa-25" manifest
  rm -rf "$folder" && mkdir -p "$folder/apt/lists/partial" "$folder/apt/cache/archives/partial"
  echo "deb ${DEBIAN_MIRROR:-http://deb.debian.org/debian} bookworm-backports main" > "$folder/apt/sources.list"
  # Lists, cache and sources of its own: the machine's apt settings stay as they are.
  local apt=(apt-get -qq -o "Dir::Etc::SourceList=$folder/apt/sources.list" -o Dir::Etc::SourceParts=/dev/null
             -o "Dir::State::Lists=$folder/apt/lists" -o "Dir::Cache=$folder/apt/cache" -o APT::Sandbox::User=)
  "${apt[@]}" update || return
  (cd "$folder" && "${apt[@]}" download mesa-vulkan-drivers) || return
  rm -rf "$folder/apt"
  dpkg-deb -x "$folder"/mesa-vulkan-drivers_*.deb "$folder/deb" || return
  mv "$(find "$folder/deb/usr/lib" -name libvulkan_lvp.so)" "$folder/" || return
  manifest=$(find "$folder/deb/usr/share/vulkan/icd.d" -name 'lvp_icd*.json')
  ! ldd "$folder/libvulkan_lvp.so" | grep 'not found' || return
  sed "s|\"library_path\": *\"[^\"]*\"|\"library_path\": \"$folder/libvulkan_lvp.so\"|" "$manifest" > "$folder/lvp.json"
  rm -rf "$folder/deb" "$folder"/*.deb
}
if [ ! -f build/mesa-25/lvp.json ]; then
  if unpack_mesa_25; then
    echo "setup: unpacked Mesa of bookworm-backports into build/mesa-25"
  else
    rm -rf build/mesa-25
    echo "setup: no Mesa of bookworm-backports; tests will run on the system's Vulkan driver alone" >&2
  fi
fi
