# shellcheck shell=bash
# What the scripts share: messages, packages, the build. Sourced; sets the current folder to the root of the checkout.

cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1

say() { printf '%s\n' "$*" >&2; }
fail() { say "$(basename "$0"): $*"; exit 1; }

# Prints the comment at the head of a script, its usage text.
usage() { sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$1"; }

# wanted_packages build: those of packages.txt but for the ones marked "check:". wanted_packages check: all.
wanted_packages() {
  if [ "$1" = check ]; then
    sed -n 's/^\([a-z0-9][^ ]*\) .*/\1/p' scripts/packages.txt
  else
    sed -n '/# check:/d; s/^\([a-z0-9][^ ]*\) .*/\1/p' scripts/packages.txt
  fi
}

# install_packages build|check: installs what is missing; does nothing, quickly, where nothing is.
install_packages() {
  command -v dpkg-query >/dev/null ||
    { say "this is not Debian: the packages of scripts/packages.txt must be there already"; return; }
  local wanted present missing as_root=()
  wanted=$(wanted_packages "$1" | sort)
  # shellcheck disable=SC2086  # one argument a package
  present=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' $wanted 2>/dev/null | sed -n 's/^installed //p' | sort || true)
  missing=$(comm -23 <(printf '%s\n' "$wanted") <(printf '%s\n' "$present"))
  [ -n "$missing" ] || return 0
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || fail "as root or with sudo, install:" "$(tr "\n" " " <<<"$missing")"
    as_root=(sudo)
  fi
  say "Installing $(wc -w <<<"$missing") packages ..."
  local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=600 -o Acquire::Retries=3)
  "${apt[@]}" update >&2 || say "the lists of packages are not all up to date; going on with those there are"
  # shellcheck disable=SC2086
  "${apt[@]}" install -y --no-install-recommends $missing >&2
}

# Configures a preset of CMakePresets.json and builds it: build PRESET [TARGET...].
build() {
  local preset=$1
  shift
  cmake --preset "$preset" >&2
  cmake --build --preset "$preset" ${1:+--target "$@"} >&2
}
