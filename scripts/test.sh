#!/usr/bin/env bash
# Set-up, build, and all tests but those labelled long or gpu. Other arguments go to ctest:
#
#   scripts/test.sh                 everything that needs neither a GPU nor patience
#   scripts/test.sh -R gas          tests whose name contains gas
#   scripts/test.sh -L smoke        one scene per program, one comparison with the reference per area of kernels
#   scripts/test.sh -L long         the long ones
#   scripts/test.sh --system        install nothing, use what find_package finds
. "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"

setup=() build=() pass=()
labels=yes
for argument in "$@"; do
  case "$argument" in
    --system)
      setup+=(--system)
      build+=(--system)
      ;;
    -L | --label-regex | -LE | --label-exclude)
      labels=no
      pass+=("$argument")
      ;;
    -h | --help) sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0" && exit 0 ;;
    *) pass+=("$argument") ;;
  esac
done

"$root/scripts/setup.sh" --no-cuda ${setup[@]+"${setup[@]}"}
"$root/scripts/build.sh" host ${build[@]+"${build[@]}"}
[ "$labels" = no ] || pass+=(-LE 'long|gpu')
exec ctest --test-dir "$root/build/host" --parallel "$jobs" --output-on-failure --no-tests=error "${pass[@]}"
