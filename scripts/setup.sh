#!/usr/bin/env bash
# Installs what Drogue needs; does nothing, in a second, when it is there. Never prompts.
#
#   scripts/setup.sh [--system] [--no-cuda] [--hip] [--developer] [--bundle]
#     --system     install nothing: only check that the tools are there; libraries come from find_package
#     --no-cuda    no CUDA build of Kokkos although nvcc is there
#     --hip        the compiler of HIP and a HIP build of Kokkos, for AMD GPUs
#     --developer  the formatter and the linter too
#     --bundle     the portable builds of Kokkos that scripts/bundle.sh links as well
#
# Environment: DROGUE_DEPS (folder for Kokkos, default build/deps), DROGUE_CUDA_ARCH (80|86|89|90|100|native, default 90),
# DROGUE_HIP_ARCH (gfx906|gfx908|gfx90a|gfx942, default gfx90a),
# DROGUE_KOKKOS_ARCHIVE (a copy of the source archive, for machines without network), DROGUE_JOBS.
. "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
. "$root/scripts/lib/packages.sh"
. "$root/scripts/lib/kokkos.sh"
. "$root/scripts/dependencies.env"

system=no cuda=yes hip=no developer=no bundle=no
for argument in "$@"; do
  case "$argument" in
    --system) system=yes ;;
    --no-cuda) cuda=no ;;
    --hip) hip=yes ;;
    --developer) developer=yes ;;
    --bundle) bundle=yes ;;
    -h | --help) sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0" && exit 0 ;;
    *) fail "unknown argument $argument: see scripts/setup.sh --help." ;;
  esac
done

check_tools() {
  local cxx="${CXX:-c++}" version
  command -v "$cxx" >/dev/null || fail "there is no C++ compiler: install g++ $MINIMUM_GCC or newer."
  if "$cxx" --version | grep -qiE 'g\+\+|gcc|free software foundation'; then
    version="$("$cxx" -dumpfullversion)"
    at_least "$version" "$MINIMUM_GCC" || fail "$cxx is version $version and C++20 needs $MINIMUM_GCC or newer: install g++-$MINIMUM_GCC and set CXX=g++-$MINIMUM_GCC."
  fi
  command -v cmake >/dev/null || fail "there is no cmake: install version $MINIMUM_CMAKE or newer."
  version="$(cmake --version | awk 'NR == 1 { print $3 }')"
  at_least "$version" "$MINIMUM_CMAKE" || fail "cmake is version $version: install $MINIMUM_CMAKE or newer."
  command -v ninja >/dev/null || fail "there is no ninja: install ninja (package ninja-build)."
  command -v python3 >/dev/null || fail "there is no python3: install Python 3.11 or newer."
}

# cuda_architecture: DROGUE_CUDA_ARCH with native resolved.
cuda_architecture() {
  local arch="${DROGUE_CUDA_ARCH:-90}"
  if [ "$arch" = native ]; then
    arch="$(nvidia-smi --query-gpu=compute_cap --format=csv,noheader 2>/dev/null | head -n 1 | tr -d .)"
    [ -n "$arch" ] || fail "DROGUE_CUDA_ARCH=native needs a GPU that nvidia-smi can see: name the architecture instead, for example DROGUE_CUDA_ARCH=90."
  fi
  printf '%s\n' "$arch"
}

if [ "$system" = yes ]; then
  check_tools
  [ "$hip" = no ] || [ -n "$(find_hipcc)" ] || fail "there is no hipcc: load a module of ROCm, or name its folder by ROCM_PATH."
  say "the tools are there: libraries come from find_package"
  exit 0
fi

[ "$hip" = no ] || check_hip_architecture
[ -z "${DROGUE_KOKKOS_ARCHIVE:-}" ] || check_archive "$DROGUE_KOKKOS_ARCHIVE"
packages="$APT_PACKAGES"
# A ROCm of the system comes first.
[ "$hip" = no ] || [ -n "$(find_hipcc)" ] || packages="$packages $APT_HIP_PACKAGES"
[ "$developer" = no ] || packages="$packages $APT_DEVELOPER_PACKAGES"
mkdir -p "$deps" 2>/dev/null && [ -w "$deps" ] || fail "cannot write to $deps: choose another folder with DROGUE_DEPS."
# shellcheck disable=SC2086  # one word a package
install_packages $packages
check_tools
[ "$hip" = no ] || check_hipcc

# One set-up at a time: several clones may share DROGUE_DEPS.
exec 9>"$deps/.lock"
flock -n 9 || { say "waiting for another set-up in $deps to end" && flock 9; }
python_environment
in_background picture_packages
[ "$deps/venv" -ef "$root/build/venv" ] || { mkdir -p "$root/build" && ln -sfn "$deps/venv" "$root/build/venv"; }
variants=(host) arch=
[ "$bundle" = no ] || variants+=(bundle)
nvcc="$(find_nvcc)"
if [ "$cuda" = yes ] && [ -n "$nvcc" ]; then
  version="$("$nvcc" --version | sed -n 's/.*release \([0-9.]*\).*/\1/p')"
  at_least "$version" "$MINIMUM_CUDA" || fail "$nvcc is version $version and C++20 on the device needs $MINIMUM_CUDA or newer: update the CUDA toolkit, or use --no-cuda."
  arch="$(cuda_architecture)"
  variants+=(cuda)
  [ "$bundle" = no ] || variants+=(bundle-cuda)
fi
[ "$hip" = no ] || variants+=(hip)
build_variants "$arch" "${variants[@]}"
wait_for_background
