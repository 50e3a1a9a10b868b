#!/usr/bin/env bash
# Makes build/bundle/drogue: a folder that runs on another Linux (x86-64-v3, glibc >= 2.36) without installing anything.
# It holds one file with all programs for the host and (where nvcc is) one for CUDA, the shared libraries they need, and the
# scenes. The CUDA file holds machine code for one architecture, DROGUE_CUDA_ARCH (default 90), and takes cuFFT and cuBLAS from
# the toolkit of the machine: half a gigabyte.
#
#   scripts/bundle.sh [--tests] [--exact] [--no-cuda]
#     --tests    the test programs of every backend too, and run_tests.sh to run them
#     --exact    without fused multiply-add, into build/bundle/drogue-exact
#     --no-cuda  host programs alone
. "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"

# Expected sizes in MB on Debian 12, measured: gcc 12.2, nvcc 13.0 for architecture 90, whose kernels nvcc compresses.
host_size=10 cuda_size=20 library_size=50

tests=no exact=OFF cuda=yes name=drogue setup=(--bundle)
for argument in "$@"; do
  case "$argument" in
    --tests) tests=yes ;;
    --exact) exact=ON name=drogue-exact ;;
    --no-cuda) cuda=no setup+=(--no-cuda) ;;
    -h | --help) sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0" && exit 0 ;;
    *) fail "unknown argument $argument: see scripts/bundle.sh --help." ;;
  esac
done
[ -n "$(find_nvcc)" ] || cuda=no
[ "$cuda" = yes ] || cuda_size=0
cd "$root"
out="$root/build/bundle/$name"
say "build/bundle/$name will have about $((host_size + cuda_size + library_size)) MB: host $host_size, CUDA $cuda_size, libraries and scenes $library_size$([ "$tests" = no ] || printf ', and the tests')"
scripts/setup.sh "${setup[@]}"

rm -rf "$out"
mkdir -p "$out/bin" "$out/lib"

# build KIND OPTIONS...: programs and tests that look for their libraries in ../lib, the old way: DT_RPATH also holds
# for the libraries of libraries.
build() {
  local kind="$1" folder="build/bundle/work-$1-$exact"
  shift
  run_logged "bundle-$kind-configure" cmake -S . -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release "-DDROGUE_EXACT=$exact" \
    "-DBUILD_TESTING=$([ "$tests" = yes ] && echo ON || echo OFF)" -DDROGUE_HEADER_TEST=OFF -DDROGUE_ONE_PROGRAM=ON \
    '-DCMAKE_INSTALL_RPATH=$ORIGIN/../lib' -DCMAKE_BUILD_WITH_INSTALL_RPATH=ON -DCMAKE_CXX_FLAGS=-march=x86-64-v3 \
    -DCMAKE_EXE_LINKER_FLAGS=-Wl,--disable-new-dtags "$@"
  say "building the $kind programs"
  local targets=(drogue)
  [ "$tests" = no ] || targets+=(drogue_kernel_tests)
  run_logged "bundle-$kind-build" cmake --build "$folder" --parallel "$jobs" --target "${targets[@]}"
  install -s "$folder/bin/drogue" "$out/bin/drogue.$kind"
  [ "$tests" = no ] && return 0
  mkdir -p "$out/tests"
  local program
  for program in "$folder"/tests/*; do
    [ -f "$program" ] && [ -x "$program" ] || continue
    # In the CUDA folder every kernel test; the rest is the same program as on the host.
    case "$kind:$program" in
      cuda:*_cuda) install -s "$program" "$out/tests/$(basename "$program")" ;;
      host:*_serial | host:*_openmp) install -s "$program" "$out/tests/$(basename "$program")" ;;
    esac
  done
}

build host -DDROGUE_DEPS_VARIANT=bundle
[ "$cuda" = no ] || build cuda -DDROGUE_DEPS_VARIANT=bundle-cuda -DDROGUE_CUDA=ON -DDROGUE_NCCL=OFF "-DDROGUE_CUDA_ARCH=${DROGUE_CUDA_ARCH:-90}" \
  "-DCMAKE_CUDA_FLAGS=-Xcompiler=-march=x86-64-v3 $(nvcc_compression)"

# Everything that the programs load but the C library, the driver and the CUDA toolkit, which belong to the machine.
machine='^(ld-linux|libc|libm|libdl|librt|libpthread|libresolv|libutil|libanl|libcuda|libnvidia|libcufft|libcublas|libcublasLt)[.-]'
find "$out" -type f -perm -u+x -exec ldd {} + | awk '/=> \// { print $3 }' | sort -u | while read -r library; do
  if ! basename "$library" | grep -qE "$machine"; then
    install -m 644 "$library" "$out/lib/"
  fi
done
python3 -IB scripts/lib/drop_runpath.py "$out"/lib/*

for app in gas springs options parachute perf; do
  launcher="$out/bin/drogue-$app"
  for kind in host cuda; do
    [ ! -e "$out/bin/drogue.$kind" ] || ln -s "drogue.$kind" "$launcher.$kind"
  done
  cat >"$launcher" <<'LAUNCHER'
#!/bin/sh
# Takes the CUDA program where a GPU is, else the one for the processor. DROGUE_BUILD=host or cuda decides instead.
program="$(readlink -f "$0")"
build="${DROGUE_BUILD:-}"
if [ -z "$build" ]; then
  build=host
  if [ -x "$program.cuda" ] && [ -e /dev/nvidiactl ]; then build=cuda; fi
fi
if [ "$build" = cuda ]; then
  export LD_LIBRARY_PATH="${LD_LIBRARY_PATH:+$LD_LIBRARY_PATH:}${CUDA_HOME:-/usr/local/cuda}/lib64:${CUDA_HOME:-/usr/local/cuda}/lib"
fi
exec "$program.$build" "$@"
LAUNCHER
  chmod 755 "$launcher"
done
mkdir -p "$out/share/drogue/scenes"
for app in miniapps/*/scenes; do
  cp -r "$app" "$out/share/drogue/scenes/$(basename "$(dirname "$app")")"
done
cp -r miniapps/options/batches "$out/share/drogue/batches"
cp -r scripts/plot "$out/share/drogue/plot"
find "$out" -name __pycache__ -prune -exec rm -rf {} +
install -m 755 build/bundle/work-host-"$exact"/bin/drogue-plot "$out/bin/drogue-plot"
[ "$tests" = no ] || install -m 755 scripts/lib/run_tests.sh "$out/run_tests.sh"

say "build/bundle/$name has $(du -sm "$out" | cut -f 1) MB"
