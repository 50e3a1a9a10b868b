# Fetches, checks and builds Kokkos and Kokkos Kernels; read by setup.sh after common.sh.

# python_environment: makes $deps/venv with the pinned packages for fetching; picture_packages has to follow.
python_environment() {
  environment_stamp="$(cat "$root/scripts/requirements.txt" <(printf '%s\n' "$FETCH_REQUIREMENTS") <(python3 --version) | sha256sum)"
  if environment_is_whole; then return 0; fi
  say "making the Python environment"
  rm -rf "$deps/venv"
  run_logged venv python3 -I -m venv "$deps/venv"
  # shellcheck disable=SC2086  # one word a requirement
  run_logged pip-tools "$deps/venv/bin/python" -I -m pip install --quiet --disable-pip-version-check $FETCH_REQUIREMENTS
}

environment_is_whole() {
  [ "$(cat "$deps/venv/.stamp" 2>/dev/null)" = "$environment_stamp" ] && [ -x "$deps/venv/bin/python" ]
}

# picture_packages: adds what pictures are made with. The network and the disk are what it waits for, so it may run
# beside a build.
picture_packages() {
  if environment_is_whole; then return 0; fi
  run_logged pip-pictures "$deps/venv/bin/python" -I -m pip install --quiet --disable-pip-version-check -r "$root/scripts/requirements.txt"
  printf '%s\n' "$environment_stamp" >"$deps/venv/.stamp"
}

# check_archive FILE: stops unless FILE is the pinned archive.
check_archive() {
  local got
  [ -r "$1" ] || fail "the archive $1 cannot be read: name another with DROGUE_KOKKOS_ARCHIVE."
  got="$(sha256sum "$1" | cut -d ' ' -f 1)"
  [ "$got" = "$KOKKOS_SHA256" ] || fail "$1 has SHA-256 $got, but scripts/dependencies.env pins $KOKKOS_SHA256: delete the file and fetch it from a source you trust."
}

# fetch_kokkos: leaves the checked archive in $deps/$KOKKOS_ARCHIVE. DROGUE_KOKKOS_ARCHIVE names a copy to take instead.
fetch_kokkos() {
  local archive="$deps/$KOKKOS_ARCHIVE"
  if [ -n "${DROGUE_KOKKOS_ARCHIVE:-}" ] && [ ! -e "$archive" ]; then
    cp "$DROGUE_KOKKOS_ARCHIVE" "$archive"
  fi
  if [ ! -e "$archive" ]; then
    say "fetching Kokkos $KOKKOS_VERSION"
    # A requirement with its hash: pip refuses another file before anything of it runs.
    printf '%s==%s --hash=sha256:%s\n' "$KOKKOS_PACKAGE" "$KOKKOS_PACKAGE_VERSION" "$KOKKOS_SHA256" >"$deps/kokkos-requirement.txt"
    run_logged kokkos-fetch "$deps/venv/bin/python" -I -m pip download --disable-pip-version-check --no-deps \
      --no-build-isolation --no-binary "$KOKKOS_PACKAGE" --dest "$deps" --require-hashes -r "$deps/kokkos-requirement.txt"
  fi
  check_archive "$archive"
}

unpack_kokkos() {
  local source="$deps/source"
  [ -d "$source/kokkos-kernels" ] && [ "$(cat "$source/.stamp" 2>/dev/null)" = "$KOKKOS_SHA256" ] && return 0
  fetch_kokkos
  rm -rf "$source"
  mkdir -p "$source"
  local top="${KOKKOS_ARCHIVE%.tar.gz}"
  run_logged unpack tar -xzf "$deps/$KOKKOS_ARCHIVE" -C "$source" --strip-components=1 "$top/kokkos" "$top/kokkos-kernels"
  printf '%s\n' "$KOKKOS_SHA256" >"$source/.stamp"
}

# kokkos_architecture NUMBER: its name in Kokkos. Kokkos 4.5 has none for 100: see kokkos_cuda_flags.
kokkos_architecture() {
  case "$1" in
    80 | 86) echo "AMPERE$1" ;;
    89) echo ADA89 ;;
    90 | 100) echo HOPPER90 ;;
    *) fail "DROGUE_CUDA_ARCH=$1 is not one of 80, 86, 89, 90, 100, native." ;;
  esac
}

# kokkos_cuda_flags NUMBER: CMake 3.25 lacks nvcc's option for C++20. For 100 Kokkos is configured as Hopper and the machine code
# for Blackwell is made beside it.
kokkos_cuda_flags() {
  printf -- '-std=c++20 -include %s/cmake/cuda13_kokkos45.hpp' "$root"
  [ "$1" != 100 ] || printf -- ' --generate-code=arch=compute_100,code=[compute_100,sm_100]'
}

hip_arch="${DROGUE_HIP_ARCH:-gfx90a}"
# check_hip_architecture: stops unless it is an AMD Instinct whose waves have 64 lanes, which kernels/device/warp.hpp describes.
check_hip_architecture() {
  case "$hip_arch" in
    gfx906 | gfx908 | gfx90a | gfx942) ;;
    *) fail "DROGUE_HIP_ARCH=$hip_arch is not one of gfx906, gfx908, gfx90a, gfx942, and GPUs with waves of 32 lanes do not suit: name one of these, or build preset host." ;;
  esac
}

# check_hipcc: stops unless the compiler knows the architecture, in place of an error amid the build of Kokkos.
check_hipcc() {
  local hipcc
  hipcc="$(find_hipcc)"
  "$hipcc" -x hip "--offload-arch=$hip_arch" --cuda-device-only -nogpulib -nogpuinc -fsyntax-only /dev/null >/dev/null 2>&1 ||
    fail "$hipcc does not compile for DROGUE_HIP_ARCH=$hip_arch: put hipcc of a newer ROCm first in PATH."
}

# variant_stamp VARIANT ARCH: what the installation depends on, ARCH where it is for CUDA. Native code of another processor is built anew.
variant_stamp() {
  {
    printf '%s\n' "$1" "$KOKKOS_SHA256"
    declare -f build_kokkos build_one kokkos_architecture kokkos_cuda_flags
    "${CXX:-c++}" -dumpfullversion -dumpmachine
    [ "$1" = bundle ] || grep -m 1 '^flags' /proc/cpuinfo
    cat "$root/cmake/kokkos_in_one.cmake"
    case "$1" in
      *cuda*) printf '%s\n' "$2" && cat "$root/cmake/cuda13_kokkos45.hpp" && "$nvcc" --version ;;
      hip) printf '%s\n' "$hip_arch" && "$(find_hipcc)" --version ;;
    esac
  } 2>/dev/null | sha256sum
}

# build_variants ARCH VARIANT...: installs host, cuda, hip, bundle or bundle-cuda into $deps/VARIANT where it is not there, all at
# once: much of each is work for one core.
build_variants() {
  local arch="$1" variant stamp free
  shift
  for variant in "$@"; do
    stamp="$(variant_stamp "$variant" "$arch")"
    [ "$(cat "$deps/$variant/.stamp" 2>/dev/null)" != "$stamp" ] || continue
    free="$(df -Pk "$deps" | awk 'NR == 2 { print int($4 / 1024) }')"
    [ "$free" -ge 1000 ] || fail "the disk of $deps has ${free} MB free and Kokkos needs 1000 MB: free some space, or set DROGUE_DEPS to a larger disk."
    unpack_kokkos
    in_background build_kokkos "$variant" "$arch" "$stamp"
  done
}

# build_kokkos VARIANT ARCH STAMP: installs one of them.
build_kokkos() {
  local variant="$1" arch="$2" stamp="$3"
  say "building Kokkos and Kokkos Kernels $KOKKOS_VERSION ($variant)"
  local common=(-G Ninja -Wno-dev -DCMAKE_BUILD_TYPE=Release "-DCMAKE_INSTALL_PREFIX=$deps/$variant"
    -DCMAKE_CXX_STANDARD=20 -DCMAKE_CXX_EXTENSIONS=OFF -DCMAKE_POSITION_INDEPENDENT_CODE=ON -DBUILD_SHARED_LIBS=OFF)
  # Without views from mdspan and deprecated code, which every source would read and none uses.
  local kokkos=(-DKokkos_ENABLE_SERIAL=ON -DKokkos_ENABLE_OPENMP=ON -DKokkos_ENABLE_IMPL_MDSPAN=OFF
    -DKokkos_ENABLE_DEPRECATED_CODE_4=OFF "-DCMAKE_PROJECT_Kokkos_INCLUDE=$root/cmake/kokkos_in_one.cmake")
  local kernels=(-DKokkosKernels_ENABLE_ALL_COMPONENTS=OFF -DKokkosKernels_ENABLE_COMPONENT_BATCHED=ON
    -DKokkosKernels_ENABLE_COMPONENT_BLAS=ON -DKokkosKernels_ADD_DEFAULT_ETI=OFF -DKokkosKernels_INST_DOUBLE=OFF
    -DKokkosKernels_INST_LAYOUTLEFT=OFF "-DKokkos_ROOT=$deps/$variant")
  local device_flags
  device_flags="$(kokkos_cuda_flags "$arch")"
  # The bundle runs on other machines: x86-64-v3 rather than this processor.
  case "$variant" in
    bundle*)
      common+=(-DCMAKE_CXX_FLAGS=-march=x86-64-v3)
      device_flags+=" -Xcompiler=-march=x86-64-v3"
      ;;
    *) kokkos+=(-DKokkos_ARCH_NATIVE=ON) ;;
  esac
  case "$variant" in
    *cuda*)
      common+=("-DCMAKE_CUDA_COMPILER=$nvcc"
        "-DCMAKE_CUDA_ARCHITECTURES=$arch" "-DCMAKE_CUDA_FLAGS=$device_flags")
      kokkos+=(-DKokkos_ENABLE_CUDA=ON -DKokkos_ENABLE_COMPILE_AS_CMAKE_LANGUAGE=ON
        "-DKokkos_ARCH_$(kokkos_architecture "$arch")=ON")
      kernels+=(-DKokkosKernels_ENABLE_TPL_CUBLAS=OFF -DKokkosKernels_ENABLE_TPL_CUSPARSE=OFF
        -DKokkosKernels_ENABLE_TPL_CUSOLVER=OFF)
      ;;
    hip)
      # Without OpenMP and other libraries of ROCm, which Debian 12 lacks. As C++17: Clang 15 crashes in <regex> of gcc 12 as C++20 for a device.
      common+=("-DCMAKE_CXX_COMPILER=$(find_hipcc)" -DCMAKE_CXX_STANDARD=17)
      kokkos+=(-DKokkos_ENABLE_HIP=ON "-DKokkos_ARCH_AMD_${hip_arch^^}=ON" -DKokkos_ENABLE_OPENMP=OFF -DKokkos_ENABLE_ROCTHRUST=OFF)
      kernels+=(-DKokkosKernels_ENABLE_TPL_ROCBLAS=OFF -DKokkosKernels_ENABLE_TPL_ROCSPARSE=OFF
        -DKokkosKernels_ENABLE_TPL_ROCSOLVER=OFF)
      ;;
  esac
  if command -v ccache >/dev/null; then
    common+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DCMAKE_CUDA_COMPILER_LAUNCHER=ccache)
  fi
  rm -rf "$deps/work-$variant"
  build_one "$variant" kokkos "${common[@]}" "${kokkos[@]}"
  build_one "$variant" kokkos-kernels "${common[@]}" "${kernels[@]}"
  rm -rf "$deps/work-$variant"
  printf '%s\n' "$stamp" >"$deps/$variant/.stamp"
}

# build_one VARIANT FOLDER OPTIONS...: configure, compile, install.
build_one() {
  local variant="$1" folder="$2" work="$deps/work-$1/$2"
  shift 2
  run_logged "$folder-$variant-configure" cmake -S "$deps/source/$folder" -B "$work" "$@"
  run_logged "$folder-$variant-build" cmake --build "$work" --parallel "$jobs"
  # An older installation serves until its successor is compiled.
  if [ "$folder" = kokkos ]; then rm -rf "${deps:?}/$variant"; fi
  run_logged "$folder-$variant-install" cmake --install "$work"
}
