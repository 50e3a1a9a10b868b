# System packages through apt; read by setup.sh after common.sh.

# missing_packages NAMES: prints those that are not installed.
missing_packages() {
  local installed
  installed=" $(dpkg-query -W -f '${db:Status-Abbrev}${Package}\n' "$@" 2>/dev/null | sed -n 's/^ii *//p' | tr '\n' ' ')"
  local name
  for name in "$@"; do
    case "$installed" in *" $name "*) ;; *) printf '%s ' "$name" ;; esac
  done
}

# why_no_packages: after an installation that failed, prints why none can succeed on this machine; nothing where one can. A single
# server that answered apt-get update is a network.
why_no_packages() {
  if [ "$(id -u)" -ne 0 ] && ! sudo -n true 2>/dev/null; then
    echo "no right to install packages"
  elif [ -e "$deps/log/apt-update.log" ] && ! grep -qE '^(Hit|Get):' "$deps/log/apt-update.log"; then
    echo "no network"
  fi
}

# install_packages NAMES: installs what is missing as root or through sudo -n, or prints the one command to run.
install_packages() {
  command -v apt-get >/dev/null || fail "this system has no apt-get: install what APT_PACKAGES in scripts/dependencies.env names, then use --system."
  local missing
  missing="$(missing_packages "$@")"
  [ -z "$missing" ] && return 0
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    sudo -n true 2>/dev/null || fail "system packages are missing and sudo needs a password: run \`sudo apt-get install -y --no-install-recommends ${missing% }\` and start again."
    as_root=(sudo -n)
  fi
  local free
  free="$(df -Pk /usr | awk 'NR == 2 { print int($4 / 1024) }')"
  [ "$free" -ge 1500 ] || fail "the disk of /usr has ${free} MB free and the system packages need 1500 MB: free some space and start again."
  say "installing system packages: ${missing% }"
  run_logged apt-update "${as_root[@]}" env LC_ALL=C apt-get -o Acquire::Retries=3 update
  # shellcheck disable=SC2086  # one word a package
  run_logged apt-install "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get -o Acquire::Retries=3 -o Dpkg::Options::=--force-confold install -y --no-install-recommends $missing
}
